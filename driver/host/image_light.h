// The light of an image between its pixels: bilinear, in linear light. Opacity is not looked at.
#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

#include "voxelizer/image.h"
#include "voxelizer/surface_colors.h"

namespace xorvox::host {

/// Two pixels next to each other in a row or column, and how much the second counts, 0 … 1.
struct PixelPair {
    std::uint32_t first = 0;
    std::uint32_t second = 0;
    float share = 0.0f;
};

/// The pixels of `count` around `u`, which is 0 at the first one's outer border and 1 at the last one's; what is beyond
/// is brought back by `wrap`. No number counts as 0.
PixelPair pixels_at(double u, std::uint32_t count, TextureWrap wrap);

/// The mean of the four pixels. `image` is not empty.
glm::vec3 mix_pixels(const Image& image, const PixelPair& columns, const PixelPair& rows);

}  // namespace xorvox::host
