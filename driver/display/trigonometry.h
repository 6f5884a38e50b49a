// Sines, cosines and angles in arithmetic of our own, without the C library's, whose last bits differ between machines:
// every machine makes the same lattice.
#pragma once

#include <glm/vec2.hpp>

namespace xorvox::display {

/// (cos, sin) of an angle in turns. Exact at quarter turns, and the same in all eight octants.
glm::dvec2 direction(double turns);

/// The angle of `place` about the origin in turns, 0 to below 1, counter-clockwise from +x; 0 at the origin.
double angle_turns(const glm::dvec2& place);

}  // namespace xorvox::display
