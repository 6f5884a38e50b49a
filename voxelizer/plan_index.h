// PlanIndex: the columns of a table lattice on the snapping grid, sorted into square bins over the plan, so that a
// triangle meets only the columns near it.
//
//   bins      row after row over the plan's box       columns_ of bin b: starts_[b] … starts_[b+1]
//
// There are at most as many bins as columns. Freestanding; internal to the voxelizer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

#include "voxelizer/column_flips.h"
#include "voxelizer/lattice.h"
#include "voxelizer/scratch.h"
#include "voxelizer/snap.h"

namespace xorvox {

class PlanIndex {
public:
    /// Bytes of scratch memory that the constructor takes; 0 for regular lattices.
    static std::size_t scratch_bytes(const Lattice& lattice);

    /// Sorts the columns of a valid table lattice into memory from `scratch`, which has at least
    /// scratch_bytes(lattice).
    PlanIndex(const Lattice& lattice, const SnapGrid& grid, Scratch& scratch);

    /// Flips every column that crosses the triangle, at the first sample above.
    void cross(const glm::ivec3& a, const glm::ivec3& b, const glm::ivec3& c, ColumnFlips& flips) const;

private:
    struct Column {
        glm::ivec3 lowest_sample;
        std::uint32_t bit;  // In a layer of the volume.
    };

    void choose_bins(const Lattice& lattice, const SnapGrid& grid);
    void sort_columns(const Lattice& lattice, const SnapGrid& grid);
    std::size_t bin_of(const glm::ivec3& lowest_sample) const;

    std::uint32_t bin_shift_ = 0;
    std::int32_t bins_x_ = 1;
    std::int32_t bins_y_ = 1;
    std::span<std::int32_t> rises_;
    std::span<std::uint32_t> starts_;
    std::span<Column> columns_;
};

}  // namespace xorvox
