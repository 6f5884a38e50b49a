// Triangles on a table plan, lanes of columns. Compiled once for each instruction set.
#if defined(XORVOX_KERNELS_SIMD_TABLE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef XORVOX_KERNELS_SIMD_TABLE_INL_H_
#undef XORVOX_KERNELS_SIMD_TABLE_INL_H_
#else
#define XORVOX_KERNELS_SIMD_TABLE_INL_H_
#endif

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>
#include "voxelizer/kernels/direct.h"
#include "voxelizer/kernels/kernel_table.h"
#include "voxelizer/kernels/simd_rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace xorvox::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Heights are in units of the grid here, up to 2^31, so that the error of an inexact one is below 2^-20.
inline constexpr double kDoubtfulUnits = 0x1p-16;

class TableCrossing {
public:
    TableCrossing(const TablePlan& plan, Events& events) : plan_(plan), events_(events) {}

    bool set(const Triangle& t) {
        if (plan_.misses(t)) return false;
        const glm::ivec3* const corners[3] = {&t.a, &t.b, &t.c};
        lowest_ = t.lowest();
        double p[3][3];
        double reach = 0;
        double height = 0;
        for (int i = 0; i < 3; ++i) {
            p[i][0] = static_cast<double>(std::int64_t{corners[i]->x} - t.a.x);
            p[i][1] = static_cast<double>(std::int64_t{corners[i]->y} - t.a.y);
            p[i][2] = static_cast<double>(corners[i]->z - lowest_);
            reach = std::max({reach, std::abs(p[i][0]), std::abs(p[i][1])});
            height = std::max(height, p[i][2]);
        }
        origin_ = t.a;
        exact_ = std::max(reach, height + 1) <= kExactDepthReach;
        fits_ = reach <= kExactEdgeReach;
        if (!exact_ && !facet_.set(t.a, t.b, t.c)) return false;
        return !fits_ || lines_.set(p);
    }

    void cross(std::uint32_t begin, std::uint32_t end) {
        if (!fits_) {
            for (std::uint32_t place = begin; place < end; ++place) push_if_crossed(plan_, facet_, place, events_);
            return;
        }
        const hn::ScalableTag<double> d;
        const hn::Rebind<std::int32_t, decltype(d)> di;
        const std::size_t lanes = hn::Lanes(d);
        const auto zero = hn::Zero(d);
        const auto one = hn::Set(d, 1.0);
        const auto origin_x = hn::Set(di, origin_.x);
        const auto origin_y = hn::Set(di, origin_.y);
        const auto& e = lines_.edges;
        const auto divisor = hn::Set(d, lines_.area);
        const auto inverse = hn::Set(d, 1.0 / lines_.area);
        std::uint32_t place = begin;
        for (; place + lanes <= end; place += static_cast<std::uint32_t>(lanes)) {
            const auto x = hn::PromoteTo(d, hn::Sub(hn::LoadU(di, plan_.x() + place), origin_x));
            const auto y = hn::PromoteTo(d, hn::Sub(hn::LoadU(di, plan_.y() + place), origin_y));
            const auto value = [&](const EdgeLine& line) HWY_ATTR {
                const auto along_x = hn::Mul(x, hn::Set(d, line.per_x));
                const auto along_y = hn::Mul(y, hn::Set(d, line.per_y));
                return hn::Add(hn::Set(d, line.at_origin), hn::Add(along_x, along_y));
            };
            const auto value0 = value(e[0]);
            const auto value1 = value(e[1]);
            const auto value2 = value(e[2]);
            const auto side0 = hn::Sub(value0, hn::Set(d, e[0].bias));
            const auto side1 = hn::Sub(value1, hn::Set(d, e[1].bias));
            const auto side2 = hn::Sub(value2, hn::Set(d, e[2].bias));
            const auto inside = hn::Ge(hn::Min(hn::Min(side0, side1), side2), zero);
            if (hn::AllFalse(d, inside)) continue;

            const auto height = hn::Add(
                hn::Add(hn::Mul(value0, hn::Set(d, lines_.heights[0])), hn::Mul(value1, hn::Set(d, lines_.heights[1]))),
                hn::Mul(value2, hn::Set(d, lines_.heights[2])));
            const auto quotient = hn::Mul(height, inverse);
            auto whole = hn::Floor(quotient);
            auto doubtful = hn::Lt(zero, zero);
            if (exact_) {
                const auto rest = hn::Sub(height, hn::Mul(whole, divisor));
                whole = hn::Sub(whole, hn::IfThenElseZero(hn::Lt(rest, zero), one));
                whole = hn::Add(whole, hn::IfThenElseZero(hn::Ge(rest, divisor), one));
                const auto touches = hn::Or(hn::Eq(rest, zero), hn::Eq(hn::Abs(rest), divisor));
                const auto touch = hn::Set(d, lines_.touch_is_above ? 1.0 : 0.0);
                whole = hn::Sub(whole, hn::IfThenElseZero(touches, touch));
            } else {
                const auto fraction = hn::Sub(quotient, whole);
                doubtful = hn::Or(hn::Lt(fraction, hn::Set(d, kDoubtfulUnits)),
                                  hn::Gt(fraction, hn::Set(d, 1.0 - kDoubtfulUnits)));
            }
            constexpr std::size_t kMaxLanes = HWY_MAX_BYTES / sizeof(double);
            HWY_ALIGN double wholes[kMaxLanes];
            HWY_ALIGN double state[kMaxLanes];
            hn::Store(whole, d, wholes);
            hn::Store(hn::Add(hn::IfThenElseZero(inside, one), hn::IfThenElseZero(hn::And(inside, doubtful), one)), d,
                      state);
            for (std::size_t i = 0; i < lanes; ++i) {
                const auto column = place + static_cast<std::uint32_t>(i);
                if (state[i] == 1.0) {
                    const std::int64_t first_above = lowest_ + static_cast<std::int64_t>(wholes[i]) + 1;
                    push_at_rise(plan_, column, first_above - plan_.z()[column], events_);
                } else if (state[i] == 2.0) {
                    push_if_crossed(plan_, facet_, column, events_);
                }
            }
        }
        if (place == end) return;
        // Runs are often shorter than a vector: the rest by the same tests, one column at a time.
        for (; place < end; ++place) {
            const double x = static_cast<double>(std::int64_t{plan_.x()[place]} - origin_.x);
            const double y = static_cast<double>(std::int64_t{plan_.y()[place]} - origin_.y);
            double values[3];
            bool inside = true;
            for (int i = 0; i < 3; ++i) {
                values[i] = e[i].at_origin + (e[i].per_x * x + e[i].per_y * y);
                inside &= values[i] >= e[i].bias;
            }
            if (!inside) continue;
            if (!exact_) {
                push_if_crossed(plan_, facet_, place, events_);
                continue;
            }
            const double height =
                values[0] * lines_.heights[0] + values[1] * lines_.heights[1] + values[2] * lines_.heights[2];
            double whole = std::floor(height / lines_.area);
            double rest = height - whole * lines_.area;
            if (rest < 0) {
                whole -= 1;
                rest += lines_.area;
            } else if (rest >= lines_.area) {
                whole += 1;
                rest -= lines_.area;
            }
            if (rest == 0 && lines_.touch_is_above) whole -= 1;
            const std::int64_t first_above = lowest_ + static_cast<std::int64_t>(whole) + 1;
            push_at_rise(plan_, place, first_above - plan_.z()[place], events_);
        }
    }

private:
    const TablePlan& plan_;
    Events& events_;
    LinedTriangle lines_;
    Facet facet_;
    glm::ivec3 origin_{0};
    std::int32_t lowest_ = 0;
    bool exact_ = false;
    bool fits_ = false;
};

inline bool cross_table(const TablePlan& plan, const Vertices& vertices, const Triangles& triangles,
                        BlockProgress& progress, Events& events) {
    TableCrossing crossing(plan, events);
    return cross_bins(plan, vertices, triangles, progress, events, crossing);
}

}  // namespace xorvox::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
