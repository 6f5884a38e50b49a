#include "voxelizer/tetrahedron.h"

#include <utility>

namespace xorvox {
namespace {

using Vector = std::array<std::int64_t, 3>;

Vector difference(const Vector& a, const Vector& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

/// Twice the area of the triangle a, b, c as a vector.
Vector normal(const Vector& a, const Vector& b, const Vector& c) {
    const Vector u = difference(b, a);
    const Vector v = difference(c, a);
    return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

Int128 dot(const Vector& a, const Vector& b) {
    return multiply(a[0], b[0]) + multiply(a[1], b[1]) + multiply(a[2], b[2]);
}

int sign_of(const Int128& a) {
    if (is_negative(a)) return -1;
    return is_negative(-a) ? 1 : 0;
}

/// Whether n·(ε, ε², ε³) is positive.
bool leans_positive(const Vector& n) {
    if (n[0] != 0) return n[0] > 0;
    if (n[1] != 0) return n[1] > 0;
    return n[2] > 0;
}

/// The first sample, of all that there would be on an endless lattice, at or beyond `coordinate`.
std::int64_t first_index_from(std::int64_t coordinate, std::uint32_t shift) {
    const std::int64_t half_pitch = std::int64_t{1} << (shift - 1);
    return (coordinate + half_pitch - 1) >> shift;
}

std::int64_t position(std::int64_t index, std::uint32_t shift) {
    return index * (std::int64_t{1} << shift) + (std::int64_t{1} << (shift - 1));
}

}  // namespace

bool Tetrahedron::set(const ScanGrid& grid, const glm::ivec3& apex, const glm::ivec3& a, const glm::ivec3& b,
                      const glm::ivec3& c) {
    const auto point = [](const glm::ivec3& p) { return Point{p.x, p.y, p.z}; };
    std::array<Point, 4> vertices{point(apex), point(a), point(b), point(c)};
    if (!choose_box(grid, vertices)) return false;

    const Vector base = normal(vertices[0], vertices[1], vertices[2]);
    sign_ = sign_of(dot(base, difference(vertices[3], vertices[0])));
    if (sign_ == 0) return false;

    bool odd = sign_ < 0;  // Whether the vertices, in their present order, have a negative volume.
    constexpr std::array<Edge, 5> kComparisons{{{0, 1}, {2, 3}, {0, 2}, {1, 3}, {1, 2}}};
    for (const auto& [i, j] : kComparisons) {
        if (vertices[i][grid.slice_axis] >= vertices[j][grid.slice_axis]) continue;
        std::swap(vertices[i], vertices[j]);
        odd = !odd;
    }

    const double samples_per_unit = 1.0 / static_cast<double>(std::int64_t{1} << grid.shift);
    for (std::size_t i = 0; i < 4; ++i) {
        const Point from_first = difference(vertices[i], first_sample_);
        corners_[i].slice = static_cast<double>(from_first[grid.slice_axis]) * samples_per_unit;
        corners_[i].row = static_cast<double>(from_first[grid.row_axis]) * samples_per_unit;
        const std::int64_t next = first_index_from(vertices[i][grid.slice_axis], grid.shift) - first_slice_;
        corners_[i].next_slice = static_cast<std::int32_t>(std::clamp<std::int64_t>(next, 0, slices_));
    }
    fits_64_bits_ = true;
    for (std::size_t face = 0; face < 4; ++face) set_plane(grid, vertices, face, odd);
    return true;
}

/// A sample at the upper end of the tetrahedron's box is moved beyond it by its ε.
bool Tetrahedron::choose_box(const ScanGrid& grid, const std::array<Point, 4>& vertices) {
    std::array<std::uint32_t, 3> first{};
    std::array<std::int32_t, 3> count{};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto [low, high] = std::minmax({vertices[0][i], vertices[1][i], vertices[2][i], vertices[3][i]});
        const std::int64_t begin = std::max<std::int64_t>(first_index_from(low, grid.shift), 0);
        const std::int64_t end = std::min<std::int64_t>(first_index_from(high, grid.shift), grid.count[i]);
        if (begin >= end) return false;
        first[i] = static_cast<std::uint32_t>(begin);
        count[i] = static_cast<std::int32_t>(end - begin);
        first_sample_[i] = position(begin, grid.shift);
    }
    first_slice_ = first[grid.slice_axis];
    first_row_ = first[grid.row_axis];
    first_column_ = first[grid.column_axis];
    slices_ = count[grid.slice_axis];
    rows_ = count[grid.row_axis];
    columns_ = count[grid.column_axis];
    return true;
}

/// `odd` tells whether the four vertices have a negative volume in this order.
void Tetrahedron::set_plane(const ScanGrid& grid, const std::array<Point, 4>& vertices, std::size_t face, bool odd) {
    const Point& corner = vertices[face == 0 ? 1 : 0];
    Vector inward = normal(corner, vertices[face <= 1 ? 2 : 1], vertices[face <= 2 ? 3 : 2]);
    // Without `odd`, the others in their order see vertex 1 and vertex 3 on the normal's side, and 0 and 2 opposite.
    if ((face % 2 == 0) != odd) inward = {-inward[0], -inward[1], -inward[2]};

    // A sample is inside where plane(sample) >= bias. With the samples a pitch of 2^shift apart, both sides can be
    // divided by it, rounding down what does not depend on the sample.
    const std::int64_t bias = leans_positive(inward) ? 0 : 1;
    Plane& plane = planes_[face];
    plane.value = floor_shift(dot(inward, difference(first_sample_, corner)) + multiply(-bias, 1), grid.shift);
    plane.per_slice = inward[grid.slice_axis];
    plane.per_row = inward[grid.row_axis];
    plane.per_column = inward[grid.column_axis];
    plane.column_of_value = plane.per_column == 0 ? 0.0 : -1.0 / static_cast<double>(plane.per_column);

    const auto size = [](std::int64_t step) { return step < 0 ? -step : step; };
    const Int128 largest = (is_negative(plane.value) ? -plane.value : plane.value) +
                           multiply(size(plane.per_slice), slices_) + multiply(size(plane.per_row), rows_) +
                           multiply(size(plane.per_column), columns_);
    constexpr std::int64_t kLimit = std::int64_t{1} << 62;
    fits_64_bits_ = fits_64_bits_ && !is_negative(multiply(kLimit, 1) - largest);
}

Tetrahedron::CutEdges::CutEdges(const Tetrahedron& tetrahedron, const Interval& interval)
    : lines_{}, count_(interval.edge_count), row_limit_(tetrahedron.rows_) {
    for (std::size_t i = 0; i < count_; ++i) {
        const Corner& from = tetrahedron.corners_[interval.edges[i].from];
        const Corner& to = tetrahedron.corners_[interval.edges[i].to];
        lines_[i] = {from, (to.row - from.row) / (to.slice - from.slice)};
    }
}

Tetrahedron::Range Tetrahedron::CutEdges::rows(std::int32_t slice) const {
    // From a corner on: the difference of slices is exact, so that steep edges lose nothing.
    const auto row_of = [slice](const Line& line) {
        return line.from.row + line.rows_per_slice * (slice - line.from.slice);
    };
    double low = row_of(lines_[0]);
    double high = low;
    for (std::size_t i = 1; i < count_; ++i) {
        const double row = row_of(lines_[i]);
        low = std::min(low, row);
        high = std::max(high, row);
    }
    return {static_cast<std::int32_t>(std::clamp(low + (1.0 - kSlack), 0.0, row_limit_)),
            static_cast<std::int32_t>(std::clamp(high + (1.0 + kSlack), 0.0, row_limit_))};
}

}  // namespace xorvox
