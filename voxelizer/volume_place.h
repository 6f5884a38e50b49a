// Where a point falls in a SampledVolume. Internal to the voxelizer and the host: what both must do alike.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "voxelizer/sampled_volume.h"

namespace xorvox {

/// `point` by `map`, an affine map, with x last: a row of points along x shares what comes before.
inline glm::dvec3 mapped(const glm::dmat4& map, const glm::dvec3& point) {
    const auto part = [&](int row) {
        return map[0][row] * point.x + (map[1][row] * point.y + (map[2][row] * point.z + map[3][row]));
    };
    return {part(0), part(1), part(2)};
}

/// Whether `at`, in voxels, is within the volume: at most half a voxel beyond the outer centres, and where
/// nearest_voxel() finds a voxel: the sum may round up to the side.
inline bool is_within(const SampledVolume& volume, const glm::dvec3& at) {
    const auto along = [](double place, std::uint32_t side) { return place >= -0.5 && place + 0.5 < side; };
    return along(at.x, volume.nx) && along(at.y, volume.ny) && along(at.z, volume.nz);
}

/// The voxel nearest to `at`, which is within the volume; of two that are equally near, the further one.
inline std::size_t nearest_voxel(const SampledVolume& volume, const glm::dvec3& at) {
    return volume.index(static_cast<std::uint32_t>(at.x + 0.5), static_cast<std::uint32_t>(at.y + 0.5),
                        static_cast<std::uint32_t>(at.z + 0.5));
}

/// Whether voxel number `n` is inside; `threshold` is that of Scalar.
inline bool is_inside(const SampledVolume& volume, std::size_t n, double threshold) {
    switch (volume.kind) {
        case VolumeKind::Scalar: return double{volume.values[n]} >= threshold;
        case VolumeKind::Colors: return volume.colors[n][3] != 0;
        case VolumeKind::Binary:
        case VolumeKind::Labels: break;
    }
    return volume.values[n] != 0.0f;
}

/// The value at `at`, which is within the volume, between those of the eight voxels around it: trilinear, as in Rueda
/// et al., section 3. Beyond the outer centres it is as at the edge.
inline double value_between(const SampledVolume& volume, const glm::dvec3& at) {
    struct Between {
        std::size_t low;
        std::size_t step;  // To the next voxel, in entries; 0 at the end.
        double part;
    };
    const auto axis = [](double place, std::uint32_t side, std::size_t stride) -> Between {
        const double inner = std::clamp(place, 0.0, static_cast<double>(side - 1));
        const auto low = static_cast<std::uint32_t>(inner);
        return {low * stride, low + 1 < side ? stride : 0, inner - low};
    };
    const Between x = axis(at.x, volume.nx, 1);
    const Between y = axis(at.y, volume.ny, volume.nx);
    const Between z = axis(at.z, volume.nz, std::size_t{volume.nx} * volume.ny);
    const float* const from = volume.values.data() + (x.low + y.low + z.low);
    const auto along_x = [&](std::size_t offset) {
        const double a = double{from[offset]};
        return a + x.part * (double{from[offset + x.step]} - a);
    };
    const auto along_y = [&](std::size_t offset) {
        const double a = along_x(offset);
        return a + y.part * (along_x(offset + y.step) - a);
    };
    const double a = along_y(0);
    return a + z.part * (along_y(z.step) - a);
}

}  // namespace xorvox
