// What the kernels know of the columns: a region of a regular lattice, or of a table lattice.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
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
    bool is_part_of_columns =
        false;  ///< There are samples of the lattice above or below, so that triangles may miss it.

    /// Whether a triangle flips no sample, whatever columns it crosses: it is above the region, or counted below it.
    bool misses(const Triangle& t) const {
        if (columns.sample_from(t.lowest()) >= columns.nz()) return true;
        // The first sample above is at most the one after the first at or above.
        return below == Below::Dropped && columns.sample_from(t.highest()) + 1 < 0;
    }
};

/// A column of a table: where it stands, its lowest sample, be it in the region or not, and its bit in a layer.
struct TableColumn {
    std::int32_t x, y, z;
    std::uint32_t bit;
};

/// A region of a table lattice: its columns, sorted into square bins over the plan; those of neighbouring bins of a row
/// lie side by side, so that a triangle meets one run of places a row.
class TablePlan {
public:
    /// Sorts the columns of a region of a valid table lattice, whatever its layers; throws std::bad_alloc.
    void assign_columns(const Lattice& lattice, const SnapGrid& grid, const Region& region);
    /// Takes the layers begin … begin + size - 1; throws std::bad_alloc.
    void assign_heights(const Lattice& lattice, const SnapGrid& grid, std::uint32_t begin, std::uint32_t size);
    void set_below(Below below) { below_ = below; }
    static std::size_t bytes(std::size_t columns);

    /// The plan is divided into square cells of 2^cell_shift() units. sums()[y · sums_stride() + x] are the columns in
    /// all cells whose keys (kernel_table.h) are at most x and at most y.
    std::uint32_t cell_shift() const { return cell_shift_; }
    std::uint32_t cells_x() const { return cells_x_; }
    std::uint32_t cells_y() const { return cells_y_; }
    const std::uint32_t* sums() const { return sums_.data(); }
    std::uint32_t sums_stride() const { return cells_x_ + 2; }

    /// A bin is a square of 2^bin_cells_log2() by as many cells. Bin b, row after row of bins_x(), has the places
    /// starts()[b] … starts()[b + 1] - 1.
    std::uint32_t bin_cells_log2() const { return bin_cells_log2_; }
    std::uint32_t bins_x() const { return bins_x_; }
    const std::uint32_t* starts() const { return starts_.data(); }

    /// The columns, by place; behind the last one there are kColumnSlack more that may be read.
    const TableColumn* columns() const { return columns_.data(); }
    static constexpr std::size_t kColumnSlack = 16;

    std::uint32_t nz() const { return static_cast<std::uint32_t>(rises_.size()); }
    /// How far the lowest sample of the region is above the lowest of its column.
    std::int32_t lowest_rise() const { return lowest_rise_; }
    /// Heights of the region's samples over its lowest one, increasing from 0; and for every 2^guess_shift() units from
    /// 0 to the highest a sample at or below the first one that is as high.
    const std::int32_t* rises() const { return rises_.data(); }
    const std::int32_t* guesses() const { return guesses_.data(); }
    std::uint32_t guess_shift() const { return guess_shift_; }
    /// How often the next sample must be tried, at most; 1 unless the table is very uneven.
    std::uint32_t guess_steps() const { return guess_steps_; }
    /// Rises up to here are those of is_counted_below().
    double most_counted_below() const {
        return below_ == Below::Dropped ? rise_below_ : -std::numeric_limits<double>::infinity();
    }
    /// The first sample at or above `rise` units over the region's lowest one; nz() if there is none.
    std::uint32_t first_sample_from(std::int64_t rise) const {
        if (rise <= 0) return 0;
        if (rise > rises_.back()) return nz();
        auto k = static_cast<std::uint32_t>(guesses_[static_cast<std::size_t>(rise) >> guess_shift_]);
        while (rises_[k] < rise) ++k;
        return k;
    }
    /// Whether a face `rise` units over the region's lowest sample is below the sample under that one as well, and the
    /// parities that the region begins with know of it.
    bool is_counted_below(std::int64_t rise) const { return below_ == Below::Dropped && rise <= rise_below_; }
    /// As RegularPlan::misses().
    bool misses(const Triangle& t) const {
        if (t.lowest() > std::int64_t{highest_column_} + lowest_rise_ + rises_.back()) return true;
        return is_counted_below(std::int64_t{t.highest()} + 1 - lowest_column_ - lowest_rise_);
    }

private:
    Below below_ = Below::Counts;
    std::uint32_t cell_shift_ = 0;
    std::uint32_t cells_x_ = 1;
    std::uint32_t cells_y_ = 1;
    std::uint32_t bin_cells_log2_ = 0;
    std::uint32_t bins_x_ = 1;
    std::uint32_t guess_shift_ = 0;
    std::uint32_t guess_steps_ = 1;
    std::int32_t lowest_column_ = 0;  // The lowest and the highest of the columns' lowest samples.
    std::int32_t highest_column_ = 0;
    std::int32_t lowest_rise_ = 0;
    std::int32_t rise_below_ = 0;  // Of the sample below the region, if there is one: not positive.
    std::vector<std::int32_t> rises_;
    std::vector<std::int32_t> guesses_;
    std::vector<std::uint32_t> starts_;
    std::vector<std::uint32_t> sums_;
    std::vector<TableColumn> columns_;
};

}  // namespace xorvox::kernels
