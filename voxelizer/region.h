// Region: a box of the samples of a lattice. Freestanding.
#pragma once

#include <glm/vec3.hpp>

#include "voxelizer/lattice.h"

namespace xorvox {

/// The samples (x, y, k) with begin <= (x, y, k) < begin + size, per axis. A volume of a region has the shape `size`,
/// with sample `begin` at (0, 0, 0).
struct Region {
    glm::uvec3 begin{0};
    glm::uvec3 size{0};

    friend bool operator==(const Region&, const Region&) = default;
};

/// All samples of a lattice.
constexpr Region whole(const Lattice& lattice) {
    return {glm::uvec3(0), {lattice.nx, lattice.ny, lattice.nz}};
}

/// Whether `region` has samples, and all of them are in `lattice`.
constexpr bool is_inside(const Region& region, const Lattice& lattice) {
    const auto fits = [](std::uint32_t begin, std::uint32_t size, std::uint32_t n) {
        return size > 0 && begin < n && size <= n - begin;
    };
    return fits(region.begin.x, region.size.x, lattice.nx) && fits(region.begin.y, region.size.y, lattice.ny) &&
           fits(region.begin.z, region.size.z, lattice.nz);
}

}  // namespace xorvox
