#include "voxelizer/facet.h"

#include <utility>

#include <glm/common.hpp>

#include "voxelizer/int128.h"

namespace xorvox {
namespace {

/// Whether the first of the numbers that is not zero is positive: the sign of x·ε + y·ε² + z·ε³.
constexpr bool leans_positive(std::int64_t x, std::int64_t y, std::int64_t z = 0) {
    if (x != 0) return x > 0;
    if (y != 0) return y > 0;
    return z > 0;
}

FacetEdge edge_between(const glm::ivec3& a, const glm::ivec3& b) {
    FacetEdge edge;
    edge.normal_x = std::int64_t{a.y} - b.y;
    edge.normal_y = std::int64_t{b.x} - a.x;
    edge.from_x = a.x;
    edge.from_y = a.y;
    edge.bias = leans_positive(edge.normal_x, edge.normal_y) ? 0 : 1;
    return edge;
}

/// Whether the plane of this triangle can be evaluated in 64 bits above the triangle: each component of its normal is
/// at most the area of that side of the bounding box, so each product is at most the box's volume.
bool fits_64_bits(const glm::ivec3& a, const glm::ivec3& b, const glm::ivec3& c) {
    const glm::ivec3 lower = glm::min(a, glm::min(b, c));
    const glm::ivec3 upper = glm::max(a, glm::max(b, c));
    const auto side = [](std::int32_t low, std::int32_t high) { return std::int64_t{high} - low + 1; };
    const std::int64_t area = side(lower.x, upper.x) * side(lower.y, upper.y);
    return area <= (std::int64_t{1} << 61) / side(lower.z, upper.z);
}

}  // namespace

bool Facet::set(const glm::ivec3& a, glm::ivec3 b, glm::ivec3 c) {
    struct Vector {
        std::int64_t x, y, z;
    };
    const auto from_a = [&a](const glm::ivec3& p) {
        return Vector{std::int64_t{p.x} - a.x, std::int64_t{p.y} - a.y, std::int64_t{p.z} - a.z};
    };
    Vector u = from_a(b);
    Vector v = from_a(c);
    normal_z_ = u.x * v.y - u.y * v.x;
    if (normal_z_ == 0) return false;
    if (normal_z_ < 0) {
        normal_z_ = -normal_z_;
        std::swap(u, v);
        std::swap(b, c);
    }
    normal_x_ = u.y * v.z - u.z * v.y;
    normal_y_ = u.z * v.x - u.x * v.z;
    corner_ = a;
    touch_is_above_ = leans_positive(normal_x_, normal_y_, normal_z_);
    edges = {edge_between(a, b), edge_between(b, c), edge_between(c, a)};
    fits_64_bits_ = fits_64_bits(a, b, c);
    return true;
}

std::int64_t Facet::first_above(std::int64_t x, std::int64_t y) const {
    // The plane is at corner.z + rise / normal_z. A sample on it counts as above when touch_is_above_, so that the
    // answer is the height rounded up, else the next integer; ceil(n / d) is floor((n - 1) / d) + 1.
    const std::int64_t dx = corner_.x - x;
    const std::int64_t dy = corner_.y - y;
    const std::int64_t touch = touch_is_above_ ? -1 : 0;
    if (fits_64_bits_) {
        const std::int64_t rise = normal_x_ * dx + normal_y_ * dy;
        return corner_.z + floor_divide(rise + touch, normal_z_) + 1;
    }
    const Int128 rise = multiply(normal_x_, dx) + multiply(normal_y_, dy);
    return corner_.z + floor_divide(rise + multiply(touch, 1), normal_z_) + 1;
}

}  // namespace xorvox
