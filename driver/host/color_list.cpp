#include "driver/host/color_list.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "driver/host/color_space.h"

namespace xorvox::host {
namespace {

struct Name {
    std::string_view name;
    std::uint32_t rrggbb;
};

/// The sixteen names of HTML 4, and a few more, all with the values of CSS Color Level 4.
constexpr Name kNames[] = {
    {"black", 0x000000},     {"silver", 0xc0c0c0}, {"gray", 0x808080},    {"white", 0xffffff},  {"maroon", 0x800000},
    {"red", 0xff0000},       {"purple", 0x800080}, {"fuchsia", 0xff00ff}, {"green", 0x008000},  {"lime", 0x00ff00},
    {"olive", 0x808000},     {"yellow", 0xffff00}, {"navy", 0x000080},    {"blue", 0x0000ff},   {"teal", 0x008080},
    {"aqua", 0x00ffff},      {"cyan", 0x00ffff},   {"magenta", 0xff00ff}, {"orange", 0xffa500}, {"gold", 0xffd700},
    {"pink", 0xffc0cb},      {"coral", 0xff7f50},  {"crimson", 0xdc143c}, {"violet", 0xee82ee}, {"indigo", 0x4b0082},
    {"turquoise", 0x40e0d0}, {"azure", 0xf0ffff},  {"salmon", 0xfa8072},  {"brown", 0xa52a2a},  {"ivory", 0xfffff0},
};

}  // namespace

std::array<glm::dvec3, 5> rising_colors() {
    return {linear_from_hex(0x205cff), linear_from_hex(0x00e0ff), linear_from_hex(0x4ae258), linear_from_hex(0xd0e030),
            linear_from_hex(0xffd400)};
}

Expected<glm::dvec3> parse_color_name(std::string_view text) {
    if (text.starts_with('#')) {
        std::uint32_t rrggbb = 0;
        const auto [end, error] = std::from_chars(text.data() + 1, text.data() + text.size(), rrggbb, 16);
        if (text.size() != 7 || error != std::errc() || end != text.data() + text.size()) {
            return fail(
                fmt::format("colour \"{}\": a # must be followed by six hexadecimal digits, as in #ff8000", text));
        }
        return linear_from_hex(rrggbb);
    }
    const auto* known = std::ranges::find(kNames, text, &Name::name);
    if (known != std::end(kNames)) return linear_from_hex(known->rrggbb);
    std::string names;
    for (const Name& name : kNames) names += fmt::format(", {}", name.name);
    return fail(fmt::format("unknown colour \"{}\"; allowed: #rrggbb{}", text, names));
}

Expected<std::vector<glm::dvec3>> parse_colors(std::string_view text, std::size_t least, std::string_view of) {
    std::vector<glm::dvec3> colors;
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t comma = std::min(text.find(',', at), text.size());
        const auto color = parse_color_name(text.substr(at, comma - at));
        if (!color) return tl::unexpected<Error>(color.error());
        if (colors.size() == kMostColors)
            return fail(fmt::format("{}: at most {} colours can be used", of, kMostColors));
        colors.push_back(*color);
        at = comma + 1;
    }
    if (colors.size() < least) {
        return fail(fmt::format("{}: two colours or more with commas between them are needed, as in blue,gold", of));
    }
    return colors;
}

}  // namespace xorvox::host
