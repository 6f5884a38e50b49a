// SliceMap: how a display's own samples lie in a Cartesian volume of its size.
//
// It answers three questions. Which voxel of such a volume does each sample take, for those who bring one (resampling;
// voxelizing on the display's own lattice is exact, this is not)? Which samples are needed to light each voxel once, so
// that light is even (uniform mode)? And how often is each voxel passed (coverage, visits)?
//
//   bright    every sample that is inside is lit: most light, but near the axis of a rotor there is more of it, since
//             samples stand closer together there.
//   uniform   of the samples of one panel that stand in the same voxel, only one is lit: the one nearest to the voxel's
//             centre in plan and then in height, of equals the earliest in the order of the lattice. So each voxel that
//             a panel passes is lit once a cycle by that panel. On stacked planes, helix and evenly swept planes it is
//             the same as bright.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "driver/display/description.h"
#include "driver/display/lattice.h"
#include "driver/host/light.h"
#include "voxelizer/bit_volume.h"

namespace xorvox::host {

/// The Cartesian volume of a valid display: a regular lattice that fills the box of extent(display), its pitch as near
/// to the pitches of the display as whole voxels allow.
Lattice cartesian_grid(const DisplayDescription& display);

/// How often the voxels of the Cartesian volume are lit in one cycle when all samples that the mode allows are.
struct SliceCoverage {
    std::size_t voxels = 0;          ///< Of the Cartesian volume.
    std::size_t reachable = 0;       ///< Of these, within the cylinder or box that the display sweeps.
    std::size_t covered = 0;         ///< Of these, with a sample in them.
    std::uint64_t visits = 0;        ///< Samples lit in all of the reachable voxels.
    std::uint32_t least_visits = 0;  ///< Of a covered voxel.
    std::uint32_t most_visits = 0;   ///< The brightest voxel is most ÷ least times as bright as the darkest.
};

class SliceMap {
public:
    /// `display` must be valid; `lattice` is its, and borrowed for the object's life. Throws std::bad_alloc.
    SliceMap(const DisplayDescription& display, const DisplayLattice& lattice);

    /// cartesian_grid(display). On even stacks, and planes swept at constant speed, it is the display's lattice.
    const Lattice& grid() const { return grid_; }

    /// Gives each sample of the display the bit of the voxel that it stands in. `volume` has the shape of grid(),
    /// `samples` that of the display's lattice. Ok or InvalidArgument. Any number of threads.
    Status sample(ConstBitVolumeView volume, BitVolumeView samples) const;

    /// Uniform mode: clears the samples that are not to be lit. Ok or InvalidArgument. Any number of threads.
    Status thin(BitVolumeView samples) const;

    /// Bright and Even light all samples.
    SliceCoverage coverage(LightMode mode) const;

    /// The voxel of sample (x, y, k): x + grid().nx·(y + grid().ny·z). And whether uniform mode lights it.
    std::size_t voxel(std::uint32_t x, std::uint32_t y, std::uint32_t k) const;
    bool is_lit(std::uint32_t x, std::uint32_t y, std::uint32_t k) const;

private:
    void map_columns(const Lattice& lattice, const DisplayDescription& display);
    void choose_columns(const Lattice& lattice, const DisplayDescription& display);
    void choose_heights(const Lattice& lattice);
    std::uint32_t height(double z_mm) const;
    std::uint32_t height(std::size_t column, std::uint32_t k) const;
    bool has_shape(ConstBitVolumeView volume, const Lattice& lattice) const;
    bool has_own_heights() const { return !bases_.empty(); }
    bool is_lit_column(std::uint32_t x, std::uint32_t y) const;
    bool is_reachable(std::uint32_t x, std::uint32_t y) const;

    const DisplayLattice& display_lattice_;
    Lattice grid_;
    double radius_mm_;                       ///< Of the cylinder; 0: the box.
    bool identical_ = false;                 ///< The grid is the display's lattice.
    std::vector<std::uint32_t> columns_;     ///< grid column y·nx + x of each column of the lattice.
    std::vector<double> bases_;              ///< Height of each column, where it is one sample.
    std::vector<std::uint32_t> heights_;     ///< grid z of each k, where columns have one height.
    std::vector<std::uint64_t> lit_;         ///< Uniform mode: a bit a column, rows as in a volume.
    std::vector<std::uint8_t> lit_heights_;  ///< Uniform mode: one a k.
};

}  // namespace xorvox::host
