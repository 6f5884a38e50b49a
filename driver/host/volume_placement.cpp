#include "driver/host/volume_placement.h"

#include <limits>

#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

namespace xorvox::host {

glm::dmat4 stretched(const SampledVolume& volume) {
    const glm::dvec3 count(volume.nx, volume.ny, volume.nz);
    glm::dvec3 lower(std::numeric_limits<double>::infinity());
    glm::dvec3 upper(-std::numeric_limits<double>::infinity());
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 side(corner & 1, corner >> 1 & 1, corner >> 2);
        const glm::dvec3 place(volume.to_mm * glm::dvec4(side * count - 0.5, 1.0));
        lower = glm::min(lower, place);
        upper = glm::max(upper, place);
    }
    glm::dmat4 mm_from_box(1.0);
    for (int axis = 0; axis < 3; ++axis) {
        mm_from_box[axis][axis] = upper[axis] - lower[axis];
        mm_from_box[3][axis] = lower[axis];
    }
    return glm::inverse(volume.to_mm) * mm_from_box;
}

}  // namespace xorvox::host
