// The rubber duck of the examples, as a function of space.
#pragma once

#include <glm/vec3.hpp>

namespace xorvox::examples {

/// Negative inside of the duck, positive outside, about the distance in millimetres near its surface. It stands on z =
/// 0, looks along +x and is symmetric in y. Made of + - × ÷ and √ only, so that every machine computes the same
/// numbers.
double duck(const glm::dvec3& p);

/// A box around the duck with room on all sides.
inline constexpr glm::dvec3 kDuckMin{-56, -38, -4};
inline constexpr glm::dvec3 kDuckMax{60, 38, 98};

}  // namespace xorvox::examples
