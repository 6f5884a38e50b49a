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
#include "voxelizer/kernels/simd_pairs-inl.h"
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
            p[i][2] = static_cast<double>(std::int64_t{corners[i]->z} - lowest_);
            reach = std::max({reach, std::abs(p[i][0]), std::abs(p[i][1])});
            height = std::max(height, p[i][2]);
        }
        origin_ = t.a;
        exact_ = std::max(reach, height + 1) <= kExactDepthReach;
        fits_ = reach <= kExactEdgeReach;
        if (!exact_ && !facet_.set(t.a, t.b, t.c)) return false;
        return !fits_ || lines_.set(p);
    }

    /// Pushes the crossings of some columns, at most Events::kMaxPushed, for all of which there is room. A vector more
    /// may be read.
    void cross(const TableColumn* columns, std::size_t count) {
        if (!fits_) {
            for (std::size_t i = 0; i < count; ++i) push_if_crossed(plan_, facet_, columns[i], events_);
            return;
        }
        const hn::ScalableTag<double> d;
        const hn::Rebind<std::int32_t, decltype(d)> di;
        const std::size_t lanes = hn::Lanes(d);
        constexpr std::size_t kMaxLanes = HWY_MAX_BYTES / sizeof(double);
        static_assert(kMaxLanes <= TablePlan::kColumnSlack);
        const auto zero = hn::Zero(d);
        const auto one = hn::Set(d, 1.0);
        const auto origin_x = hn::Set(di, origin_.x);
        const auto origin_y = hn::Set(di, origin_.y);
        const auto& e = lines_.edges;
        const auto divisor = hn::Set(d, lines_.area);
        const auto inverse = hn::Set(d, 1.0 / lines_.area);
        const auto end = hn::Set(d, static_cast<double>(count));
        const auto lowest = hn::Set(d, static_cast<double>(lowest_) + 1.0);
        std::size_t n = 0;
        for (std::size_t at = 0; at < count; at += lanes) {
            auto ix = origin_x, iy = origin_x, iz = origin_x, bits = origin_x;
            hn::LoadInterleaved4(di, &columns[at].x, ix, iy, iz, bits);
            const auto x = hn::PromoteTo(d, hn::Sub(ix, origin_x));
            const auto y = hn::PromoteTo(d, hn::Sub(iy, origin_y));
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
            auto inside = hn::Ge(hn::Min(hn::Min(side0, side1), side2), zero);
            inside = hn::And(inside, hn::Lt(hn::Iota(d, static_cast<double>(at)), end));
            // No question here whether there are any: it would be answered wrongly half of the time.
            const auto height = hn::Add(
                hn::Add(hn::Mul(value0, hn::Set(d, lines_.heights[0])), hn::Mul(value1, hn::Set(d, lines_.heights[1]))),
                hn::Mul(value2, hn::Set(d, lines_.heights[2])));
            auto whole = zero;
            if (exact_) {
                auto touches = inside;
                whole = floor_divide_lanes(height, divisor, inverse, touches);
                const auto touch = hn::Set(d, lines_.touch_is_above ? 1.0 : 0.0);
                whole = hn::Sub(whole, hn::IfThenElseZero(touches, touch));
            } else {
                const auto quotient = hn::Mul(height, inverse);
                whole = hn::Floor(quotient);
                const auto fraction = hn::Sub(quotient, whole);
                const auto doubtful = hn::And(inside, hn::Or(hn::Lt(fraction, hn::Set(d, kDoubtfulUnits)),
                                                             hn::Gt(fraction, hn::Set(d, 1.0 - kDoubtfulUnits))));
                if (!hn::AllFalse(d, doubtful)) {
                    inside = hn::AndNot(doubtful, inside);
                    HWY_ALIGN double asked[kMaxLanes];
                    hn::Store(hn::IfThenElseZero(doubtful, one), d, asked);
                    for (std::size_t lane = 0; lane < lanes; ++lane) {
                        if (asked[lane] != 0) push_if_crossed(plan_, facet_, columns[at + lane], events_);
                    }
                }
            }
            const auto rise = hn::Sub(hn::Add(whole, lowest), hn::PromoteTo(d, iz));
            n += store_at_rises(plan_, d, rise, inside, bits, found_ + n);
        }
        events_.push(found_, n);
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
    std::uint64_t found_[Events::kMaxPushed + HWY_MAX_BYTES / sizeof(double)];
};

/// The numbers of the triangles of a block in whose cells there are columns.
struct NearColumns {
    static constexpr std::size_t kCapacity = kBlockTriangles + HWY_MAX_BYTES / sizeof(std::uint32_t);
    std::uint32_t triangle[kCapacity];
    std::size_t count = 0;
};

inline void find_near_columns(const TablePlan& plan, const Vertices& vertices, const Triangles& triangles,
                              std::size_t first, NearColumns& near) {
    const hn::ScalableTag<std::uint32_t> d;
    const hn::RebindToSigned<decltype(d)> di;
    const hn::Repartition<std::uint16_t, decltype(d)> dh;
    const std::size_t lanes = hn::Lanes(d);
    const auto* const keys = reinterpret_cast<const std::int32_t*>(vertices.keys);
    const auto* const sums = reinterpret_cast<const std::int32_t*>(plan.sums());
    const auto lower_half = hn::Set(d, 0xffff);
    const auto stride = hn::Set(d, plan.sums_stride());
    const auto one = hn::Set(dh, 1);
    std::size_t n = 0;
    std::size_t t = first;
    for (; t + lanes <= triangles.count; t += lanes) {
        auto i0 = hn::Zero(d);
        auto i1 = i0;
        auto i2 = i0;
        hn::LoadInterleaved3(d, triangles.indices + 3 * t, i0, i1, i2);
        const auto k0 = hn::BitCast(dh, hn::GatherIndex(di, keys, hn::BitCast(di, i0)));
        const auto k1 = hn::BitCast(dh, hn::GatherIndex(di, keys, hn::BitCast(di, i1)));
        const auto k2 = hn::BitCast(dh, hn::GatherIndex(di, keys, hn::BitCast(di, i2)));
        const auto low = hn::BitCast(d, hn::SaturatedSub(hn::Min(hn::Min(k0, k1), k2), one));
        const auto high = hn::BitCast(d, hn::Max(hn::Max(k0, k1), k2));
        const auto low_x = hn::And(low, lower_half), high_x = hn::And(high, lower_half);
        const auto low_y = hn::Mul(hn::ShiftRight<16>(low), stride), high_y = hn::Mul(hn::ShiftRight<16>(high), stride);
        const auto sum = [&](auto x, auto y)
                             HWY_ATTR { return hn::GatherIndex(di, sums, hn::BitCast(di, hn::Add(x, y))); };
        const auto columns =
            hn::Sub(hn::Sub(sum(high_x, high_y), sum(low_x, high_y)), hn::Sub(sum(high_x, low_y), sum(low_x, low_y)));
        const auto some = hn::Ne(hn::BitCast(d, columns), hn::Zero(d));
        if (hn::AllFalse(d, some)) continue;
        hn::StoreU(hn::Compress(hn::Iota(d, static_cast<std::uint32_t>(t)), some), d, near.triangle + n);
        n += hn::CountTrue(d, some);
    }
    for (; t < triangles.count; ++t) near.triangle[n++] = static_cast<std::uint32_t>(t);
    near.count = n;
}

/// Lets the columns in a triangle's bins that are in its box as well wait with it. False, and nothing waits, when there
/// are more than `most` columns in the bins; there is room for as many.
HWY_INLINE bool let_wait(const TablePlan& plan, const KeyBox& bins, const glm::ivec3* const* corners, std::size_t most,
                         ColumnPairs& pairs) {
    const hn::CappedTag<std::int32_t, 4> d4;
    const auto a = hn::LoadU(d4, &corners[0]->x);
    const auto b = hn::LoadU(d4, &corners[1]->x);
    const auto c = hn::LoadU(d4, &corners[2]->x);
    const std::int32_t left = std::min({corners[0]->x, corners[1]->x, corners[2]->x});
    const std::int32_t right = std::max({corners[0]->x, corners[1]->x, corners[2]->x});
    const std::int32_t front = std::min({corners[0]->y, corners[1]->y, corners[2]->y});
    const std::int32_t back = std::max({corners[0]->y, corners[1]->y, corners[2]->y});
    std::size_t seen = 0;
    std::uint32_t at = pairs.count;
    const bool all = visit_runs(plan, bins, 0, [&](std::size_t, std::uint32_t begin, std::uint32_t end) HWY_ATTR {
        seen += end - begin;
        if (seen > most) return false;
        for (; begin < end; ++begin) {
            // Written in any case, and kept if it is in the box: there is no way to foresee that.
            const TableColumn column = plan.columns()[begin];
            hn::StoreU(a, d4, pairs.points[0] + 4 * at);
            hn::StoreU(b, d4, pairs.points[1] + 4 * at);
            hn::StoreU(c, d4, pairs.points[2] + 4 * at);
            pairs.columns[at] = column;
            at += static_cast<std::uint32_t>((column.x >= left) & (column.x <= right) & (column.y >= front) &
                                             (column.y <= back));
        }
        return true;
    });
    if (all) pairs.count = at;
    return all;
}

/// Copies the columns in a triangle's bins, side by side, so that lanes are full; how many, or `most` + 1 when there
/// are more. A vector beyond `most` may be overwritten.
HWY_INLINE std::size_t copy_columns(const TablePlan& plan, const KeyBox& bins, std::size_t most, TableColumn* to) {
    const hn::ScalableTag<std::uint32_t> d;
    constexpr std::size_t kWords = sizeof(TableColumn) / sizeof(std::uint32_t);
    const std::size_t at_once = hn::Lanes(d) / kWords;
    std::size_t n = 0;
    const bool all = visit_runs(plan, bins, 0, [&](std::size_t, std::uint32_t begin, std::uint32_t end) HWY_ATTR {
        if (n + (end - begin) > most) return false;
        const auto* const from = reinterpret_cast<const std::uint32_t*>(plan.columns() + begin);
        for (std::size_t i = 0; i < end - begin; i += at_once) {
            hn::StoreU(hn::LoadU(d, from + kWords * i), d, reinterpret_cast<std::uint32_t*>(to + n + i));
        }
        n += end - begin;
        return true;
    });
    return all ? n : most + 1;
}

inline bool cross_table(const TablePlan& plan, const Vertices& vertices, const Triangles& triangles,
                        BlockProgress& progress, Waiting& waiting, Events& events) {
    // Of few columns each waits for a lane, with the triangle; more are crossed by one triangle at a time, copied from
    // their bins first unless they are many.
    constexpr std::size_t kMostWaiting = 16;
    static_assert(kMostWaiting < ColumnPairs::kBatch);
    constexpr std::size_t kMostCopied = 256;
    TableColumn copied[kMostCopied + TablePlan::kColumnSlack];
    NearColumns near;
    find_near_columns(plan, vertices, triangles, progress.triangle, near);
    ColumnPairs& pairs = waiting.pairs;
    TableCrossing crossing(plan, events);
    const std::size_t resumed = progress.triangle;
    for (std::size_t i = 0; i < near.count; ++i) {
        const std::uint32_t* const index = triangles.indices + 3 * near.triangle[i];
        progress.triangle = near.triangle[i];
        if (progress.triangle != resumed) progress.part = 0;
        const KeyBox bins(vertices.keys[index[0]], vertices.keys[index[1]], vertices.keys[index[2]]);
        const glm::ivec3* const corners[3] = {&vertices.points[index[0]], &vertices.points[index[1]],
                                              &vertices.points[index[2]]};
        const Triangle triangle{*corners[0], *corners[1], *corners[2]};
        if (plan.misses(triangle)) continue;
        if (pairs.count + kMostWaiting > ColumnPairs::kBatch) {
            if (!events.has_room(pairs.count)) return false;
            cross_pairs(plan, pairs, events);
        }
        if (let_wait(plan, bins, corners, kMostWaiting, pairs) || !crossing.set(triangle)) continue;
        if (const std::size_t n = copy_columns(plan, bins, kMostCopied, copied); n <= kMostCopied) {
            if (!events.has_room(n)) return false;
            crossing.cross(copied, n);
            continue;
        }
        const bool done = visit_runs(plan, bins, progress.part,
                                     [&](std::size_t part, std::uint32_t begin, std::uint32_t end) HWY_ATTR {
                                         progress.part = part;
                                         if (!events.has_room(end - begin)) return false;
                                         crossing.cross(plan.columns() + begin, end - begin);
                                         return true;
                                     });
        if (!done) return false;
    }
    progress = {triangles.count, 0};
    return true;
}

inline bool cross_waiting_table(const TablePlan& plan, Waiting& waiting, Events& events) {
    if (!events.has_room(waiting.pairs.count)) return false;
    cross_pairs(plan, waiting.pairs, events);
    return true;
}

}  // namespace xorvox::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
