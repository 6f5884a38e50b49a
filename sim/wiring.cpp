#include "sim/wiring.h"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "sim/pixel_light.h"

namespace xorvox::sim {
namespace {

/// `number` with two of its bits swapped.
std::uint32_t with_bits_swapped(std::uint32_t number, std::uint32_t a, std::uint32_t b) {
    const std::uint32_t differ = (number >> a ^ number >> b) & 1u;
    return number ^ (differ << a | differ << b);
}

bool is_set(const std::byte* bits, std::size_t at) {
    return (bits[at / 8] >> (at % 8) & std::byte{1}) != std::byte{0};
}
void set(std::byte* bits, std::size_t at) {
    bits[at / 8] |= std::byte{1} << (at % 8);
}

}  // namespace

Wiring::Wiring(const DisplayDescription& display, const Faults& faults)
    : display_(display), rows_(display.panel_count), stuck_(display.panel_count), first_byte_(display.panel_count) {
    constexpr FaultKind kWiring[] = {FaultKind::Mirrored, FaultKind::SwappedPanels, FaultKind::DeadRow,
                                     FaultKind::StuckBit, FaultKind::RowOrder};
    right_ = std::ranges::none_of(kWiring, [&faults](FaultKind kind) { return faults.has(kind); });
    if (right_) return;
    std::size_t first = 0;
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        const Panel& panel = display.panels[p];
        first_byte_[p] = first;
        first += row_bytes(panel, display.format) * panel.rows;
        rows_[p].resize(panel.rows);
        for (std::uint32_t r = 0; r < panel.rows; ++r) rows_[p][r] = {p, r};
    }
    for (const Fault& fault : faults.list) add(fault);
    // LEDs that are dead are so wherever their bits come from.
    for (const Fault& fault : faults.list) {
        if (fault.kind == FaultKind::DeadRow) rows_[fault.panel][fault.row].dark = true;
    }
}

void Wiring::add(const Fault& fault) {
    std::vector<Row>& rows = rows_[fault.panel];
    switch (fault.kind) {
        case FaultKind::Mirrored:
            for (Row& row : rows) row.reversed = !row.reversed;
            break;
        case FaultKind::SwappedPanels:
            for (std::size_t r = 0; r < rows.size(); ++r) {
                std::swap(rows[r].panel, rows_[fault.other][r].panel);
            }
            break;
        case FaultKind::StuckBit: {
            Stuck& stuck = stuck_[fault.panel];
            const std::uint32_t bit = 1u << fault.bit;
            (fault.amount != 0.0 ? stuck.high : stuck.low) |= bit;
            (fault.amount != 0.0 ? stuck.low : stuck.high) &= ~bit;
            break;
        }
        case FaultKind::RowOrder: swap_lines(fault); break;
        default: break;
    }
}

void Wiring::swap_lines(const Fault& fault) {
    const std::uint32_t groups = display_.scan.row_groups;
    std::vector<Row>& rows = rows_[fault.panel];
    const std::vector<Row> right = rows;
    for (std::uint32_t r = 0; r < rows.size(); ++r) {
        const std::uint32_t group = r % groups;
        std::uint32_t from = group;
        if (display_.scan.driver == DriverChip::Hub75) {
            from = with_bits_swapped(group, fault.line, fault.other);
        } else if (group == fault.line || group == fault.other) {
            from = fault.line ^ fault.other ^ group;
        }
        const std::uint32_t row = r - group + from;
        if (from < groups && row < rows.size()) {
            rows[r] = right[row];
        } else {
            rows[r].dark = true;  // The device never gives this address.
        }
    }
}

void Wiring::show_pixels(std::uint32_t panel, const Row& row, std::span<const std::byte> sent,
                         std::span<std::byte> shown) const {
    const Stuck& stuck = stuck_[panel];
    const std::uint32_t columns = display_.panels[panel].columns;
    const std::uint32_t bits = bits_per_pixel(display_.format);
    if (!row.reversed && stuck.high == 0 && stuck.low == 0) {
        std::ranges::copy(sent, shown.begin());
        return;
    }
    for (std::uint32_t column = 0; column < columns; ++column) {
        const std::size_t from = std::size_t{row.reversed ? columns - 1 - column : column} * bits;
        for (std::uint32_t bit = 0; bit < bits; ++bit) {
            const bool sent_bit = (stuck.low >> bit & 1u) == 0 && is_set(sent.data(), from + bit);
            if (sent_bit || (stuck.high >> bit & 1u) != 0) set(shown.data(), std::size_t{column} * bits + bit);
        }
    }
}

namespace {

/// Makes of each strobe what the wiring makes of it.
class Rewirer {
public:
    Rewirer(const DisplayDescription& display, const Faults& faults, StrobeSink sink)
        : display_(display), wiring_(display_, faults), sink_(std::move(sink)) {}
    Rewirer(const Rewirer&) = delete;  // wiring_ points into it.
    Rewirer& operator=(const Rewirer&) = delete;

    void rewire(const Strobe& strobe) {
        if (strobe.row_group == Strobe::kAllRows) return give(strobe, Strobe::kAllRows);
        for (std::uint32_t group = 0; group < display_.scan.row_groups; ++group) {
            if (lights_up(group, strobe.row_group)) give(strobe, group);
        }
    }

private:
    /// Whether on some panel `group` is lit when the device means `meant`.
    bool lights_up(std::uint32_t group, std::uint32_t meant) const {
        for (std::uint32_t p = 0; p < display_.panel_count; ++p) {
            if (group >= display_.panels[p].rows) continue;
            if (wiring_.row(p, group).row % display_.scan.row_groups == meant) return true;
        }
        return false;
    }

    /// What `group` shows of `strobe`.
    void give(const Strobe& strobe, std::uint32_t group) {
        const bool levels = strobe.plane == Strobe::kLevels;
        const bool all = group == Strobe::kAllRows;
        Strobe shown = strobe;
        shown.row_group = group;
        for (std::uint32_t p = 0; p < display_.panel_count; ++p) {
            const Panel& panel = display_.panels[p];
            const std::size_t bytes = levels ? row_bytes(panel, display_.format) : (panel.columns + std::size_t{7}) / 8;
            const std::uint32_t channels = levels ? 1 : channel_count(display_.format);
            std::vector<std::byte>& buffer = buffers_[p];
            buffer.resize(bytes * channels * panel.rows);
            shown.panels[p] = {buffer.data(), bytes * channels, {0, bytes, 2 * bytes}};
            for (std::uint32_t r = all ? 0 : group; r < panel.rows; r += all ? 1 : display_.scan.row_groups) {
                std::byte* const row = buffer.data() + std::size_t{r} * channels * bytes;
                std::fill_n(row, channels * bytes, std::byte{0});
                const Wiring::Row& from = wiring_.row(p, r);
                if (from.dark || !(all || from.row % display_.scan.row_groups == strobe.row_group)) continue;
                const StrobeRows& sent = strobe.panels[from.panel];
                for (std::uint32_t channel = 0; channel < channels; ++channel) {
                    const std::byte* const bits = sent.at(from.row, channel);
                    std::byte* const to = row + channel * bytes;
                    if (levels) {
                        wiring_.show_pixels(p, from, {bits, bytes}, {to, bytes});
                    } else {
                        show_bits(p, from.reversed, forced(p, channel, strobe.plane), bits, to);
                    }
                }
            }
        }
        sink_(shown);
    }

    enum class Forced { No, High, Low };
    /// What a bit plane's line of a channel is stuck at.
    Forced forced(std::uint32_t panel, std::uint32_t channel, std::uint32_t plane) const {
        const auto [low, bits] = channels(display_.format)[channel];
        const std::uint32_t planes = std::min<std::uint32_t>(bits, shown_bit_planes(display_));
        const std::uint32_t bit = 1u << (low + bits - 1 - plane % planes);
        const Wiring::Stuck& stuck = wiring_.stuck(panel);
        return (stuck.high & bit) != 0 ? Forced::High : (stuck.low & bit) != 0 ? Forced::Low : Forced::No;
    }

    void show_bits(std::uint32_t panel, bool reversed, Forced forced, const std::byte* sent, std::byte* shown) const {
        if (forced == Forced::Low) return;
        const std::uint32_t columns = display_.panels[panel].columns;
        for (std::uint32_t column = 0; column < columns; ++column) {
            const std::uint32_t from = reversed ? columns - 1 - column : column;
            if (forced == Forced::High || is_set(sent, from)) set(shown, column);
        }
    }

    const DisplayDescription display_;
    Wiring wiring_;
    StrobeSink sink_;
    std::array<std::vector<std::byte>, kMaxPanels> buffers_;
};

}  // namespace

StrobeSink with_wiring_faults(const DisplayDescription& display, const Faults& faults, StrobeSink sink) {
    if (Wiring(display, faults).is_right()) return sink;
    return [rewirer = std::make_shared<Rewirer>(display, faults, std::move(sink))](const Strobe& strobe) {
        rewirer->rewire(strobe);
    };
}

}  // namespace xorvox::sim
