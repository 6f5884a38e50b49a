// Facet: a snapped triangle as columns see it: does a column cross it, and where is the first sample above?
//
// All arithmetic is exact. Vertices and columns lie within ±2^30 (voxelizer/snap.h), so an edge function, twice the
// area of a triangle, is at most 2^62. Freestanding; internal to the voxelizer.
#pragma once

#include <array>
#include <cstdint>

#include <glm/vec3.hpp>

namespace xorvox {

/// The line under an edge, seen from above. Its value grows towards the inside, and is never negative there.
struct FacetEdge {
    std::int64_t normal_x = 0;
    std::int64_t normal_y = 0;
    std::int64_t from_x = 0;
    std::int64_t from_y = 0;
    std::int64_t bias = 0;

    /// Not negative if and only if the column at (x + ε, y + ε²) is inside of the edge.
    constexpr std::int64_t value(std::int64_t x, std::int64_t y) const {
        return normal_x * (x - from_x) + normal_y * (y - from_y) - bias;
    }
};

struct Facet {
    std::array<FacetEdge, 3> edges;

    /// Prepares the triangle a, b, c, in either orientation. False when no column crosses it: seen from above it has no
    /// area.
    bool set(const glm::ivec3& a, glm::ivec3 b, glm::ivec3 c);

    /// Whether the column at (x, y) crosses the triangle.
    constexpr bool contains(std::int64_t x, std::int64_t y) const {
        return (edges[0].value(x, y) | edges[1].value(x, y) | edges[2].value(x, y)) >= 0;
    }

    /// The smallest z for which a sample at (x, y, z) is above the triangle; the column must cross it.
    std::int64_t first_above(std::int64_t x, std::int64_t y) const;

private:
    glm::ivec3 corner_{0};       // On the plane.
    std::int64_t normal_x_ = 0;  // Of the plane, which faces up: normal_z_ > 0.
    std::int64_t normal_y_ = 0;
    std::int64_t normal_z_ = 1;
    bool touch_is_above_ = false;
    bool fits_64_bits_ = true;
};

}  // namespace xorvox
