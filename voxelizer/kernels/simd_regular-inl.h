// Triangles on a regular plan: those that cover no column are dropped by their keys. Compiled once for each
// instruction set.
#if defined(XORVOX_KERNELS_SIMD_REGULAR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef XORVOX_KERNELS_SIMD_REGULAR_INL_H_
#undef XORVOX_KERNELS_SIMD_REGULAR_INL_H_
#else
#define XORVOX_KERNELS_SIMD_REGULAR_INL_H_
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>
#include "voxelizer/kernels/direct.h"
#include "voxelizer/kernels/kernel_table.h"
#include "voxelizer/kernels/simd_rows-inl.h"
#include "voxelizer/kernels/simd_small-inl.h"

HWY_BEFORE_NAMESPACE();
namespace xorvox::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Triangles of a block that may cover a column: number, lowest key, size of the box.
struct Candidates {
    static constexpr std::size_t kCapacity = kBlockTriangles + HWY_MAX_BYTES / sizeof(std::uint32_t);
    std::uint32_t triangle[kCapacity];
    std::uint32_t low[kCapacity];
    std::uint32_t size[kCapacity];
    std::size_t count = 0;
};

inline void find_candidates(const Vertices& vertices, const Triangles& triangles, std::size_t first,
                            Candidates& candidates) {
    // Three loads are faster here than lanes of gathers, and nothing is to be foreseen: each is written, few are kept.
    std::uint32_t a[Candidates::kCapacity];
    std::uint32_t b[Candidates::kCapacity];
    std::uint32_t c[Candidates::kCapacity];
    std::size_t n = 0;
    const std::uint32_t* index = triangles.indices + 3 * first;
    for (std::size_t t = first; t < triangles.count; ++t, index += 3) {
        const std::uint32_t key_a = vertices.keys[index[0]];
        const std::uint32_t key_b = vertices.keys[index[1]];
        const std::uint32_t key_c = vertices.keys[index[2]];
        const std::uint32_t differ = (key_a ^ key_b) | (key_a ^ key_c);
        candidates.triangle[n] = static_cast<std::uint32_t>(t);
        a[n] = key_a;
        b[n] = key_b;
        c[n] = key_c;
        n += static_cast<std::size_t>((differ & 0xffff) != 0) & static_cast<std::size_t>(differ >> 16 != 0);
    }
    candidates.count = n;

    const hn::ScalableTag<std::uint16_t> d;
    const auto halves = [&](const std::uint32_t* keys, std::size_t i)
                            HWY_ATTR { return hn::LoadU(d, reinterpret_cast<const std::uint16_t*>(keys + i)); };
    for (std::size_t i = 0; i < n; i += hn::Lanes(d) / 2) {
        const auto low = hn::Min(hn::Min(halves(a, i), halves(b, i)), halves(c, i));
        const auto high = hn::Max(hn::Max(halves(a, i), halves(b, i)), halves(c, i));
        hn::StoreU(low, d, reinterpret_cast<std::uint16_t*>(candidates.low + i));
        hn::StoreU(hn::Sub(high, low), d, reinterpret_cast<std::uint16_t*>(candidates.size + i));
    }
}

inline bool cross_regular(const RegularPlan& plan, const Vertices& vertices, const Triangles& triangles,
                          BlockProgress& progress, Waiting& waiting, Events& events) {
    SmallTriangles& small = waiting.small;
    const hn::CappedTag<std::int32_t, 4> d4;
    const double pitch = static_cast<double>(std::int64_t{1} << plan.columns.shift());
    const auto most =
        static_cast<std::uint32_t>(std::min(kExactDepthReach / pitch, static_cast<double>(SmallTriangles::kMaxSide)));
    Candidates candidates;
    find_candidates(vertices, triangles, progress.triangle, candidates);
    RowCrossing rows(plan);
    const std::size_t resumed = progress.triangle;
    for (std::size_t i = 0; i < candidates.count; ++i) {
        const std::uint32_t* const index = triangles.indices + 3 * candidates.triangle[i];
        const KeyBox box(candidates.low[i], candidates.size[i]);
        progress.triangle = candidates.triangle[i];
        if (progress.triangle != resumed) progress.part = 0;
        if (plan.is_part_of_columns &&
            plan.misses({vertices.points[index[0]], vertices.points[index[1]], vertices.points[index[2]]})) {
            continue;
        }
        if (box.width() <= most && box.height() <= most) {
            const std::uint32_t wide = SmallTriangles::side_class(box.width());
            const std::uint32_t high = SmallTriangles::side_class(box.height());
            const std::uint32_t width = SmallTriangles::class_side(wide);
            const std::uint32_t height = SmallTriangles::class_side(high);
            if (width <= plan.columns.nx() && height <= plan.columns.ny()) {
                SmallTriangles::Batch& batch = small.batches[high * SmallTriangles::kSides + wide];
                if (batch.count == SmallTriangles::kBatch) {
                    if (!events.has_room(std::size_t{SmallTriangles::kBatch} * width * height)) return false;
                    cross_batch(plan, batch, width, height, events);
                }
                const std::uint32_t place = batch.count++;
                for (int corner = 0; corner < 3; ++corner) {
                    const auto point = hn::LoadU(d4, &vertices.points[index[corner]].x);
                    hn::StoreU(point, d4, batch.points[corner] + 4 * place);
                }
                // Columns that were added by rounding up are crossed by nothing, but they must be in the region.
                const std::uint32_t low_x = std::min(box.x(), plan.columns.nx() - width);
                const std::uint32_t low_y = std::min(box.y(), plan.columns.ny() - height);
                batch.low[place] = low_y << 16 | low_x;
                continue;
            }
        }
        const Triangle triangle{vertices.points[index[0]], vertices.points[index[1]], vertices.points[index[2]]};
        if (!rows.set(triangle, box)) continue;
        const std::size_t rows_at_once = std::max<std::size_t>(1, Events::kMaxPushed / box.width());
        while (progress.part < box.height()) {
            const std::size_t some = std::min(rows_at_once, box.height() - progress.part);
            if (!events.has_room(some * box.width())) return false;
            const std::uint32_t y = box.y() + static_cast<std::uint32_t>(progress.part);
            rows.cross(y, y + static_cast<std::uint32_t>(some), events);
            progress.part += some;
        }
    }
    progress = {triangles.count, 0};
    return true;
}

}  // namespace xorvox::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
