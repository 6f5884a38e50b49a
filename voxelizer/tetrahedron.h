// Tetrahedron: one simplex of a covering, scan-converted into rows of samples of a regular lattice.
//
// A plane sweeps over the tetrahedron along one axis, slice by slice. A, B, C, D are its vertices from the last to the
// first that the plane meets; which edges it cuts follows from its place between them (Rueda, Ogáyar, Segura, Feito,
// section 4, whose Table 1 names CD instead of AC in the middle column):
//
//            A > s >= B    B > s >= C    C > s >= D
//       P0       AD            AD            AD
//       P1       AB            BD            BD
//       P2       AC            AC            CD
//       P3       -             BC            -
//
// The points bound the rows of a slice, and are only calculated as closely as that takes. Where a row begins and ends
// is exact: the sides P0P1, P0P2, P1P3 and P2P3 of the slice lie on the planes of the faces, and a sample belongs to
// the tetrahedron when it is inside of all of them. A slice with four sides is one convex polygon; its diagonal is
// never looked at. Samples stand at (x + ε, y + ε², z + ε³) along the lattice's axes, whichever of them is swept.
//
// Widths: vertices lie within ±2^30, so the normal of a face is at most 2^62 a component, and its plane at most 3·2^93.
// Divided by the samples' pitch, a power of two, planes are stepped through from sample to sample in 64 bits where
// their values around the tetrahedron allow it, and in 128 otherwise. Freestanding; internal to the voxelizer.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <glm/vec3.hpp>

#include "voxelizer/int128.h"

namespace xorvox {

/// The samples of a regular lattice on the snapping grid, and the way through them; axes are 0 x, 1 y, 2 z.
struct ScanGrid {
    std::array<std::uint32_t, 3> count{};  ///< Samples along x, y, z.
    std::uint32_t shift = 0;               ///< Sample i stands at i·2^shift + 2^(shift-1).
    std::size_t slice_axis = 1;
    std::size_t row_axis = 2;
    std::size_t column_axis = 0;
};

class Tetrahedron {
public:
    /// Prepares the tetrahedron of an apex and the triangle a, b, c. False when it covers no sample for want of volume,
    /// or because its box holds none.
    bool set(const ScanGrid& grid, const glm::ivec3& apex, const glm::ivec3& a, const glm::ivec3& b,
             const glm::ivec3& c);

    /// 1 when a, b, c run counter-clockwise seen from the side where the apex is not, else -1.
    int sign() const { return sign_; }

    /// Calls visit(slice, row, begin, end) for the samples begin … end-1 of each row that has some.
    template <class Visit>
    void scan(const Visit& visit) const {
        for (const Interval& interval : kIntervals) {
            if (fits_64_bits_) {
                scan_interval<std::int64_t>(interval, visit);
            } else {
                scan_interval<Int128>(interval, visit);
            }
        }
    }

private:
    using Point = std::array<std::int64_t, 3>;

    /// A face's plane over the samples of the box: its value, which is not negative inside, at the first of them, and
    /// what a step to the next slice, row and column adds to it.
    struct Plane {
        Int128 value{};
        std::int64_t per_slice = 0;
        std::int64_t per_row = 0;
        std::int64_t per_column = 0;
        double column_of_value = 0.0;  ///< -1 / per_column.
    };
    /// Where a vertex is, in slices and rows from the first of the box.
    struct Corner {
        double slice = 0.0;
        double row = 0.0;
        std::int32_t next_slice = 0;  ///< The first slice of the box that is not before it.
    };
    struct Edge {
        std::uint8_t from;
        std::uint8_t to;
    };
    /// A column of the table above. Vertices are numbered from A = 0; face i is the one opposite of vertex i.
    struct Interval {
        std::uint8_t upper;
        std::uint8_t lower;
        std::uint8_t first_face;
        std::uint8_t face_count;
        std::uint8_t edge_count;
        std::array<Edge, 4> edges;
    };
    struct Range {
        std::int32_t begin = 0;
        std::int32_t end = 0;
    };

    static constexpr std::array<Interval, 3> kIntervals{{
        {0, 1, 1, 3, 3, {{{0, 3}, {0, 1}, {0, 2}, {}}}},
        {1, 2, 0, 4, 4, {{{0, 3}, {1, 3}, {0, 2}, {1, 2}}}},
        {2, 3, 0, 3, 3, {{{0, 3}, {1, 3}, {2, 3}, {}}}},
    }};
    /// Far more than the rounding errors of an approximate place, which are below 2^-27 samples.
    static constexpr double kSlack = 0x1p-20;

    template <class Value>
    static Value product(std::int64_t a, std::int64_t b) {
        if constexpr (std::is_same_v<Value, std::int64_t>) {
            return a * b;
        } else {
            return multiply(a, b);
        }
    }
    template <class Value>
    static bool is_below_zero(const Value& value) {
        if constexpr (std::is_same_v<Value, std::int64_t>) {
            return value < 0;
        } else {
            return is_negative(value);
        }
    }
    template <class Value>
    static double approximate(const Value& value) {
        if constexpr (std::is_same_v<Value, std::int64_t>) {
            return static_cast<double>(value);
        } else {
            return to_double(value);
        }
    }
    template <class Value>
    static Value value_at(const Plane& plane, std::int32_t slice, std::int32_t row) {
        const Value steps = product<Value>(plane.per_slice, slice) + product<Value>(plane.per_row, row);
        if constexpr (std::is_same_v<Value, std::int64_t>) {
            return narrow(plane.value) + steps;
        } else {
            return plane.value + steps;
        }
    }

    /// Takes the columns that are outside of the plane from `columns`; `value` is the plane's at column 0 of the row.
    /// The place where the row meets the plane is approximate, and then moved to where the plane's values say.
    template <class Value>
    static void clip(const Plane& plane, const Value& value, Range& columns) {
        const auto outside = [&](std::int32_t column) {
            return is_below_zero<Value>(value + product<Value>(plane.per_column, column));
        };
        const auto clamped = [&](double column) {
            return static_cast<std::int32_t>(
                std::clamp(column, static_cast<double>(columns.begin), static_cast<double>(columns.end)));
        };
        if (plane.per_column == 0) {
            if (outside(0)) columns.end = columns.begin;
            return;
        }
        const double meeting = approximate(value) * plane.column_of_value;
        if (plane.per_column > 0) {
            columns.begin = clamped(meeting + (1.0 - kSlack));
            while (columns.begin < columns.end && outside(columns.begin)) ++columns.begin;
        } else {
            columns.end = clamped(meeting + (1.0 + kSlack));
            while (columns.end > columns.begin && outside(columns.end - 1)) --columns.end;
        }
    }

    template <class Value, class Visit>
    void scan_interval(const Interval& interval, const Visit& visit) const {
        const std::int32_t first_slice = corners_[interval.lower].next_slice;
        const std::int32_t end_slice = corners_[interval.upper].next_slice;
        if (first_slice >= end_slice) return;
        const CutEdges edges(*this, interval);
        const Plane* const planes = &planes_[interval.first_face];
        for (std::int32_t slice = first_slice; slice < end_slice; ++slice) {
            const Range rows = edges.rows(slice);
            if (rows.begin >= rows.end) continue;
            std::array<Value, 4> values;
            for (std::size_t i = 0; i < interval.face_count; ++i) {
                values[i] = value_at<Value>(planes[i], slice, rows.begin);
            }
            for (std::int32_t row = rows.begin; row < rows.end; ++row) {
                Range columns{0, columns_};
                for (std::size_t i = 0; i < interval.face_count; ++i) {
                    clip(planes[i], values[i], columns);
                    values[i] = values[i] + product<Value>(planes[i].per_row, 1);
                }
                if (columns.begin >= columns.end) continue;
                visit(first_slice_ + static_cast<std::uint32_t>(slice), first_row_ + static_cast<std::uint32_t>(row),
                      first_column_ + static_cast<std::uint32_t>(columns.begin),
                      first_column_ + static_cast<std::uint32_t>(columns.end));
            }
        }
    }

    /// The edges that the slices of an interval cut, as seen along the rows.
    class CutEdges {
    public:
        CutEdges(const Tetrahedron& tetrahedron, const Interval& interval);
        /// All rows, and perhaps more, that a slice has samples in.
        Range rows(std::int32_t slice) const;

    private:
        struct Line {
            Corner from;
            double rows_per_slice;
        };
        std::array<Line, 4> lines_;
        std::size_t count_;
        double row_limit_;
    };

    bool choose_box(const ScanGrid& grid, const std::array<Point, 4>& vertices);
    void set_plane(const ScanGrid& grid, const std::array<Point, 4>& vertices, std::size_t face, bool swapped);

    int sign_ = 1;
    bool fits_64_bits_ = true;
    Point first_sample_{};  // Of the box of samples that the tetrahedron may cover, on the snapping grid.
    std::uint32_t first_slice_ = 0;
    std::uint32_t first_row_ = 0;
    std::uint32_t first_column_ = 0;
    std::int32_t slices_ = 0;
    std::int32_t rows_ = 0;
    std::int32_t columns_ = 0;
    std::array<Plane, 4> planes_{};
    std::array<Corner, 4> corners_{};
};

}  // namespace xorvox
