// Columns of a table, a lane each, with a triangle that may cross it. Compiled once for each instruction set.
#if defined(XORVOX_KERNELS_SIMD_PAIRS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef XORVOX_KERNELS_SIMD_PAIRS_INL_H_
#undef XORVOX_KERNELS_SIMD_PAIRS_INL_H_
#else
#define XORVOX_KERNELS_SIMD_PAIRS_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>
#include "voxelizer/kernels/direct.h"
#include "voxelizer/kernels/kernel_table.h"
#include "voxelizer/kernels/simd_compress-inl.h"
#include "voxelizer/kernels/simd_quotient-inl.h"
#include "voxelizer/kernels/simd_rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace xorvox::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Writes the events of columns, told by their bits, that a face crosses `rise` over their lowest sample; how many.
template <class D, class V, class M, class B>
HWY_INLINE std::size_t store_at_rises(const TablePlan& plan, D d, V rise, M crossed, B bits, std::uint64_t* to) {
    const hn::RebindToUnsigned<D> du;
    const hn::Rebind<std::int32_t, D> di;
    const hn::RebindToUnsigned<decltype(di)> du32;
    rise = hn::Sub(rise, hn::Set(d, static_cast<double>(plan.lowest_rise())));
    const double highest = plan.rises()[plan.nz() - 1];
    crossed = hn::And(crossed,
                      hn::And(hn::Le(rise, hn::Set(d, highest)), hn::Gt(rise, hn::Set(d, plan.most_counted_below()))));
    const auto height = hn::DemoteTo(di, hn::Max(hn::IfThenElseZero(crossed, rise), hn::Zero(d)));
    auto k = hn::GatherIndex(di, plan.guesses(), hn::ShiftRightSame(height, static_cast<int>(plan.guess_shift())));
    for (std::uint32_t step = 0; step < plan.guess_steps(); ++step) {
        const auto too_low = hn::Lt(hn::GatherIndex(di, plan.rises(), k), height);
        k = hn::Sub(k, hn::VecFromMask(di, too_low));  // Of -1 each.
    }
    const auto layers = hn::ShiftLeft<32>(hn::PromoteTo(du, hn::BitCast(du32, k)));
    return store_compressed(hn::Or(layers, hn::PromoteTo(du, hn::BitCast(du32, bits))), hn::RebindMask(du, crossed),
                            to);
}

/// Pushes the crossings of the pairs that wait, for which there is room, and empties them.
HWY_NOINLINE void cross_pairs(const TablePlan& plan, ColumnPairs& pairs, Events& events) {
    const hn::ScalableTag<double> d;
    const hn::Rebind<std::int32_t, decltype(d)> di;
    const std::size_t lanes = hn::Lanes(d);
    constexpr std::size_t kMaxLanes = HWY_MAX_BYTES / sizeof(double);
    static_assert(ColumnPairs::kBatch % kMaxLanes == 0);
    const auto zero = hn::Zero(d);
    const auto one = hn::Set(d, 1.0);
    const auto reach = hn::Set(d, kExactDepthReach);
    std::uint64_t found[ColumnPairs::kBatch + kMaxLanes];
    std::size_t n = 0;

    for (std::size_t i = 0; i < pairs.count; i += lanes) {
        auto ix = hn::Zero(di);
        auto iy = ix, iz = ix, unused = ix, jx = ix, jy = ix, jz = ix, kx = ix, ky = ix, kz = ix;
        hn::LoadInterleaved4(di, pairs.points[0] + 4 * i, ix, iy, iz, unused);
        hn::LoadInterleaved4(di, pairs.points[1] + 4 * i, jx, jy, jz, unused);
        hn::LoadInterleaved4(di, pairs.points[2] + 4 * i, kx, ky, kz, unused);
        auto x = ix, y = ix, z = ix, bits = ix;
        hn::LoadInterleaved4(di, &pairs.columns[i].x, x, y, z, bits);
        const auto lowest = hn::Min(hn::Min(iz, jz), kz);
        const auto ax = hn::PromoteTo(d, hn::Sub(ix, x));
        const auto ay = hn::PromoteTo(d, hn::Sub(iy, y));
        const auto az = hn::PromoteTo(d, hn::Sub(iz, lowest));
        const auto bx = hn::PromoteTo(d, hn::Sub(jx, x));
        const auto by = hn::PromoteTo(d, hn::Sub(jy, y));
        const auto bz = hn::PromoteTo(d, hn::Sub(jz, lowest));
        const auto cx = hn::PromoteTo(d, hn::Sub(kx, x));
        const auto cy = hn::PromoteTo(d, hn::Sub(ky, y));
        const auto cz = hn::PromoteTo(d, hn::Sub(kz, lowest));

        // The edge functions as in FacetEdge, in either orientation: inside, all three have the same sign.
        const auto ab = hn::Sub(hn::Mul(ax, by), hn::Mul(bx, ay));
        const auto bc = hn::Sub(hn::Mul(bx, cy), hn::Mul(cx, by));
        const auto ca = hn::Sub(hn::Mul(cx, ay), hn::Mul(ax, cy));
        const auto ab_x = hn::Sub(ay, by), ab_y = hn::Sub(bx, ax);
        const auto bc_x = hn::Sub(by, cy), bc_y = hn::Sub(cx, bx);
        const auto ca_x = hn::Sub(cy, ay), ca_y = hn::Sub(ax, cx);
        const auto biased = [&](auto value, auto per_x, auto per_y) HWY_ATTR {
            const auto leans = hn::Or(hn::Gt(per_x, zero), hn::And(hn::Eq(per_x, zero), hn::Gt(per_y, zero)));
            return hn::Sub(value, hn::IfThenZeroElse(leans, one));
        };
        const auto ab_side = biased(ab, ab_x, ab_y);
        const auto bc_side = biased(bc, bc_x, bc_y);
        const auto ca_side = biased(ca, ca_x, ca_y);
        const auto least = hn::Min(hn::Min(ab_side, bc_side), ca_side);
        const auto most = hn::Max(hn::Max(ab_side, bc_side), ca_side);
        const auto area = hn::Add(hn::Add(ab, bc), ca);
        const auto divisor = hn::Abs(area);

        const auto size = hn::Max(hn::Max(farthest(ax, bx, cx), farthest(ay, by, cy)), farthest(az, bz, cz));
        auto able = hn::Lt(hn::Iota(d, static_cast<double>(i)), hn::Set(d, static_cast<double>(pairs.count)));
        const auto large = hn::And(able, hn::Ge(size, reach));
        if (HWY_UNLIKELY(!hn::AllFalse(d, large))) {
            able = hn::AndNot(large, able);
            HWY_ALIGN double is_large[kMaxLanes];
            hn::Store(hn::IfThenElseZero(large, one), d, is_large);
            for (std::size_t lane = 0; lane < lanes; ++lane) {
                if (is_large[lane] == 0) continue;
                const auto point = [&](int corner) {
                    const std::int32_t* const p = pairs.points[corner] + 4 * (i + lane);
                    return glm::ivec3(p[0], p[1], p[2]);
                };
                Facet facet;
                if (facet.set(point(0), point(1), point(2)))
                    push_if_crossed(plan, facet, pairs.columns[i + lane], events);
            }
        }
        auto inside = hn::Or(hn::Ge(least, zero), hn::Lt(most, zero));
        inside = hn::And(inside, hn::And(able, hn::Gt(divisor, zero)));
        const auto sign = hn::And(area, hn::SignBit(d));
        const auto height = hn::Xor(hn::Add(hn::Add(hn::Mul(bc, az), hn::Mul(ca, bz)), hn::Mul(ab, cz)), sign);
        auto touches = inside;
        const auto whole = floor_divide_lanes(height, divisor, hn::Div(one, divisor), touches);
        touches = hn::And(touches, inside);
        auto first_above = hn::Add(whole, one);
        if (HWY_UNLIKELY(!hn::AllFalse(d, touches))) {
            // A point on the plane is above it when the plane falls along the first axis along which it is not level.
            const auto along_x =
                hn::Xor(hn::Add(hn::Add(hn::Mul(bc_x, az), hn::Mul(ca_x, bz)), hn::Mul(ab_x, cz)), sign);
            const auto along_y =
                hn::Xor(hn::Add(hn::Add(hn::Mul(bc_y, az), hn::Mul(ca_y, bz)), hn::Mul(ab_y, cz)), sign);
            const auto above = hn::Or(hn::Lt(along_x, zero), hn::And(hn::Eq(along_x, zero), hn::Le(along_y, zero)));
            first_above = hn::Sub(first_above, hn::IfThenElseZero(hn::And(touches, above), one));
        }
        const auto rise = hn::Add(first_above, hn::Sub(hn::PromoteTo(d, lowest), hn::PromoteTo(d, z)));
        n += store_at_rises(plan, d, rise, inside, bits, found + n);
    }
    events.push(found, n);
    pairs.count = 0;
}

}  // namespace xorvox::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
