// Noise: gradient noise in three dimensions.
#pragma once

#include <glm/vec3.hpp>

namespace xorvox::host {

/// Improved noise (K. Perlin, "Improving Noise", SIGGRAPH 2002): smooth with two continuous derivatives, 0 at every
/// point of whole coordinates, within ±1.04, mean about 0, features about one unit in size. It repeats every 256 units
/// along each axis. The permutation is this project's own. The same bits on every machine; any number of threads.
/// Coordinates within ±2^22.
float perlin_noise(const glm::vec3& point);

}  // namespace xorvox::host
