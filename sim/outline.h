// Outline: the edges of the space that a display fills, for scale in pictures.
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "driver/display/description.h"
#include "driver/display/lattice.h"

namespace xorvox::sim {

struct Segment {
    glm::dvec3 from_mm{0.0};
    glm::dvec3 to_mm{0.0};
};

/// The space of a display as pictures show it: half a voxel, as large as it is drawn (kVoxelFilling), beyond its
/// outermost samples, so that none sticks out. The cylinder of a rotating panel holds all of its panels; the other
/// kinds have a box. `display` must be valid.
DisplayExtent drawn_extent(const DisplayDescription& display);

/// The twelve edges of the box, or the rims of the cylinder with rings on its floor; of drawn_extent.
std::vector<Segment> outline(const DisplayDescription& display);

/// Where the display lies in the world, for pictures of all of it: an arrow to +x with an x, along the middle of the
/// floor from the outline outwards, and the axis of what turns, which sticks out of the outline at both ends.
std::vector<Segment> marks(const DisplayDescription& display);

}  // namespace xorvox::sim
