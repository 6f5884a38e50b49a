// Lattice: the display's sample points, as nx × ny parallel columns of nz samples.
//
// Column (x, y) stands at a plan position and rises along +z. Its samples are at z0 + z[k], k = 0 … nz-1, one
// increasing table z for the whole lattice. Two kinds of plan:
//
//   regular   column (x, y) at origin + (x+½, y+½)·pitch, samples at origin.z + (k+½)·pitch.z: the centres of a box of
//             voxels whose outer corner is `origin`. The three tables are empty.
//   table     column (x, y) at plan[y·nx + x], samples at z0[y·nx + x] + z[k]. Rotating panels, helices, uneven planes,
//             free points (nz = 1). Several columns may stand at one place. `origin` and `pitch` are not read.
//
// Every lattice has the shape (nx, ny, nz), and so has every BitVolume on it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "voxelizer/status.h"

namespace xorvox {

/// The longest side that a regular lattice may have, in samples; also the most samples in a column of any lattice.
inline constexpr std::uint32_t kMaxLatticeSide = 4096;
/// The most columns, nx × ny, that a lattice may have.
inline constexpr std::size_t kMaxLatticeColumns = std::size_t{1} << 24;

/// Sample points in the mesh's own units (millimetres on a display). A view: the tables are borrowed and must outlive
/// it. Freestanding; may be read by any number of threads.
struct Lattice {
    std::uint32_t nx = 0;
    std::uint32_t ny = 0;
    std::uint32_t nz = 0;
    glm::dvec3 origin{0.0};
    glm::dvec3 pitch{1.0};
    std::span<const glm::dvec2> plan;  ///< nx·ny entries, or empty for a regular plan.
    std::span<const double> z0;        ///< nx·ny entries, or empty (all 0) on a table plan.
    std::span<const double> z;         ///< nz increasing entries on a table plan.

    constexpr bool is_regular() const { return plan.empty(); }
    constexpr std::size_t column_count() const { return std::size_t{nx} * ny; }
    constexpr std::size_t sample_count() const { return column_count() * nz; }
};

/// Where sample (x, y, k) stands, before it is rounded to the grid of voxelizer/snap.h. x < nx, y < ny, k < nz.
constexpr glm::dvec3 sample_position(const Lattice& lattice, std::uint32_t x, std::uint32_t y, std::uint32_t k) {
    if (lattice.is_regular()) {
        return lattice.origin + (glm::dvec3(x, y, k) + 0.5) * lattice.pitch;
    }
    const std::size_t column = std::size_t{y} * lattice.nx + x;
    const double base = lattice.z0.empty() ? 0.0 : lattice.z0[column];
    return {lattice.plan[column].x, lattice.plan[column].y, base + lattice.z[k]};
}

/// Whether no coordinate is infinite or not a number.
bool is_finite(const glm::dvec3& point);

/// A box along the axes.
struct Box {
    glm::dvec3 lower{0.0};
    glm::dvec3 upper{0.0};
};

/// The smallest box around all sample points of a lattice that passes validate().
Box sample_bounds(const Lattice& lattice);

/// Whether `lattice` can be voxelized on: no side of zero, sides and columns within the limits above, tables of the
/// right length, everything finite, pitches positive, z increasing, and not lost when z0 is added to it: the box of the
/// samples, computed in double, is at least half as high as the table. Answers Ok, InvalidArgument or OutOfRange.
Status validate(const Lattice& lattice);

}  // namespace xorvox
