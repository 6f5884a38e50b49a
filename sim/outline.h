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

/// The space of a display as pictures show it: half a pitch beyond its outermost samples, and as much more as its
/// voxels are drawn too large (kVoxelFilling), so that none sticks out. The cylinder of a rotating panel is that of the
/// widest panel. `display` must be valid.
DisplayExtent drawn_extent(const DisplayDescription& display);

/// The twelve edges of a stack's box, or the rims of a rotating panel's cylinder with rings on its floor; of
/// drawn_extent.
std::vector<Segment> outline(const DisplayDescription& display);

}  // namespace xorvox::sim
