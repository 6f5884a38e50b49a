#include "voxelizer/fit.h"

#include <algorithm>

#include <fmt/format.h>
#include <glm/common.hpp>

namespace xorvox {
namespace {

constexpr double kMargin = 2.0 / 64.0;

}  // namespace

Expected<Box> bounds(const MeshView& mesh) {
    const auto indices = mesh.used_indices();
    if (indices.empty()) return fail("the mesh has no faces, so that there is nothing to voxelize");
    Box box{mesh.positions[indices.front()], mesh.positions[indices.front()]};
    for (const std::uint32_t index : indices) {
        const glm::dvec3& p = mesh.positions[index];
        if (!is_finite(p)) {
            return fail(
                fmt::format("vertex {} (counted from 0) stands at ({}, {}, {}), which is no place: correct the mesh",
                            index, p.x, p.y, p.z));
        }
        box.lower = glm::min(box.lower, p);
        box.upper = glm::max(box.upper, p);
    }
    return box;
}

Expected<Lattice> fit_cube(const Box& box, std::uint32_t n) {
    if (n == 0 || n > kMaxLatticeSide) {
        return fail(fmt::format("{} samples a side: give 1 to {}", n, kMaxLatticeSide));
    }
    const glm::dvec3 size = box.upper - box.lower;
    const double side = std::max({size.x, size.y, size.z}) * (1.0 + kMargin);
    const double pitch = side / n;
    if (!(pitch > 0.0)) {
        return fail(
            fmt::format("all vertices of the mesh stand at ({}, {}, {}), so that it has no size to fit a grid to: "
                        "give the grid's origin and pitch",
                        box.lower.x, box.lower.y, box.lower.z));
    }
    const Lattice lattice{
        .nx = n, .ny = n, .nz = n, .origin = box.lower + (size - side) * 0.5, .pitch = glm::dvec3(pitch)};
    if (validate(lattice) != Status::Ok) {
        return fail(fmt::format("the mesh is {} by {} by {}, too large for double precision: scale it down", size.x,
                                size.y, size.z));
    }
    return lattice;
}

}  // namespace xorvox
