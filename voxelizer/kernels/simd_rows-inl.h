// One triangle, lanes along a row of columns. Compiled once for each instruction set.
#if defined(XORVOX_KERNELS_SIMD_ROWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef XORVOX_KERNELS_SIMD_ROWS_INL_H_
#undef XORVOX_KERNELS_SIMD_ROWS_INL_H_
#else
#define XORVOX_KERNELS_SIMD_ROWS_INL_H_
#endif

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <hwy/highway.h>
#include "voxelizer/kernels/direct.h"
#include "voxelizer/kernels/kernel_table.h"
#include "voxelizer/kernels/simd_compress-inl.h"
#include "voxelizer/kernels/simd_quotient-inl.h"

HWY_BEFORE_NAMESPACE();
namespace xorvox::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Coordinates relative to a point near the triangle up to R = 2^16 keep every plane evaluation exact in a double, at
/// columns within R as well: its edge functions are at most 8·R², and with heights up to R their sum is at most 24·R³,
/// below 2^53. Up to the second one edge functions are exact: at most 2^51.
inline constexpr double kExactDepthReach = 0x1p16;
inline constexpr double kExactEdgeReach = 0x1p24;
/// Where depth is not exact, its error in pitches is far below this; quotients as near to an integer are asked exactly.
inline constexpr double kDoubtful = 0x1p-20;

/// The line under an edge, seen from above: as FacetEdge, in doubles, with its value at the origin.
struct EdgeLine {
    double per_x = 0;
    double per_y = 0;
    double at_origin = 0;
    double bias = 0;

    EdgeLine() = default;
    EdgeLine(const double* a, const double* b)
        : per_x(a[1] - b[1]),
          per_y(b[0] - a[0]),
          at_origin(a[0] * b[1] - b[0] * a[1]),
          bias(per_x > 0 || (per_x == 0 && per_y > 0) ? 0 : 1) {}
};

/// A triangle that faces up, relative to an origin, in doubles.
struct LinedTriangle {
    EdgeLine edges[3];    // Opposite of vertices 2, 0 and 1.
    double heights[3]{};  // Of the vertices opposite of them.
    double area = 0;      // Twice the area: the sum of the edge functions anywhere.
    bool touch_is_above = false;

    /// False when no column crosses it. Coordinates are within kExactEdgeReach in x and y; touch_is_above is right
    /// within kExactDepthReach.
    bool set(const double (&p)[3][3]) {
        edges[0] = EdgeLine(p[0], p[1]);
        edges[1] = EdgeLine(p[1], p[2]);
        edges[2] = EdgeLine(p[2], p[0]);
        area = edges[0].at_origin + edges[1].at_origin + edges[2].at_origin;
        if (area == 0) return false;
        heights[0] = p[2][2];
        heights[1] = p[0][2];
        heights[2] = p[1][2];
        if (area < 0) {
            edges[0] = EdgeLine(p[1], p[0]);
            edges[1] = EdgeLine(p[2], p[1]);
            edges[2] = EdgeLine(p[0], p[2]);
            area = -area;
        }
        // The plane falls along x where the x of its upward normal is positive.
        const double along_x = edges[0].per_x * heights[0] + edges[1].per_x * heights[1] + edges[2].per_x * heights[2];
        const double along_y = edges[0].per_y * heights[0] + edges[1].per_y * heights[1] + edges[2].per_y * heights[2];
        touch_is_above = along_x < 0 || (along_x == 0 && along_y <= 0);
        return true;
    }
};

/// The crossings of one triangle, row by row.
class RowCrossing {
public:
    explicit RowCrossing(const RegularPlan& plan) : plan_(plan) {}

    /// Prepares a triangle whose columns are those of `box`, not empty. False when it has no crossings.
    bool set(const Triangle& t, const KeyBox& box) {
        if (plan_.misses(t)) return false;
        const RegularColumns& columns = plan_.columns;
        triangle_ = t;
        x_begin_ = box.x();
        width_ = box.width();
        y_origin_ = box.y();
        base_ = columns.sample_from(t.lowest());
        const std::int64_t origin[3] = {columns.x_at(box.x()), columns.y_at(box.y()), columns.z_at(base_)};
        const glm::ivec3* const corners[3] = {&t.a, &t.b, &t.c};
        double p[3][3];
        double reach = 0;
        for (int i = 0; i < 3; ++i) {
            for (int axis = 0; axis < 3; ++axis) {
                p[i][axis] = static_cast<double>((*corners[i])[axis] - origin[axis]);
            }
            reach = std::max({reach, std::abs(p[i][0]), std::abs(p[i][1])});
        }
        const double pitch = static_cast<double>(std::int64_t{1} << columns.shift());
        const double rise = static_cast<double>(std::int64_t{t.highest()} - t.lowest());
        if (reach > kExactEdgeReach) {
            depth_ = Depth::Scalar;
            return true;
        }
        if (!lines_.set(p)) return false;
        if (rise == 0) {
            depth_ = Depth::Flat;
        } else if (std::max(reach, rise + pitch) <= kExactDepthReach) {
            depth_ = Depth::Exact;
        } else {
            depth_ = Depth::Filtered;
            (void)facet_.set(t.a, t.b, t.c);
        }
        pitch_ = pitch;
        for (int i = 0; i < 3; ++i) {
            const double per_column = lines_.edges[i].per_x * pitch;
            roots_[i] = per_column == 0 ? 0 : 1.0 / per_column;
        }
        return true;
    }

    /// Pushes the crossings in rows begin … end - 1 of the region, which are rows of the box; there is room for all its
    /// columns in them, and they are at most Events::kMaxPushed, or one row.
    void cross(std::uint32_t begin, std::uint32_t end, Events& events) {
        switch (depth_) {
            case Depth::Scalar: return cross_rows_exactly(plan_, triangle_, begin, end, events);
            case Depth::Flat: return cross_as<Depth::Flat>(begin, end, events);
            case Depth::Exact: return cross_as<Depth::Exact>(begin, end, events);
            case Depth::Filtered: return cross_as<Depth::Filtered>(begin, end, events);
        }
    }

private:
    enum class Depth {
        Scalar,    ///< Not even the edges fit.
        Flat,      ///< One height everywhere.
        Exact,     ///< The remainder tells.
        Filtered,  ///< Doubtful samples are asked with integers.
    };

    template <Depth kDepth>
    void cross_as(std::uint32_t begin, std::uint32_t end, Events& events);

    const RegularPlan& plan_;
    Triangle triangle_;
    LinedTriangle lines_;
    Facet facet_;
    Depth depth_ = Depth::Scalar;
    std::uint32_t x_begin_ = 0;
    std::uint32_t width_ = 0;
    std::uint32_t y_origin_ = 0;
    std::int64_t base_ = 0;
    double pitch_ = 0;
    double roots_[3]{};  // Columns per unit of an edge function.
    std::uint64_t found_[Events::kMaxPushed + HWY_MAX_BYTES / sizeof(double)];
};

static_assert(kMaxLatticeSide <= Events::kMaxPushed);

template <RowCrossing::Depth kDepth>
HWY_NOINLINE void RowCrossing::cross_as(std::uint32_t begin, std::uint32_t end, Events& events) {
    const hn::ScalableTag<double> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    const std::size_t lanes = hn::Lanes(d);
    const auto& e = lines_.edges;
    const auto zero = hn::Zero(d);
    const auto one = hn::Set(d, 1.0);
    const auto bias0 = hn::Set(d, e[0].bias), bias1 = hn::Set(d, e[1].bias), bias2 = hn::Set(d, e[2].bias);
    const auto step0 = hn::Set(d, e[0].per_x * pitch_);
    const auto step1 = hn::Set(d, e[1].per_x * pitch_);
    const auto step2 = hn::Set(d, e[2].per_x * pitch_);
    const auto width = hn::Set(d, static_cast<double>(width_));
    // The first sample above: base + floor(height / (area · pitch)) + 1, or one less where they touch.
    const double area_pitch = lines_.area * pitch_;
    const auto divisor = hn::Set(d, area_pitch);
    const auto inverse = hn::Set(d, 1.0 / area_pitch);
    const auto h0 = hn::Set(d, lines_.heights[0]);
    const auto h1 = hn::Set(d, lines_.heights[1]);
    const auto h2 = hn::Set(d, lines_.heights[2]);
    const auto first = hn::Set(d, static_cast<double>(base_) + 1.0);
    const auto touch = hn::Set(d, lines_.touch_is_above ? 1.0 : 0.0);
    const auto top = hn::Set(d, static_cast<double>(plan_.columns.nz()));
    const auto bottom = hn::Set(d, plan_.below == Below::Dropped ? 0.0 : -std::numeric_limits<double>::infinity());
    // 2^52 + v holds v, an integer below 2^52, in its low bits.
    const auto low_bits = hn::Set(du, (std::uint64_t{1} << 52) - 1);
    const auto layer_step = hn::Set(d, 0x1p32);
    std::size_t n = 0;

    for (std::uint32_t y = begin; y < end; ++y) {
        const double dy = static_cast<double>(y - y_origin_) * pitch_;
        double rows[3];
        double from = 0;
        double to = width_;
        for (int i = 0; i < 3; ++i) {
            rows[i] = e[i].at_origin + e[i].per_y * dy;
            // Columns beyond an edge by more than one are not looked at; the others are told exactly below.
            const double root = -rows[i] * roots_[i];
            if (e[i].per_x > 0) from = std::max(from, root - 1);
            if (e[i].per_x < 0) to = std::min(to, root + 2);
            if (e[i].per_x == 0 && rows[i] < e[i].bias) to = 0;
        }
        if (from >= to) continue;
        const auto edge0 = hn::Set(d, rows[0]), edge1 = hn::Set(d, rows[1]), edge2 = hn::Set(d, rows[2]);
        const auto place = hn::Set(d, 0x1p52 + static_cast<double>(y * std::size_t{plan_.row_bits} + x_begin_));
        for (double x = std::floor(from); x < to; x += static_cast<double>(lanes)) {
            const auto column = hn::Iota(d, x);
            const auto value0 = hn::Add(edge0, hn::Mul(column, step0));
            const auto value1 = hn::Add(edge1, hn::Mul(column, step1));
            const auto value2 = hn::Add(edge2, hn::Mul(column, step2));
            const auto least = hn::Min(hn::Min(hn::Sub(value0, bias0), hn::Sub(value1, bias1)), hn::Sub(value2, bias2));
            auto inside = hn::And(hn::Ge(least, zero), hn::Lt(column, width));
            if (hn::AllFalse(d, inside)) continue;

            auto whole = hn::Set(d, -1.0);  // Flat: above sample base - 1, and a sample that it touches is above it.
            if constexpr (kDepth != Depth::Flat) {
                const auto height = hn::Add(hn::Add(hn::Mul(value0, h0), hn::Mul(value1, h1)), hn::Mul(value2, h2));
                if constexpr (kDepth == Depth::Exact) {
                    auto touches = inside;
                    whole = floor_divide_lanes(height, divisor, inverse, touches);
                    whole = hn::Sub(whole, hn::IfThenElseZero(touches, touch));
                } else {
                    const auto quotient = hn::Mul(height, inverse);
                    whole = hn::Floor(quotient);
                    const auto fraction = hn::Sub(quotient, whole);
                    const auto doubtful = hn::And(inside, hn::Or(hn::Lt(fraction, hn::Set(d, kDoubtful)),
                                                                 hn::Gt(fraction, hn::Set(d, 1.0 - kDoubtful))));
                    if (HWY_UNLIKELY(!hn::AllFalse(d, doubtful))) {
                        constexpr std::size_t kMaxLanes = HWY_MAX_BYTES / sizeof(double);
                        HWY_ALIGN double wholes[kMaxLanes];
                        HWY_ALIGN double asked[kMaxLanes];
                        hn::Store(whole, d, wholes);
                        hn::Store(hn::IfThenElseZero(doubtful, one), d, asked);
                        const RegularColumns& columns = plan_.columns;
                        for (std::size_t i = 0; i < lanes; ++i) {
                            if (asked[i] == 0) continue;
                            const std::int64_t at =
                                x_begin_ + static_cast<std::int64_t>(x) + static_cast<std::int64_t>(i);
                            const std::int64_t above = facet_.first_above(columns.x_at(at), columns.y_at(y));
                            wholes[i] = static_cast<double>(columns.sample_from(above) - base_ - 1);
                        }
                        whole = hn::Load(d, wholes);
                    }
                }
            }
            const auto sample = hn::Add(whole, first);
            inside = hn::And(inside, hn::And(hn::Lt(sample, top), hn::Ge(sample, bottom)));
            const auto event = hn::Add(hn::Add(place, column), hn::Mul(hn::Max(sample, zero), layer_step));
            const auto bits = hn::And(hn::BitCast(du, event), low_bits);
            n += store_compressed(bits, hn::RebindMask(du, inside), found_ + n);
        }
    }
    events.push(found_, n);
}

}  // namespace xorvox::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
