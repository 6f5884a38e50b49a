// Label: words on a film, in a tiny alphabet of pixels.
#pragma once

#include <cstdint>
#include <string_view>

#include "sim/develop.h"

namespace xorvox::sim {

/// Pixels from the top of tall letters to the foot of those that reach below the line, before enlarging.
inline constexpr std::uint32_t kLabelHeight = 9;

/// Adds `text` as dim light, its upper left corner at a pixel of `film`, each letter's pixel `size` pixels large. What
/// does not fit into the film is left out. The alphabet has just the letters of the views' names: d e f i n o p r s t.
void draw_label(Film& film, std::string_view text, std::uint32_t column, std::uint32_t row, std::uint32_t size);

}  // namespace xorvox::sim
