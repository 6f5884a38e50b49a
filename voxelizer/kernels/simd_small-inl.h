// Small triangles of one width and height in columns, a lane each. Compiled once for each instruction set.
#if defined(XORVOX_KERNELS_SIMD_SMALL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef XORVOX_KERNELS_SIMD_SMALL_INL_H_
#undef XORVOX_KERNELS_SIMD_SMALL_INL_H_
#else
#define XORVOX_KERNELS_SIMD_SMALL_INL_H_
#endif

#include <cstddef>
#include <cstdint>
#include <limits>

#include <hwy/highway.h>
#include "voxelizer/kernels/kernel_table.h"
#include "voxelizer/kernels/simd_compress-inl.h"
#include "voxelizer/kernels/simd_quotient-inl.h"
#include "voxelizer/kernels/simd_rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace xorvox::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Pushes the crossings of one triangle of a batch.
HWY_NOINLINE void cross_in_rows(const RegularPlan& plan, const SmallTriangles::Batch& batch, std::size_t number,
                                std::uint32_t width, std::uint32_t height, Events& events) {
    const auto point = [&](int corner) {
        const std::int32_t* const p = batch.points[corner] + 4 * number;
        return glm::ivec3(p[0], p[1], p[2]);
    };
    const KeyBox box(batch.low[number], height << 16 | width);
    RowCrossing rows(plan);
    if (!rows.set({point(0), point(1), point(2)}, box)) return;
    rows.cross(box.y(), box.y() + height, events);
}

/// Pushes the crossings of a batch of triangles whose boxes are width × height columns, and empties it. There is room
/// for all columns of these boxes. Triangles that reach further than kExactDepthReach from their first column, upwards
/// or beyond the region, are done in rows.
HWY_NOINLINE void cross_batch(const RegularPlan& plan, SmallTriangles::Batch& batch, std::uint32_t width,
                              std::uint32_t height, Events& events) {
    const hn::ScalableTag<double> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    const hn::Rebind<std::int32_t, decltype(d)> di;
    const std::size_t lanes = hn::Lanes(d);
    constexpr std::size_t kMaxLanes = HWY_MAX_BYTES / sizeof(double);
    static_assert(SmallTriangles::kBatch % kMaxLanes == 0);
    const RegularColumns& columns = plan.columns;
    const auto shift = static_cast<int>(columns.shift());
    const auto zero = hn::Zero(d);
    const auto one = hn::Set(d, 1.0);
    const auto pitch = hn::Set(d, static_cast<double>(std::int64_t{1} << columns.shift()));
    const auto lower_half = hn::Set(di, 0xffff);
    const auto x0 = hn::Set(di, static_cast<std::int32_t>(columns.x_at(0)));
    const auto y0 = hn::Set(di, static_cast<std::int32_t>(columns.y_at(0)));
    const auto z0 = hn::Set(di, static_cast<std::int32_t>(columns.z_at(0)));
    const auto round_up = hn::Set(di, (std::int32_t{1} << columns.shift()) - 1);
    const auto row_bits = hn::Set(d, static_cast<double>(plan.row_bits));
    const auto layer_step = hn::Set(d, 0x1p32);
    const auto top = hn::Set(d, static_cast<double>(columns.nz()));
    const auto bottom = hn::Set(d, plan.below == Below::Dropped ? 0.0 : -std::numeric_limits<double>::infinity());
    const auto reach = hn::Set(d, kExactDepthReach);
    // 2^52 + v holds v, an integer below 2^52, in its low bits.
    const auto integer = hn::Set(d, 0x1p52);
    const auto low_bits = hn::Set(du, (std::uint64_t{1} << 52) - 1);
    std::uint64_t found[SmallTriangles::kBatch * SmallTriangles::kMaxSide * SmallTriangles::kMaxSide + kMaxLanes];
    std::size_t n = 0;

    for (std::size_t i = 0; i < batch.count; i += lanes) {
        auto ix = hn::Zero(di);
        auto iy = ix, iz = ix, unused = ix, jx = ix, jy = ix, jz = ix, kx = ix, ky = ix, kz = ix;
        hn::LoadInterleaved4(di, batch.points[0] + 4 * i, ix, iy, iz, unused);
        hn::LoadInterleaved4(di, batch.points[1] + 4 * i, jx, jy, jz, unused);
        hn::LoadInterleaved4(di, batch.points[2] + 4 * i, kx, ky, kz, unused);
        const auto low = hn::BitCast(di, hn::LoadU(hn::RebindToUnsigned<decltype(di)>(), batch.low + i));
        const auto column = hn::And(low, lower_half);
        const auto row = hn::ShiftRight<16>(low);
        // Relative to the first column, and to the first sample at or above the lowest vertex.
        const auto lowest = hn::Min(hn::Min(iz, jz), kz);
        const auto base = hn::ShiftRightSame(hn::Add(hn::Sub(lowest, z0), round_up), shift);
        const auto origin_x = hn::Add(hn::ShiftLeftSame(column, shift), x0);
        const auto origin_y = hn::Add(hn::ShiftLeftSame(row, shift), y0);
        const auto origin_z = hn::Add(hn::ShiftLeftSame(base, shift), z0);
        const auto ax = hn::PromoteTo(d, hn::Sub(ix, origin_x));
        const auto ay = hn::PromoteTo(d, hn::Sub(iy, origin_y));
        const auto az = hn::PromoteTo(d, hn::Sub(iz, origin_z));
        const auto bx = hn::PromoteTo(d, hn::Sub(jx, origin_x));
        const auto by = hn::PromoteTo(d, hn::Sub(jy, origin_y));
        const auto bz = hn::PromoteTo(d, hn::Sub(jz, origin_z));
        const auto cx = hn::PromoteTo(d, hn::Sub(kx, origin_x));
        const auto cy = hn::PromoteTo(d, hn::Sub(ky, origin_y));
        const auto cz = hn::PromoteTo(d, hn::Sub(kz, origin_z));

        // The edge functions as in FacetEdge, turned so that the triangle faces up.
        const auto ab = hn::Sub(hn::Mul(ax, by), hn::Mul(bx, ay));
        const auto bc = hn::Sub(hn::Mul(bx, cy), hn::Mul(cx, by));
        const auto ca = hn::Sub(hn::Mul(cx, ay), hn::Mul(ax, cy));
        const auto signed_area = hn::Add(hn::Add(ab, bc), ca);
        const auto sign = hn::And(signed_area, hn::SignBit(d));
        const auto ab_x = hn::Xor(hn::Sub(ay, by), sign);
        const auto ab_y = hn::Xor(hn::Sub(bx, ax), sign);
        const auto bc_x = hn::Xor(hn::Sub(by, cy), sign);
        const auto bc_y = hn::Xor(hn::Sub(cx, bx), sign);
        const auto ca_x = hn::Xor(hn::Sub(cy, ay), sign);
        const auto ca_y = hn::Xor(hn::Sub(ax, cx), sign);
        const auto biased = [&](auto value, auto x, auto y) HWY_ATTR {
            const auto leans = hn::Or(hn::Gt(x, zero), hn::And(hn::Eq(x, zero), hn::Gt(y, zero)));
            return hn::Sub(hn::Xor(value, sign), hn::IfThenZeroElse(leans, one));
        };
        auto ab_row = biased(ab, ab_x, ab_y);
        auto bc_row = biased(bc, bc_x, bc_y);
        auto ca_row = biased(ca, ca_x, ca_y);
        // Height · area, and how it grows.
        const auto along_x = hn::Add(hn::Add(hn::Mul(bc_x, az), hn::Mul(ca_x, bz)), hn::Mul(ab_x, cz));
        const auto along_y = hn::Add(hn::Add(hn::Mul(bc_y, az), hn::Mul(ca_y, bz)), hn::Mul(ab_y, cz));
        auto height_row = hn::Xor(hn::Add(hn::Add(hn::Mul(bc, az), hn::Mul(ca, bz)), hn::Mul(ab, cz)), sign);
        const auto divisor = hn::Mul(hn::Abs(signed_area), pitch);
        const auto inverse = hn::Div(one, divisor);

        auto able = hn::Gt(divisor, zero);
        const auto size = hn::Max(hn::Max(farthest(ax, bx, cx), farthest(ay, by, cy)), farthest(az, bz, cz));
        const auto large = hn::And(able, hn::Gt(size, reach));
        if (HWY_UNLIKELY(!hn::AllFalse(d, large))) {
            able = hn::AndNot(large, able);
            HWY_ALIGN double is_large[kMaxLanes];
            hn::Store(hn::IfThenElseZero(large, one), d, is_large);
            for (std::size_t lane = 0; lane < lanes && i + lane < batch.count; ++lane) {
                if (is_large[lane] != 0) cross_in_rows(plan, batch, i + lane, width, height, events);
            }
        }
        if (i + lanes > batch.count) {
            able = hn::And(able,
                           hn::Lt(hn::Iota(d, static_cast<double>(i)), hn::Set(d, static_cast<double>(batch.count))));
        }
        const auto first = hn::Add(hn::PromoteTo(d, base), one);
        auto place_row = hn::Add(hn::Mul(hn::PromoteTo(d, row), row_bits), hn::PromoteTo(d, column));
        place_row = hn::Add(place_row, integer);
        const auto ab_dx = hn::Mul(ab_x, pitch), bc_dx = hn::Mul(bc_x, pitch), ca_dx = hn::Mul(ca_x, pitch);
        const auto ab_dy = hn::Mul(ab_y, pitch), bc_dy = hn::Mul(bc_y, pitch), ca_dy = hn::Mul(ca_y, pitch);
        const auto height_dx = hn::Mul(along_x, pitch), height_dy = hn::Mul(along_y, pitch);

        for (std::uint32_t y = 0; y < height; ++y) {
            auto ab_at = ab_row;
            auto bc_at = bc_row;
            auto ca_at = ca_row;
            auto height_at = height_row;
            auto place = place_row;
            for (std::uint32_t x = 0; x < width; ++x) {
                const auto least = hn::Min(hn::Min(ab_at, bc_at), ca_at);
                auto inside = hn::And(able, hn::Ge(least, zero));
                auto touches = inside;
                const auto whole = floor_divide_lanes(height_at, divisor, inverse, touches);
                touches = hn::And(touches, inside);
                auto sample = hn::Add(whole, first);
                if (HWY_UNLIKELY(!hn::AllFalse(d, touches))) {
                    // It is above the face when the first component of the upward normal that is not 0 is positive;
                    // the plane falls along x where the normal's x is positive.
                    const auto above =
                        hn::Or(hn::Lt(along_x, zero), hn::And(hn::Eq(along_x, zero), hn::Le(along_y, zero)));
                    sample = hn::Sub(sample, hn::IfThenElseZero(hn::And(touches, above), one));
                }
                inside = hn::And(inside, hn::And(hn::Lt(sample, top), hn::Ge(sample, bottom)));
                const auto event = hn::Add(place, hn::Mul(hn::Max(sample, zero), layer_step));
                const auto bits = hn::And(hn::BitCast(du, event), low_bits);
                n += store_compressed(bits, hn::RebindMask(du, inside), found + n);
                ab_at = hn::Add(ab_at, ab_dx);
                bc_at = hn::Add(bc_at, bc_dx);
                ca_at = hn::Add(ca_at, ca_dx);
                height_at = hn::Add(height_at, height_dx);
                place = hn::Add(place, one);
            }
            ab_row = hn::Add(ab_row, ab_dy);
            bc_row = hn::Add(bc_row, bc_dy);
            ca_row = hn::Add(ca_row, ca_dy);
            height_row = hn::Add(height_row, height_dy);
            place_row = hn::Add(place_row, row_bits);
        }
    }
    events.push(found, n);
    batch.count = 0;
}

inline bool cross_waiting_regular(const RegularPlan& plan, Waiting& waiting, Events& events) {
    SmallTriangles& small = waiting.small;
    for (std::uint32_t i = 0; i < small.batches.size(); ++i) {
        SmallTriangles::Batch& batch = small.batches[i];
        if (batch.count == 0) continue;
        const std::uint32_t width = SmallTriangles::class_side(i % SmallTriangles::kSides);
        const std::uint32_t height = SmallTriangles::class_side(i / SmallTriangles::kSides);
        if (!events.has_room(std::size_t{batch.count} * width * height)) return false;
        cross_batch(plan, batch, width, height, events);
    }
    return true;
}

}  // namespace xorvox::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
