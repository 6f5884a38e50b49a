// Snapping and packing of vertices, lanes of vertices. Compiled once for each instruction set.
#if defined(XORVOX_KERNELS_SIMD_SNAP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef XORVOX_KERNELS_SIMD_SNAP_INL_H_
#undef XORVOX_KERNELS_SIMD_SNAP_INL_H_
#else
#define XORVOX_KERNELS_SIMD_SNAP_INL_H_
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>
#include "voxelizer/kernels/kernel_table.h"

HWY_BEFORE_NAMESPACE();
namespace xorvox::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// voxelizer/snap.cpp in lanes: the same operations in the same order.
inline bool snap_points(const SnapGrid& grid, const glm::dvec3* points, std::size_t count, glm::ivec3* snapped) {
    const hn::ScalableTag<double> d;
    const hn::Rebind<std::int32_t, decltype(d)> di;
    const std::size_t lanes = hn::Lanes(d);
    const auto steps = hn::Set(d, static_cast<double>(std::uint32_t{1} << grid.shift));
    const auto limit = hn::Set(d, static_cast<double>(kSnapLimit));

    // Three vectors hold as many points as they have lanes; the axes of their lanes repeat.
    constexpr std::size_t kMaxLanes = HWY_MAX_BYTES / sizeof(double);
    double origins[3 * kMaxLanes];
    double lengths[3 * kMaxLanes];
    for (std::size_t i = 0; i < 3 * lanes; ++i) {
        origins[i] = grid.origin[static_cast<int>(i % 3)];
        lengths[i] = grid.length[static_cast<int>(i % 3)];
    }
    auto within = hn::Eq(limit, limit);
    const double* const from = &points->x;
    std::int32_t* const to = &snapped->x;
    const std::size_t whole = count - count % lanes;
    for (std::size_t i = 0; i < 3 * whole; i += 3 * lanes) {
        for (std::size_t part = 0; part < 3 * lanes; part += lanes) {
            const auto offset = hn::Sub(hn::LoadU(d, from + i + part), hn::LoadU(d, origins + part));
            const auto value = hn::Mul(hn::Div(offset, hn::LoadU(d, lengths + part)), steps);
            within = hn::And(within, hn::Le(hn::Abs(value), limit));  // Not true of NaN.
            hn::StoreU(hn::DemoteTo(di, hn::Round(value)), di, to + i + part);
        }
    }
    bool all = hn::AllTrue(d, within);
    for (std::size_t i = whole; i < count; ++i) all &= snap(grid, points[i], snapped[i]);
    return all;
}

/// Calls key(x, y) for vectors of coordinates, and stores what it answers.
template <class Key>
HWY_INLINE std::size_t pack(const glm::ivec3* points, std::size_t count, std::uint32_t* keys, const Key& key) {
    const hn::ScalableTag<std::int32_t> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    const std::size_t whole = count - count % hn::Lanes(d);
    for (std::size_t i = 0; i < whole; i += hn::Lanes(d)) {
        auto x = hn::Zero(d);
        auto y = x;
        auto z = x;
        hn::LoadInterleaved3(d, &points[i].x, x, y, z);
        hn::StoreU(hn::BitCast(du, key(x, y)), du, keys + i);
    }
    return whole;
}

inline void pack_regular(const RegularPlan& plan, const glm::ivec3* points, std::size_t count, std::uint32_t* keys) {
    const hn::ScalableTag<std::int32_t> d;
    const RegularColumns& columns = plan.columns;
    const auto zero = hn::Zero(d);
    const auto nx = hn::Set(d, static_cast<std::int32_t>(columns.nx()));
    const auto ny = hn::Set(d, static_cast<std::int32_t>(columns.ny()));
    // Column 0 takes what is up to its position, and column i what is up to i pitches more.
    const auto shift = static_cast<int>(columns.shift());
    const std::int32_t last_unit = (std::int32_t{1} << columns.shift()) - 1;
    const auto to_x = hn::Set(d, last_unit - static_cast<std::int32_t>(columns.x_at(0)));
    const auto to_y = hn::Set(d, last_unit - static_cast<std::int32_t>(columns.y_at(0)));
    const std::size_t done = pack(points, count, keys, [&](auto x, auto y) HWY_ATTR {
        const auto column = hn::Min(hn::Max(hn::ShiftRightSame(hn::Add(x, to_x), shift), zero), nx);
        const auto row = hn::Min(hn::Max(hn::ShiftRightSame(hn::Add(y, to_y), shift), zero), ny);
        return hn::Or(hn::ShiftLeft<16>(row), column);
    });
    kScalarTable.pack_regular(plan, points + done, count - done, keys + done);
}

inline void pack_table(const TablePlan& plan, const glm::ivec3* points, std::size_t count, std::uint32_t* keys) {
    const hn::ScalableTag<std::int32_t> d;
    const auto zero = hn::Zero(d);
    const auto one = hn::Set(d, 1);
    const auto end_x = hn::Set(d, static_cast<std::int32_t>(plan.cells_x() + 1));
    const auto end_y = hn::Set(d, static_cast<std::int32_t>(plan.cells_y() + 1));
    const auto shift = static_cast<int>(plan.cell_shift());
    const std::size_t done = pack(points, count, keys, [&](auto x, auto y) HWY_ATTR {
        const auto column = hn::Min(hn::Max(hn::Add(hn::ShiftRightSame(x, shift), one), zero), end_x);
        const auto row = hn::Min(hn::Max(hn::Add(hn::ShiftRightSame(y, shift), one), zero), end_y);
        return hn::Or(hn::ShiftLeft<16>(row), column);
    });
    kScalarTable.pack_table(plan, points + done, count - done, keys + done);
}

}  // namespace xorvox::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
