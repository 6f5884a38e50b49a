// RegularColumns: the columns of a regular lattice on the snapping grid, where index i stands at i·2^s + 2^(s-1).
//
// Freestanding; internal to the voxelizer.
#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

#include "voxelizer/column_flips.h"
#include "voxelizer/lattice.h"
#include "voxelizer/snap.h"

namespace xorvox {

class RegularColumns {
public:
    RegularColumns(const Lattice& lattice, const SnapGrid& grid)
        : nx_(lattice.nx), ny_(lattice.ny), nz_(lattice.nz), shift_(grid.shift) {}

    /// Flips every column that crosses the triangle, at the first sample above.
    void cross(const glm::ivec3& a, const glm::ivec3& b, const glm::ivec3& c, ColumnFlips& flips) const;

private:
    struct Range {
        std::int64_t begin;
        std::int64_t end;
    };
    std::int64_t position(std::int64_t index) const { return (index << shift_) + half_pitch(); }
    std::int64_t half_pitch() const { return std::int64_t{1} << (shift_ - 1); }
    std::int64_t first_index_from(std::int64_t coordinate) const;
    Range indices_between(std::int64_t low, std::int64_t high, std::uint32_t count) const;

    std::uint32_t nx_;
    std::uint32_t ny_;
    std::uint32_t nz_;
    std::uint32_t shift_;
};

}  // namespace xorvox
