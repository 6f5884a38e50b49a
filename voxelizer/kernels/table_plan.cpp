#include <algorithm>
#include <bit>
#include <limits>

#include <glm/common.hpp>

#include "voxelizer/column_flips.h"
#include "voxelizer/kernels/plan.h"
#include "voxelizer/resize_exactly.h"

namespace xorvox::kernels {
namespace {

constexpr std::size_t kMostGuesses = 1 << 15;
constexpr std::size_t kMostSideCells = 0xfff0;  // They are packed in 16 bits.

/// The finer the cells, the fewer triangles seem to touch a column; but they should stay in a core's caches.
constexpr std::size_t most_cells(std::size_t columns) {
    return std::min(16 * columns, std::max<std::size_t>(2 * columns, 2'000'000));
}
/// The fuller the bins, the fewer runs of columns, but the more of these are beside the triangle.
constexpr std::size_t most_bins(std::size_t columns) {
    return 6 * columns;
}

}  // namespace

std::size_t TablePlan::bytes(std::size_t columns) {
    // Beside the cells there is a border of empty ones.
    const std::size_t cells = most_cells(columns);
    return (columns + kColumnSlack) * sizeof(TableColumn) +
           (most_bins(columns) + 1 + cells + 4 * std::min(cells, kMostSideCells) + 4) * sizeof(std::uint32_t) +
           (kMaxLatticeSide + kMostGuesses) * sizeof(std::int32_t) + 64;
}

void TablePlan::assign_heights(const Lattice& lattice, const SnapGrid& grid, std::uint32_t begin, std::uint32_t size) {
    lowest_rise_ = snapped_rise(lattice, grid, begin);
    resize_exactly(rises_, size);
    for (std::uint32_t k = 0; k < size; ++k) rises_[k] = snapped_rise(lattice, grid, begin + k) - lowest_rise_;
    rise_below_ =
        begin == 0 ? std::numeric_limits<std::int32_t>::min() : snapped_rise(lattice, grid, begin - 1) - lowest_rise_;
    // Guesses so fine that there is one sample between two of them, if these are not too many.
    std::int32_t least_step = std::numeric_limits<std::int32_t>::max();
    for (std::size_t i = 1; i < rises_.size(); ++i) least_step = std::min(least_step, rises_[i] - rises_[i - 1]);
    guess_shift_ = 0;
    while (guess_shift_ < 21 && (std::int64_t{2} << guess_shift_) <= least_step) ++guess_shift_;
    while ((static_cast<std::size_t>(rises_.back()) >> guess_shift_) >= kMostGuesses) ++guess_shift_;
    resize_exactly(guesses_, (static_cast<std::size_t>(rises_.back()) >> guess_shift_) + 1);
    guess_steps_ = 1;
    std::int32_t k = 0;
    for (std::size_t g = 0; g < guesses_.size(); ++g) {
        std::uint32_t steps = 0;
        for (; rises_[static_cast<std::size_t>(k)] < static_cast<std::int64_t>(g << guess_shift_); ++k) ++steps;
        guesses_[g] = k;
        guess_steps_ = std::max(guess_steps_, steps);
    }
    guess_steps_ =
        std::max(guess_steps_, static_cast<std::uint32_t>(rises_.size() - 1) - static_cast<std::uint32_t>(k));
}

void TablePlan::assign_columns(const Lattice& lattice, const SnapGrid& grid, const Region& region) {
    const Box box = sample_bounds(lattice);
    glm::ivec3 upper{0};
    (void)snap(grid, box.upper, upper);
    const std::size_t count = std::size_t{region.size.x} * region.size.y;
    for (cell_shift_ = 0;; ++cell_shift_) {
        cells_x_ = static_cast<std::uint32_t>(upper.x >> cell_shift_) + 1;
        cells_y_ = static_cast<std::uint32_t>(upper.y >> cell_shift_) + 1;
        if (cells_x_ > kMostSideCells || cells_y_ > kMostSideCells) continue;
        if (std::uint64_t{cells_x_} * cells_y_ <= most_cells(count)) break;
    }
    std::uint32_t bins_y = 1;
    for (bin_cells_log2_ = 0;; ++bin_cells_log2_) {
        bins_x_ = ((cells_x_ - 1) >> bin_cells_log2_) + 1;
        bins_y = ((cells_y_ - 1) >> bin_cells_log2_) + 1;
        if (std::uint64_t{bins_x_} * bins_y <= most_bins(count)) break;
    }

    const auto column_at = [&](std::size_t i) {
        const std::size_t x = region.begin.x + i % region.size.x;
        const std::size_t y = region.begin.y + i / region.size.x;
        return snapped_column(lattice, grid, y * lattice.nx + x);
    };
    const auto bin_of = [&](const glm::ivec3& sample) {
        const std::uint32_t shift = cell_shift_ + bin_cells_log2_;
        return static_cast<std::size_t>(sample.y >> shift) * bins_x_ + static_cast<std::size_t>(sample.x >> shift);
    };
    // Counting sort: first starts_[b] counts the columns of the bins up to b, then each column takes the last free
    // place. Sums: first the columns of each cell.
    starts_.assign(std::size_t{bins_x_} * bins_y + 1, 0);
    sums_.assign(std::size_t{sums_stride()} * (cells_y_ + 2), 0);
    for (std::size_t i = 0; i < count; ++i) {
        const glm::ivec3 sample = column_at(i);
        ++starts_[bin_of(sample)];
        const auto cell_x = static_cast<std::size_t>(sample.x >> cell_shift_);
        const auto cell_y = static_cast<std::size_t>(sample.y >> cell_shift_);
        ++sums_[(cell_y + 1) * sums_stride() + cell_x + 1];
    }
    for (std::uint32_t y = 1; y <= cells_y_ + 1; ++y) {
        std::uint32_t in_row = 0;
        for (std::uint32_t x = 1; x <= cells_x_ + 1; ++x) {
            const std::size_t at = std::size_t{y} * sums_stride() + x;
            in_row += sums_[at];
            sums_[at] = sums_[at - sums_stride()] + in_row;
        }
    }
    for (std::size_t b = 1; b < starts_.size(); ++b) starts_[b] += starts_[b - 1];
    resize_exactly(columns_, count + kColumnSlack);
    lowest_column_ = std::numeric_limits<std::int32_t>::max();
    highest_column_ = std::numeric_limits<std::int32_t>::min();
    for (std::size_t i = count; i-- > 0;) {
        const glm::ivec3 sample = column_at(i);
        const std::size_t place = --starts_[bin_of(sample)];
        const auto x = static_cast<std::uint32_t>(i % region.size.x);
        const auto y = static_cast<std::uint32_t>(i / region.size.x);
        const auto bit = static_cast<std::uint32_t>(column_bit(region.size.x, x, y));
        columns_[place] = {sample.x, sample.y, sample.z, bit};
        lowest_column_ = std::min(lowest_column_, sample.z);
        highest_column_ = std::max(highest_column_, sample.z);
    }
}

}  // namespace xorvox::kernels
