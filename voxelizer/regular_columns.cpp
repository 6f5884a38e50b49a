#include "voxelizer/regular_columns.h"

#include <algorithm>

#include "voxelizer/facet.h"

namespace xorvox {

/// The smallest index, not negative, whose samples are at or beyond `coordinate`.
std::int64_t RegularColumns::first_index_from(std::int64_t coordinate) const {
    return std::max<std::int64_t>((coordinate + half_pitch() - 1) >> shift_, 0);
}

/// The indices below `count` whose samples are from low to below high: one at high is moved beyond by its ε.
RegularColumns::Range RegularColumns::indices_between(std::int64_t low, std::int64_t high, std::uint32_t count) const {
    return {first_index_from(low), std::min<std::int64_t>(first_index_from(high), count)};
}

void RegularColumns::cross(const glm::ivec3& a, const glm::ivec3& b, const glm::ivec3& c, ColumnFlips& flips) const {
    const Range xs = indices_between(std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x}), nx_);
    if (xs.begin >= xs.end) return;
    const Range ys = indices_between(std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}), ny_);
    if (ys.begin >= ys.end) return;
    if (first_index_from(std::min({a.z, b.z, c.z})) >= nz_) return;

    Facet facet;
    if (!facet.set(a, b, c)) return;
    for (std::int64_t y = ys.begin; y < ys.end; ++y) {
        for (std::int64_t x = xs.begin; x < xs.end; ++x) {
            if (!facet.contains(position(x), position(y))) continue;
            const std::int64_t k = first_index_from(facet.first_above(position(x), position(y)));
            if (k >= nz_) continue;
            flips.flip(column_bit(nx_, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)),
                       static_cast<std::uint32_t>(k));
        }
    }
}

}  // namespace xorvox
