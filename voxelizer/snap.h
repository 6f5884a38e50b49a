// The snapping grid: the integer coordinates on which every method of xorvox agrees.
//
// Per axis, a coordinate p in the mesh's units becomes q = round((p - origin) / length · steps), to the nearest
// integer, ties to even, each operation in double and in this order. The unit of q, length / steps, is about 2^-20 of
// the lattice's longest side:
//
//   regular   length = pitch, steps = 2^s with s = 20 - ceil(log2 max(nx, ny, nz)); origin: the lattice's. The
//             samples of index i stand at exactly (i + ½)·2^s = i·2^s + 2^(s-1), and 8 <= s <= 20.
//   table     steps = 2^20, origin: the lowest corner of the samples' box. length: in x and y the longest side of the
//             plan, in z the height of the box. A side of zero (one column, one layer) borrows the other's length;
//             where both are zero, a single point, length is 1. The lowest sample of a column is snapped like any
//             point; sample k stands round((z[k] - z[0]) / length · steps) above it. These rounded tables are the
//             lattice from here on.
//
// Freestanding; the functions are pure.
#pragma once

#include <cstddef>
#include <cstdint>

#include <glm/vec3.hpp>

#include "voxelizer/lattice.h"

namespace xorvox {

/// The largest magnitude of a snapped coordinate.
inline constexpr std::int32_t kSnapLimit = std::int32_t{1} << 30;

struct SnapGrid {
    glm::dvec3 origin{0.0};
    glm::dvec3 length{1.0};
    std::uint32_t shift = 20;  ///< steps = 2^shift; on regular lattices also the samples' pitch in units.
};

/// The grid of a lattice that passes validate().
SnapGrid snap_grid(const Lattice& lattice);

/// Writes the grid point nearest to `point` to `snapped`. False, and `snapped` untouched, when a coordinate is not a
/// number or would exceed kSnapLimit: points are never clamped, because that would move planes.
bool snap(const SnapGrid& grid, const glm::dvec3& point, glm::ivec3& snapped);

/// Where the lowest sample of column `column` of a valid table lattice stands on its grid.
glm::ivec3 snapped_column(const Lattice& lattice, const SnapGrid& grid, std::size_t column);

/// How far sample k of a valid table lattice stands above the lowest sample of its column, in units of its grid.
std::int32_t snapped_rise(const Lattice& lattice, const SnapGrid& grid, std::uint32_t k);

}  // namespace xorvox
