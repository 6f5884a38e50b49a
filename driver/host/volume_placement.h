// Where a volume of samples lies in the box that colour functions are asked in.
//
// A placement is a matrix from points of the box, 0 … 1 along each axis, to places among the voxels, where voxel
// (i, j, k) has its centre at (i, j, k). It is affine: its last row is 0 0 0 1.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "voxelizer/sampled_volume.h"

namespace xorvox::host {

/// The volume stretched over the box: what encloses its voxels, along the axes of its own millimetres, fills the box.
glm::dmat4 stretched(const SampledVolume& volume);

/// A placement as its users apply it, with the size of the volume.
class VolumePlacement {
public:
    VolumePlacement(const SampledVolume& volume, const glm::dmat4& placement)
        : placement_(placement), last_(volume.nx - 1.0, volume.ny - 1.0, volume.nz - 1.0) {}

    void set(const glm::dmat4& placement) { placement_ = placement; }

    /// The place among the voxels of a point of the box; what is outside, or no number, is moved to the border.
    glm::dvec3 at(const glm::vec3& point) const {
        const glm::dvec3 p(point);
        glm::dvec3 place;
        for (int axis = 0; axis < 3; ++axis) {
            const double x =
                placement_[0][axis] * p.x + placement_[1][axis] * p.y + placement_[2][axis] * p.z + placement_[3][axis];
            place[axis] = x > 0.0 ? (x < last_[axis] ? x : last_[axis]) : 0.0;
        }
        return place;
    }

private:
    glm::dmat4 placement_;
    glm::dvec3 last_;
};

}  // namespace xorvox::host
