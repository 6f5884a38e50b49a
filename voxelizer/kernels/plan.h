// What the kernels know of the columns: a region of a regular lattice, or of a table lattice.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "voxelizer/lattice.h"
#include "voxelizer/region.h"
#include "voxelizer/regular_columns.h"
#include "voxelizer/snap.h"

namespace xorvox::kernels {

/// What becomes of a face below a region's lowest sample.
enum class Below : std::uint8_t {
    Counts,   ///< It flips the whole column.
    Dropped,  ///< The parities that the region begins with know of it.
};

/// A triangle on the snapping grid.
struct Triangle {
    glm::ivec3 a, b, c;

    std::int32_t lowest() const { return std::min({a.z, b.z, c.z}); }
    std::int32_t highest() const { return std::max({a.z, b.z, c.z}); }
};

/// A region of a regular lattice. Column (x, y) is bit y · row_bits + x of a layer.
struct RegularPlan {
    RegularColumns columns;
    std::uint32_t row_bits = 64;
    Below below = Below::Counts;

    /// Whether a triangle flips no sample, whatever columns it crosses: it is above the region, or counted below it.
    bool misses(const Triangle& t) const {
        if (columns.sample_from(t.lowest()) >= columns.nz()) return true;
        // The first sample above is at most the one after the first at or above.
        return below == Below::Dropped && columns.sample_from(t.highest()) + 1 < 0;
    }
};

/// A region of a table lattice: its columns, sorted into square bins over the plan; those of neighbouring bins of a row
/// lie side by side, so that a triangle meets one run of places a row.
class TablePlan {
public:
    /// Sorts the columns of a region of a valid table lattice; throws std::bad_alloc.
    void assign(const Lattice& lattice, const SnapGrid& grid, const Region& region);
    void set_below(Below below) { below_ = below; }
    static std::size_t bytes(std::size_t columns);

    std::uint32_t bin_shift() const { return bin_shift_; }
    std::uint32_t bins_x() const { return bins_x_; }
    std::uint32_t bins_y() const { return bins_y_; }
    /// Bin b, row after row, has the places starts()[b] … starts()[b + 1] - 1.
    const std::uint32_t* starts() const { return starts_.data(); }

    /// By place: where the column stands, its lowest sample in the region, and its bit in a layer.
    const std::int32_t* x() const { return x_.data(); }
    const std::int32_t* y() const { return y_.data(); }
    const std::int32_t* z() const { return z_.data(); }
    const std::uint32_t* bits() const { return bits_.data(); }

    std::uint32_t nz() const { return static_cast<std::uint32_t>(rises_.size()); }
    /// The first sample at or above `rise` units over the lowest one; nz() if there is none.
    std::uint32_t first_sample_from(std::int64_t rise) const {
        if (rise <= 0) return 0;
        if (rise > rises_.back()) return nz();
        std::uint32_t k = guesses_[static_cast<std::size_t>(rise) >> guess_shift_];
        while (rises_[k] < rise) ++k;
        return k;
    }
    /// Whether a face `rise` units over the lowest sample is below the sample under that one as well, and the parities
    /// that the region begins with know of it.
    bool is_counted_below(std::int64_t rise) const { return below_ == Below::Dropped && rise <= rise_below_; }
    /// As RegularPlan::misses().
    bool misses(const Triangle& t) const {
        return t.lowest() > highest_sample_ || is_counted_below(std::int64_t{t.highest()} + 1 - lowest_sample_);
    }

private:
    Below below_ = Below::Counts;
    std::uint32_t bin_shift_ = 0;
    std::uint32_t bins_x_ = 1;
    std::uint32_t bins_y_ = 1;
    std::uint32_t guess_shift_ = 0;
    std::int32_t lowest_sample_ = 0;  // Of all columns, as is the next.
    std::int32_t highest_sample_ = 0;
    std::int32_t rise_below_ = 0;  // Of the sample below the region, if there is one: not positive.
    std::vector<std::int32_t> rises_;
    std::vector<std::uint16_t> guesses_;
    std::vector<std::uint32_t> starts_;
    std::vector<std::int32_t> x_, y_, z_;
    std::vector<std::uint32_t> bits_;
};

}  // namespace xorvox::kernels
