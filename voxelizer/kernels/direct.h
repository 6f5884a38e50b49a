// What all kernels do alike, and what they leave to exact scalar arithmetic: integers of 64 bits, and of 128 where a
// triangle is too large for them (voxelizer/facet.h).
#pragma once

#include <algorithm>
#include <cstdint>

#include "voxelizer/facet.h"
#include "voxelizer/kernels/events.h"
#include "voxelizer/kernels/kernel_table.h"
#include "voxelizer/kernels/plan.h"

namespace xorvox::kernels {

/// The box of a triangle's three keys: half-open columns and rows on regular plans.
class KeyBox {
public:
    KeyBox(std::uint32_t a, std::uint32_t b, std::uint32_t c)
        : x_(std::min({a & kHalf, b & kHalf, c & kHalf})),
          y_(std::min({a >> 16, b >> 16, c >> 16})),
          width_(std::max({a & kHalf, b & kHalf, c & kHalf}) - x_),
          height_(std::max({a >> 16, b >> 16, c >> 16}) - y_) {}
    /// From packed lowest key and size.
    KeyBox(std::uint32_t low, std::uint32_t size)
        : x_(low & kHalf), y_(low >> 16), width_(size & kHalf), height_(size >> 16) {}

    std::uint32_t x() const { return x_; }
    std::uint32_t y() const { return y_; }
    std::uint32_t width() const { return width_; }
    std::uint32_t height() const { return height_; }
    bool is_empty() const { return width_ == 0 || height_ == 0; }

private:
    static constexpr std::uint32_t kHalf = 0xffff;
    std::uint32_t x_, y_, width_, height_;
};

/// Pushes the crossings of a triangle in rows begin … end - 1 of the region, exactly.
inline void cross_rows_exactly(const RegularPlan& plan, const Triangle& t, std::uint32_t begin, std::uint32_t end,
                               Events& events) {
    plan.columns.cross(t.a, t.b, t.c, {begin, end}, [&](std::uint32_t x, std::uint32_t y, std::int64_t k) {
        if (k >= plan.columns.nz() || (k < 0 && plan.below == Below::Dropped)) return;
        events.push(static_cast<std::uint32_t>(std::max<std::int64_t>(k, 0)), y * plan.row_bits + x);
    });
}

/// Pushes the crossing of the column at `place` by a face whose first point above is `rise` above its lowest sample.
inline void push_at_rise(const TablePlan& plan, std::uint32_t place, std::int64_t rise, Events& events) {
    if (plan.is_counted_below(rise)) return;
    const std::uint32_t k = plan.first_sample_from(rise);
    if (k < plan.nz()) events.push(k, plan.bits()[place]);
}

/// The same for a face that may or may not cross the column.
inline void push_if_crossed(const TablePlan& plan, const Facet& facet, std::uint32_t place, Events& events) {
    const std::int32_t x = plan.x()[place];
    const std::int32_t y = plan.y()[place];
    if (!facet.contains(x, y)) return;
    push_at_rise(plan, place, facet.first_above(x, y) - plan.z()[place], events);
}

/// Crosses a block of triangles with the columns of the bins that they touch. `crossing.set(triangle)` prepares one, or
/// says that no column crosses it; crossing.cross(begin, end) then looks at that run of places, at most
/// Events::kMaxPushed, for whose events there is room. False when there is no more.
template <class Crossing>
bool cross_bins(const TablePlan& plan, const Vertices& vertices, const Triangles& triangles, BlockProgress& progress,
                const Events& events, Crossing& crossing) {
    for (; progress.triangle < triangles.count; ++progress.triangle, progress.part = 0) {
        const std::uint32_t* const index = triangles.indices + 3 * progress.triangle;
        const KeyBox box(vertices.keys[index[0]], vertices.keys[index[1]], vertices.keys[index[2]]);
        // Keys 0 and bins + 1 are the border.
        const std::uint32_t first_x = std::max(box.x(), 1u);
        const std::uint32_t last_x = std::min(box.x() + box.width(), plan.bins_x());
        const std::uint32_t first_y = std::max(box.y(), 1u);
        const std::uint32_t last_y = std::min(box.y() + box.height(), plan.bins_y());
        if (first_x > last_x || first_y > last_y) continue;
        bool is_set = false;
        std::size_t part = 0;
        for (std::uint32_t y = first_y; y <= last_y; ++y) {
            const std::uint32_t* const starts = plan.starts() + std::size_t{y - 1} * plan.bins_x();
            const std::uint32_t end = starts[last_x];
            for (std::uint32_t begin = starts[first_x - 1]; begin < end; ++part) {
                const std::uint32_t stop = std::min<std::uint32_t>(end, begin + Events::kMaxPushed);
                const std::uint32_t run = begin;
                begin = stop;
                if (part < progress.part) continue;
                if (!is_set &&
                    !crossing.set({vertices.points[index[0]], vertices.points[index[1]], vertices.points[index[2]]})) {
                    y = last_y;
                    break;
                }
                is_set = true;
                if (!events.has_room(stop - run)) return false;
                crossing.cross(run, stop);
                progress.part = part + 1;
            }
        }
    }
    return true;
}

}  // namespace xorvox::kernels
