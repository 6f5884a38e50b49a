// Outline: the edges of the space that a display fills, for scale in pictures.
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "driver/display/description.h"

namespace xorvox::sim {

struct Segment {
    glm::dvec3 from_mm{0.0};
    glm::dvec3 to_mm{0.0};
};

/// The twelve edges of a stack's box, or the rims of a rotating panel's cylinder with rings on its floor.
std::vector<Segment> outline(const DisplayDescription& display);

}  // namespace xorvox::sim
