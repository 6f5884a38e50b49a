// Noise: gradient noise in three dimensions. Same bits on every machine; any number of threads.
#pragma once

#include <span>

#include <glm/vec3.hpp>

namespace xorvox {

/// Improved noise (K. Perlin, "Improving Noise", SIGGRAPH 2002): smooth with two continuous derivatives, 0 at every
/// point of whole coordinates, within ±1.04, mean about 0, features about one unit in size. It repeats every 256 units
/// along each axis. The permutation is this project's own. 0 where a coordinate is beyond ±2^22 or no number.
float perlin_noise(const glm::vec3& point);

/// The same at many points, `values` has as many entries: up to three times as fast where neighbours in the row are so
/// near to each other that most are in one cell of whole coordinates.
void perlin_noise(std::span<const glm::vec3> points, std::span<float> values);

/// Simplex noise (K. Perlin, "Noise Hardware", 2001, with the tetrahedra's corners reaching √½ so that it is
/// continuous): smooth with three continuous derivatives, within ±1, mean about 0, features somewhat smaller than those
/// of perlin_noise and less aligned with the axes. 0 where a coordinate is beyond ±2^22 or no number.
float simplex_noise(const glm::vec3& point);

/// The same at many points. `values` has as many entries.
void simplex_noise(std::span<const glm::vec3> points, std::span<float> values);

}  // namespace xorvox
