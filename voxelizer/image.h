// Image: a picture in memory, for textures.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace xorvox {

/// width × height pixels, row after row, the upper one first. A pixel is R, G, B and A as files have them: R, G and B
/// are codes of sRGB, A is opacity, 255 opaque.
struct Image {
    static constexpr std::uint32_t kMostSide = 16384;

    std::uint32_t width = 0;                          ///< 1 … kMostSide; 0: no image.
    std::uint32_t height = 0;                         ///< The same.
    std::vector<std::array<std::uint8_t, 4>> pixels;  ///< width · height.
};

}  // namespace xorvox
