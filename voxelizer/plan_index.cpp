#include "voxelizer/plan_index.h"

#include <algorithm>
#include <utility>

#include "voxelizer/facet.h"

namespace xorvox {
std::size_t PlanIndex::scratch_bytes(const Lattice& lattice) {
    if (lattice.is_regular()) return 0;
    const std::size_t columns = lattice.plan.size();
    return Scratch::bytes<std::int32_t>(lattice.z.size()) + Scratch::bytes<std::uint32_t>(columns + 1) +
           Scratch::bytes<Column>(columns);
}

PlanIndex::PlanIndex(const Lattice& lattice, const SnapGrid& grid, Scratch& scratch) {
    rises_ = scratch.take<std::int32_t>(lattice.nz);
    for (std::uint32_t k = 0; k < lattice.nz; ++k) rises_[k] = snapped_rise(lattice, grid, k);

    choose_bins(lattice, grid);
    starts_ = scratch.take<std::uint32_t>(static_cast<std::size_t>(bins_x_) * static_cast<std::size_t>(bins_y_) + 1);
    columns_ = scratch.take<Column>(lattice.column_count());
    sort_columns(lattice, grid);
}

/// The smallest bins of which there are no more than columns.
void PlanIndex::choose_bins(const Lattice& lattice, const SnapGrid& grid) {
    const Box box = sample_bounds(lattice);
    glm::ivec3 upper{0};
    (void)snap(grid, box.upper, upper);
    while (true) {
        bins_x_ = (upper.x >> bin_shift_) + 1;
        bins_y_ = (upper.y >> bin_shift_) + 1;
        if (static_cast<std::uint64_t>(bins_x_) * static_cast<std::uint64_t>(bins_y_) <= lattice.column_count()) return;
        ++bin_shift_;
    }
}

std::size_t PlanIndex::bin_of(const glm::ivec3& lowest) const {
    const auto x = static_cast<std::size_t>(lowest.x >> bin_shift_);
    const auto y = static_cast<std::size_t>(lowest.y >> bin_shift_);
    return y * static_cast<std::size_t>(bins_x_) + x;
}

/// Counting sort: first starts_[b] counts the columns of the bins up to b, then each column takes the last free place.
void PlanIndex::sort_columns(const Lattice& lattice, const SnapGrid& grid) {
    std::fill(starts_.begin(), starts_.end(), 0u);
    for (std::size_t i = 0; i < columns_.size(); ++i) ++starts_[bin_of(snapped_column(lattice, grid, i))];
    for (std::size_t b = 1; b < starts_.size(); ++b) starts_[b] += starts_[b - 1];
    for (std::size_t i = columns_.size(); i-- > 0;) {
        const glm::ivec3 lowest = snapped_column(lattice, grid, i);
        const auto x = static_cast<std::uint32_t>(i % lattice.nx);
        const auto y = static_cast<std::uint32_t>(i / lattice.nx);
        columns_[--starts_[bin_of(lowest)]] = {lowest, static_cast<std::uint32_t>(column_bit(lattice.nx, x, y))};
    }
}

void PlanIndex::cross(const glm::ivec3& a, const glm::ivec3& b, const glm::ivec3& c, ColumnFlips& flips) const {
    const auto bins_between = [this](std::int32_t low, std::int32_t high, std::int32_t bins) {
        return std::pair{std::max<std::int32_t>(low >> bin_shift_, 0), std::min(high >> bin_shift_, bins - 1)};
    };
    const auto [first_x, last_x] = bins_between(std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x}), bins_x_);
    const auto [first_y, last_y] = bins_between(std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}), bins_y_);
    if (first_x > last_x || first_y > last_y) return;

    Facet facet;
    if (!facet.set(a, b, c)) return;
    for (std::int32_t bin_y = first_y; bin_y <= last_y; ++bin_y) {
        const std::size_t row = static_cast<std::size_t>(bin_y) * static_cast<std::size_t>(bins_x_);
        const std::uint32_t begin = starts_[row + static_cast<std::size_t>(first_x)];
        const std::uint32_t end = starts_[row + static_cast<std::size_t>(last_x) + 1];
        for (const Column& column : columns_.subspan(begin, end - begin)) {
            const glm::ivec3& foot = column.lowest_sample;
            if (!facet.contains(foot.x, foot.y)) continue;
            const std::int64_t rise = facet.first_above(foot.x, foot.y) - foot.z;
            const auto k = std::lower_bound(rises_.begin(), rises_.end(), rise) - rises_.begin();
            if (k == std::ssize(rises_)) continue;
            flips.flip(column.bit, static_cast<std::uint32_t>(k));
        }
    }
}

}  // namespace xorvox
