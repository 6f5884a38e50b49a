#include <algorithm>
#include <bit>
#include <limits>

#include <glm/common.hpp>

#include "voxelizer/column_flips.h"
#include "voxelizer/kernels/plan.h"

namespace xorvox::kernels {
namespace {

glm::ivec3 snapped_sample(const Lattice& lattice, const SnapGrid& grid, std::size_t column) {
    const double base = lattice.z0.empty() ? 0.0 : lattice.z0[column];
    glm::ivec3 snapped{0};
    // A point of the lattice is within 2^20 units of the grid's origin, so that this cannot fail.
    (void)snap(grid, {lattice.plan[column], base + lattice.z.front()}, snapped);
    return snapped;
}

/// The rounded height of sample k over the lowest sample of its column.
std::int32_t snapped_rise(const Lattice& lattice, const SnapGrid& grid, std::uint32_t k) {
    SnapGrid from_lowest = grid;
    from_lowest.origin = {0.0, 0.0, lattice.z.front()};
    glm::ivec3 snapped{0};
    (void)snap(from_lowest, {0.0, 0.0, lattice.z[k]}, snapped);
    return snapped.z;
}

}  // namespace

std::size_t TablePlan::bytes(std::size_t columns) {
    return columns * (3 * sizeof(std::int32_t) + 2 * sizeof(std::uint32_t)) +
           kMaxLatticeSide * (sizeof(std::int32_t) + 4 * sizeof(std::uint16_t)) + 64;
}

void TablePlan::assign(const Lattice& lattice, const SnapGrid& grid, const Region& region) {
    const std::int32_t lowest_rise = snapped_rise(lattice, grid, region.begin.z);
    rises_.resize(region.size.z);
    for (std::uint32_t k = 0; k < region.size.z; ++k) {
        rises_[k] = snapped_rise(lattice, grid, region.begin.z + k) - lowest_rise;
    }
    rise_below_ = region.begin.z == 0 ? std::numeric_limits<std::int32_t>::min()
                                      : snapped_rise(lattice, grid, region.begin.z - 1) - lowest_rise;
    // A guess for every 2^guess_shift_ units: about two for each sample.
    guess_shift_ = 0;
    while ((static_cast<std::size_t>(rises_.back()) >> guess_shift_) >= 2 * rises_.size() + 2) ++guess_shift_;
    guesses_.resize((static_cast<std::size_t>(rises_.back()) >> guess_shift_) + 1);
    std::uint16_t k = 0;
    for (std::size_t g = 0; g < guesses_.size(); ++g) {
        while (rises_[k] < static_cast<std::int64_t>(g << guess_shift_)) ++k;
        guesses_[g] = k;
    }

    // The smallest bins of which there are no more than columns.
    const Box box = sample_bounds(lattice);
    glm::ivec3 upper{0};
    (void)snap(grid, box.upper, upper);
    const std::size_t count = std::size_t{region.size.x} * region.size.y;
    constexpr std::uint32_t kMostBins = 0xfff0;  // Along a side: they are packed in 16 bits.
    for (bin_shift_ = 0;; ++bin_shift_) {
        bins_x_ = static_cast<std::uint32_t>(upper.x >> bin_shift_) + 1;
        bins_y_ = static_cast<std::uint32_t>(upper.y >> bin_shift_) + 1;
        if (bins_x_ <= kMostBins && bins_y_ <= kMostBins && std::uint64_t{bins_x_} * bins_y_ <= count) break;
        if (bins_x_ == 1 && bins_y_ == 1) break;
    }

    const auto column_at = [&](std::size_t i) {
        const std::size_t x = region.begin.x + i % region.size.x;
        const std::size_t y = region.begin.y + i / region.size.x;
        return snapped_sample(lattice, grid, y * lattice.nx + x);
    };
    const auto bin_of = [&](const glm::ivec3& sample) {
        const auto bin_x = static_cast<std::size_t>(sample.x >> bin_shift_);
        const auto bin_y = static_cast<std::size_t>(sample.y >> bin_shift_);
        return bin_y * bins_x_ + bin_x;
    };
    // Counting sort: first starts_[b] counts the columns of the bins up to b, then each column takes the last free
    // place.
    starts_.assign(std::size_t{bins_x_} * bins_y_ + 1, 0);
    for (std::size_t i = 0; i < count; ++i) ++starts_[bin_of(column_at(i))];
    for (std::size_t b = 1; b < starts_.size(); ++b) starts_[b] += starts_[b - 1];
    x_.resize(count);
    y_.resize(count);
    z_.resize(count);
    bits_.resize(count);
    lowest_sample_ = std::numeric_limits<std::int32_t>::max();
    highest_sample_ = std::numeric_limits<std::int32_t>::min();
    for (std::size_t i = count; i-- > 0;) {
        const glm::ivec3 sample = column_at(i);
        const std::size_t place = --starts_[bin_of(sample)];
        x_[place] = sample.x;
        y_[place] = sample.y;
        z_[place] = sample.z + lowest_rise;
        const auto x = static_cast<std::uint32_t>(i % region.size.x);
        const auto y = static_cast<std::uint32_t>(i / region.size.x);
        bits_[place] = static_cast<std::uint32_t>(column_bit(region.size.x, x, y));
        lowest_sample_ = std::min(lowest_sample_, z_[place]);
        highest_sample_ = std::max(highest_sample_, z_[place] + rises_.back());
    }
}

}  // namespace xorvox::kernels
