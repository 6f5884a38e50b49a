// Colours as they are typed: a name or #rrggbb (sRGB), and lists of them.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "voxelizer/error.h"

namespace xorvox::host {

/// The most colours of a list.
inline constexpr std::size_t kMostColors = 64;

/// Blue, turquoise, green, yellow and gold, ever lighter, in linear light: what a scale is shown in when no colours
/// are named. Where red begins to count, blue has ceased to, so that the order survives formats with two bits of blue,
/// or one.
std::array<glm::dvec3, 5> rising_colors();

/// The linear light of a colour: #rrggbb, or one of the names of HTML 4 and some more of CSS; messages list them.
Expected<glm::dvec3> parse_color_name(std::string_view text);

/// "COLOR,COLOR,…": at least `least` colours, at most kMostColors. `of` is what messages begin with, as in
/// "gradient:blue,gold".
Expected<std::vector<glm::dvec3>> parse_colors(std::string_view text, std::size_t least, std::string_view of);

}  // namespace xorvox::host
