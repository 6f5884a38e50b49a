#include "driver/host/calibration.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace xorvox::host {
namespace {

constexpr std::size_t kColumns = 6;
enum Column : std::size_t { kUnit, kRow, kColumn, kRed, kGreen, kBlue };

std::string_view trimmed(std::string_view text) {
    const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    return text;
}

/// Text from a file, as a message may show it.
std::string shown(std::string_view text) {
    std::string safe;
    for (const char c : text.substr(0, 40)) safe += c >= ' ' && c <= '~' ? c : '?';
    return text.size() > 40 ? safe + "..." : safe;
}

Expected<void> wrong(std::size_t line, const std::string& what) {
    return fail(fmt::format("line {}: {}", line, what));
}

/// Takes the next field of a line.
std::optional<std::string_view> next_field(std::optional<std::string_view>& rest) {
    if (!rest) return std::nullopt;
    const std::size_t comma = rest->find(',');
    const std::string_view field = trimmed(rest->substr(0, comma));
    if (comma == std::string_view::npos) {
        rest.reset();
    } else {
        rest->remove_prefix(comma + 1);
    }
    return field;
}

template <class Number>
bool parse_number(std::string_view text, Number& number) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size();
}

/// Reads a file line by line.
class Reader {
public:
    explicit Reader(const DisplayDescription& display)
        : display_(display), by_plane_(display.kind == DisplayKind::StackedPlanes) {
        names_[kUnit] = by_plane_ ? "plane" : "panel";
    }

    Expected<void> read(std::string_view text) {
        for (std::size_t line = 1; !text.empty(); ++line) {
            const std::size_t end = std::min(text.find('\n'), text.size());
            const std::string_view content = trimmed(text.substr(0, std::min(end, text.find('#'))));
            text.remove_prefix(std::min(end + 1, text.size()));
            if (content.empty()) continue;
            const Expected<void> understood = has_header_ ? read_led(content, line) : read_header(content, line);
            if (!understood) return understood;
        }
        if (!has_header_) return fail(fmt::format("there is no line of columns: {},row,column,red,green,blue", unit()));
        return check_each_once();
    }

    std::vector<Calibration::Led> take() {
        std::vector<Calibration::Led> leds;
        leds.reserve(leds_.size());
        for (const auto& [led, line] : leds_) leds.push_back(led);
        return leds;
    }

private:
    struct Named {
        Calibration::Led led;
        std::size_t line;
    };

    std::string_view unit() const { return names_[kUnit]; }

    Expected<void> read_header(std::string_view content, std::size_t line) {
        std::array<bool, kColumns> seen{};
        std::size_t count = 0;
        std::optional<std::string_view> rest = content;
        while (const auto field = next_field(rest)) {
            const auto* const found = std::ranges::find(names_, *field);
            if (found == names_.end()) {
                return wrong(line, fmt::format("unknown column \"{}\"; the columns are {},row,column,red,green,blue",
                                               shown(*field), unit()));
            }
            const auto index = static_cast<std::size_t>(found - names_.begin());
            if (seen[index]) return wrong(line, fmt::format("column \"{}\" is there twice", *field));
            seen[index] = true;
            order_[count++] = index;
        }
        for (std::size_t i = 0; i < kColumns; ++i) {
            if (!seen[i]) return wrong(line, fmt::format("column \"{}\" is missing", names_[i]));
        }
        has_header_ = true;
        return {};
    }

    Expected<void> read_led(std::string_view content, std::size_t line) {
        std::array<std::string_view, kColumns> fields;
        std::size_t count = 0;
        std::optional<std::string_view> rest = content;
        while (const auto field = next_field(rest)) {
            if (count < kColumns) fields[order_[count]] = *field;
            ++count;
        }
        if (count != kColumns) return wrong(line, fmt::format("{} fields; there must be {}", count, kColumns));
        std::array<std::uint32_t, 3> place{};
        for (std::size_t i = 0; i < place.size(); ++i) {
            if (!parse_number(fields[i], place[i])) {
                return wrong(line, fmt::format("{} \"{}\" is no whole number", names_[i], shown(fields[i])));
            }
        }
        const Expected<std::uint32_t> pixel = find_pixel(place, line);
        if (!pixel) return tl::unexpected(pixel.error());
        Calibration::Led led{place[kUnit], *pixel};
        for (std::size_t i = kRed; i <= kBlue; ++i) {
            float gain = 0.0f;
            if (!parse_number(fields[i], gain)) {
                return wrong(line, fmt::format("{} \"{}\" is no number", names_[i], shown(fields[i])));
            }
            if (!(gain >= 0.0f && gain <= 1.0f)) {
                return wrong(line, fmt::format("{} is {}; a gain is 0 to 1", names_[i], shown(fields[i])));
            }
            led.gain[static_cast<int>(i - kRed)] = gain + 0.0f;  // -0 is 0.
        }
        leds_.push_back({led, line});
        return {};
    }

    Expected<std::uint32_t> find_pixel(const std::array<std::uint32_t, 3>& place, std::size_t line) const {
        const std::uint32_t units = by_plane_ ? display_.slices : display_.panel_count;
        const auto in_range = [&](std::size_t which, std::uint32_t count) -> Expected<void> {
            if (place[which] < count) return {};
            return wrong(line, fmt::format("{} {}: the display has {} of them, from 0 to {}", names_[which],
                                           place[which], count, count - 1));
        };
        if (const auto known = in_range(kUnit, units); !known) return tl::unexpected(known.error());
        const std::uint32_t own = by_plane_ ? 0 : place[kUnit];
        const Panel& panel = display_.panels[own];
        if (const auto known = in_range(kRow, panel.rows); !known) return tl::unexpected(known.error());
        if (const auto known = in_range(kColumn, panel.columns); !known) return tl::unexpected(known.error());
        std::uint32_t pixel = place[kRow] * panel.columns + place[kColumn];
        for (std::uint32_t p = 0; p < own; ++p)
            pixel += std::uint32_t{display_.panels[p].columns} * display_.panels[p].rows;
        return pixel;
    }

    Expected<void> check_each_once() {
        const auto key = [](const Named& named) { return std::tuple(named.led.unit, named.led.pixel, named.line); };
        std::ranges::sort(leds_, {}, key);
        const auto same = [](const Named& a, const Named& b) {
            return a.led.unit == b.led.unit && a.led.pixel == b.led.pixel;
        };
        const auto twice = std::ranges::adjacent_find(leds_, same);
        if (twice == leds_.end()) return {};
        return wrong(std::next(twice)->line, fmt::format("the LED of line {} again", twice->line));
    }

    const DisplayDescription& display_;
    bool by_plane_;
    std::array<std::string_view, kColumns> names_{"", "row", "column", "red", "green", "blue"};
    bool has_header_ = false;
    std::array<std::size_t, kColumns> order_{};  ///< Which column each field of a line is.
    std::vector<Named> leds_;
};

}  // namespace

Expected<Calibration> Calibration::parse(std::string_view text, const DisplayDescription& display) {
    if (text.size() > kMostBytes) {
        return fail(fmt::format("{} bytes; at most {} are read", text.size(), kMostBytes));
    }
    Reader reader(display);
    if (const auto read = reader.read(text); !read) return tl::unexpected(read.error());
    Calibration calibration;
    calibration.leds_ = reader.take();
    return calibration;
}

}  // namespace xorvox::host
