// RegularColumns: the columns of a region of a regular lattice on the snapping grid, where index i of the lattice
// stands at i·2^s + 2^(s-1). Indices here count from the region's beginning.
//
// Freestanding; internal to the voxelizer.
#pragma once

#include <algorithm>
#include <cstdint>

#include <glm/vec3.hpp>

#include "voxelizer/facet.h"
#include "voxelizer/lattice.h"
#include "voxelizer/region.h"
#include "voxelizer/snap.h"

namespace xorvox {

/// Indices begin <= i < end; empty when end <= begin.
struct IndexRange {
    std::int64_t begin = 0;
    std::int64_t end = 0;

    constexpr bool is_empty() const { return end <= begin; }
};

class RegularColumns {
public:
    RegularColumns() = default;
    RegularColumns(const Region& region, const SnapGrid& grid)
        : begin_(region.begin), size_(region.size), shift_(grid.shift) {}

    std::uint32_t nx() const { return size_.x; }
    std::uint32_t ny() const { return size_.y; }
    std::uint32_t nz() const { return size_.z; }
    std::uint32_t shift() const { return shift_; }

    std::int64_t x_at(std::int64_t x) const { return position(begin_.x + x); }
    std::int64_t y_at(std::int64_t y) const { return position(begin_.y + y); }
    std::int64_t z_at(std::int64_t k) const { return position(begin_.z + k); }

    /// The indices, within the region, of the columns that a triangle between two coordinates can cover: one at `high`
    /// is moved beyond by its ε.
    IndexRange xs_between(std::int64_t low, std::int64_t high) const {
        return {clamped(low, begin_.x, size_.x), clamped(high, begin_.x, size_.x)};
    }
    IndexRange ys_between(std::int64_t low, std::int64_t high) const {
        return {clamped(low, begin_.y, size_.y), clamped(high, begin_.y, size_.y)};
    }
    /// The first sample of a column, counted from the region's lowest, that is at `z` or above; negative below the
    /// region.
    std::int64_t sample_from(std::int64_t z) const { return index_from(z) - begin_.z; }

    /// Calls cross(x, y, k) for every column that crosses the triangle in the rows of `rows`: k is the first sample
    /// above, of which it may be told only when it is below nz(), and negative below the region.
    template <class Cross>
    void cross(const glm::ivec3& a, const glm::ivec3& b, const glm::ivec3& c, IndexRange rows,
               const Cross& cross) const;

private:
    std::int64_t position(std::int64_t index) const { return (index << shift_) + half_pitch(); }
    std::int64_t half_pitch() const { return std::int64_t{1} << (shift_ - 1); }
    std::int64_t index_from(std::int64_t coordinate) const { return (coordinate + half_pitch() - 1) >> shift_; }
    std::int64_t clamped(std::int64_t coordinate, std::uint32_t begin, std::uint32_t size) const {
        return std::clamp<std::int64_t>(index_from(coordinate) - begin, 0, size);
    }
    /// The part of `xs` in which `edge` is not negative at height y.
    IndexRange inside_of(const FacetEdge& edge, std::int64_t y, IndexRange xs) const;

    glm::uvec3 begin_{0};
    glm::uvec3 size_{1};
    std::uint32_t shift_ = 20;
};

inline IndexRange RegularColumns::inside_of(const FacetEdge& edge, std::int64_t y, IndexRange xs) const {
    // value(x) = normal_x · pitch · i + rest, so that a root divides once a row: a span costs no sample outside of it.
    const std::int64_t rest = edge.value(x_at(0), y);
    const std::int64_t slope = edge.normal_x * (std::int64_t{1} << shift_);
    if (slope == 0) return rest >= 0 ? xs : IndexRange{};
    const auto floor_over = [](std::int64_t n, std::int64_t d) { return n / d - (n % d < 0 ? 1 : 0); };
    if (slope > 0) return {std::max(xs.begin, -floor_over(rest, slope)), xs.end};
    return {xs.begin, std::min(xs.end, floor_over(rest, -slope) + 1)};
}

template <class Cross>
void RegularColumns::cross(const glm::ivec3& a, const glm::ivec3& b, const glm::ivec3& c, IndexRange rows,
                           const Cross& cross) const {
    const IndexRange xs = xs_between(std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x}));
    const IndexRange ys = ys_between(std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}));
    const IndexRange wanted{std::max(ys.begin, rows.begin), std::min(ys.end, rows.end)};
    if (xs.is_empty() || wanted.is_empty()) return;
    if (sample_from(std::min({a.z, b.z, c.z})) >= nz()) return;

    Facet facet;
    if (!facet.set(a, b, c)) return;
    // Three divisions a row pay only where they spare many samples.
    constexpr std::int64_t kWide = 8;
    const bool wide = xs.end - xs.begin > kWide;
    for (std::int64_t y = wanted.begin; y < wanted.end; ++y) {
        IndexRange span = xs;
        if (wide) {
            for (const FacetEdge& edge : facet.edges) span = inside_of(edge, y_at(y), span);
        }
        for (std::int64_t x = span.begin; x < span.end; ++x) {
            if (!wide && !facet.contains(x_at(x), y_at(y))) continue;
            cross(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                  sample_from(facet.first_above(x_at(x), y_at(y))));
        }
    }
}

}  // namespace xorvox
