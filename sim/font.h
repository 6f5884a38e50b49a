// Font: an alphabet of pixels for charts and legends.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace xorvox::sim {

inline constexpr int kGlyphWidth = 5;    ///< Pixels.
inline constexpr int kGlyphAdvance = 6;  ///< From letter to letter.
inline constexpr int kGlyphAscent = 7;   ///< From the top of tall letters to the line they stand on.
inline constexpr int kGlyphHeight = 9;   ///< And on to the foot of those that reach below it.

/// Rows from the top; what is not ' ' is ink. Rows may be shorter than kGlyphWidth.
using Glyph = std::array<std::string_view, kGlyphHeight>;

/// Letters, digits and . , : - _ + = / ( ); an empty box for anything else.
const Glyph& glyph(char letter);

}  // namespace xorvox::sim
