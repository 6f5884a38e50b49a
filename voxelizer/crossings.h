// CrossingLists: for each column the places where faces cross it. Their size follows the surface, not the volume.
//
//   starts       0        2  2              6         entries of column c = y·nx + x: starts[c] … starts[c+1]
//   first_above  3  17       0  5  5  40    …         sample numbers, in increasing order within a column
//
// A crossing is told by the first sample above the face: samples k >= first_above are flipped. Faces below the region
// give 0; faces above its top sample give nothing. A number may occur more than once: several faces between
// neighbouring samples. Inside are the samples from the first entry up to the second, from the third up to the fourth,
// and so on; an entry without a partner reaches to the top. In the drawing, column 0 is inside at 3 … 16, column 2 at
// 0 … 4 and 5 … 39: one run, because the crossings at 5 cancel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "voxelizer/bit_volume.h"

namespace xorvox {

/// The crossings of nx × ny columns of nz samples. Hosted. Any number of threads may read it.
struct CrossingLists {
    std::uint32_t nx = 0;
    std::uint32_t ny = 0;
    std::uint32_t nz = 0;
    std::vector<std::uint64_t> starts;       ///< nx·ny + 1 entries.
    std::vector<std::uint16_t> first_above;  ///< Each below nz.

    /// The crossings of column (x, y); x < nx, y < ny.
    std::span<const std::uint16_t> column(std::uint32_t x, std::uint32_t y) const {
        const std::size_t c = std::size_t{y} * nx + x;
        return {first_above.data() + starts[c], first_above.data() + starts[c + 1]};
    }
};

/// A run of samples begin <= k < end of one column that are inside.
struct ColumnRun {
    std::uint16_t begin = 0;
    std::uint16_t end = 0;

    friend bool operator==(const ColumnRun&, const ColumnRun&) = default;
};

/// The runs of a column's sorted crossings in increasing order, written to `runs`, which has room for
/// (crossings.size() + 1) / 2 of them; answers the part of it that was filled. Crossings that cancel give no run, and
/// runs that touch are one. `nz`, the samples of the column, closes a run that is still open.
std::span<ColumnRun> column_runs(std::span<const std::uint16_t> crossings, std::uint32_t nz, std::span<ColumnRun> runs);

/// How many samples are inside, without making a volume.
std::uint64_t count_inside(const CrossingLists& lists);

/// The first column that has a sample inside both, as the index y·nx + x; nx·ny when the solids do not collide. Both
/// lists must have the same shape.
std::size_t first_collision(const CrossingLists& a, const CrossingLists& b);

/// Sets the bits of `out` to the samples that are inside. `out` must have the shape of `lists`; it is overwritten,
/// padding bits zero.
void to_bits(const CrossingLists& lists, BitVolumeView out);

}  // namespace xorvox
