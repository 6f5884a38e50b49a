// Surface: a light field as the eye fuses it into a body. Flashes become voxels with a size, a normal and a share of
// open sky, all from the places of the light; this is what pictures draw.
#pragma once

#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "driver/display/description.h"
#include "sim/optics.h"

namespace xorvox::sim {

/// Voxels are drawn so much larger than the space that they stand for, as balls whose gaps close.
inline constexpr float kVoxelFilling = 1.32f;

/// One place of light: a box of space that it stands for, upright and turned about z.
struct Voxel {
    glm::dvec3 place_mm{0.0};
    glm::vec3 half_mm{0.5f};       ///< Half its size: along `across`, along its normal in the plan, and upwards.
    glm::vec2 across{1.0f, 0.0f};  ///< Unit vector in the plan. On a rotating panel it points away from the axis.
    glm::vec3 light{0.0f};         ///< Linear; the mean of the flashes at this place.
    glm::vec3 normal{0.0f};        ///< Unit vector out of the lit body; zero where there is no telling.
    float open = 1.0f;             ///< How free the view from it is: 0 deep in a hollow, 0.5 on a plain, 1 on a tip.
};

/// The lit places that can be seen. Flashes at one place are one voxel; places that lit neighbours wall in on every
/// side, two deep, are left out. In no order. `display` must be valid. Throws std::bad_alloc.
std::vector<Voxel> visible_voxels(const DisplayDescription& display, const LightField& field);

}  // namespace xorvox::sim
