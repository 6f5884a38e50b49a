// Develop: linear light on a film becomes an image: a glow around what is bright, a dark ground, and a curve that never
// burns out.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec4.hpp>

#include "sim/image.h"

namespace xorvox::sim {

/// Linear light, rows from the top; w is the share of the pixel that shows the lit object.
struct Film {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<glm::vec4> pixels;  ///< width · height.
};

/// Makes the image. `glow`: how strongly bright parts shine into their surroundings, 0 … 1. Channels of the film that
/// are no finite number count as 0, and harm no other pixel.
Image develop(const Film& film, float glow);

/// Of each of the film's pixels, how much of it shows the lit object.
std::vector<float> cover_of(const Film& film);

/// Share of the film's pixels of which the object takes at least half.
double covered_share(const Film& film);

/// Share of the image's pixels with a channel at 255.
double clipped_share(const Image& image);

}  // namespace xorvox::sim
