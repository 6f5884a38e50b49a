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

/// Pushes the crossing of a column, told by its bit, by a face whose first point above is `rise` above its lowest
/// sample.
inline void push_at_rise(const TablePlan& plan, std::uint32_t bit, std::int64_t rise, Events& events) {
    rise -= plan.lowest_rise();
    if (plan.is_counted_below(rise)) return;
    const std::uint32_t k = plan.first_sample_from(rise);
    if (k < plan.nz()) events.push(k, bit);
}

/// Pushes the crossing of a column by a face that may or may not cross it.
inline void push_if_crossed(const TablePlan& plan, const Facet& facet, const TableColumn& column, Events& events) {
    if (!facet.contains(column.x, column.y)) return;
    push_at_rise(plan, column.bit, facet.first_above(column.x, column.y) - column.z, events);
}

/// Calls visit(part, begin, end) for the runs of places in the bins that a triangle touches, at most Events::kMaxPushed
/// each, from `first_part` on, until it answers false; whether it never did. `box` is that of the triangle's keys.
template <class Visit>
bool visit_runs(const TablePlan& plan, const KeyBox& box, std::size_t first_part, const Visit& visit) {
    // Keys 0 and cells + 1 are the border.
    const std::uint32_t first_x = std::max(box.x(), 1u);
    const std::uint32_t last_x = std::min(box.x() + box.width(), plan.cells_x());
    const std::uint32_t first_y = std::max(box.y(), 1u);
    const std::uint32_t last_y = std::min(box.y() + box.height(), plan.cells_y());
    if (first_x > last_x || first_y > last_y) return true;
    const std::uint32_t log2 = plan.bin_cells_log2();
    const std::uint32_t* row = plan.starts() + std::size_t{(first_y - 1) >> log2} * plan.bins_x();
    std::size_t part = 0;
    for (std::uint32_t y = (first_y - 1) >> log2; y <= (last_y - 1) >> log2; ++y, row += plan.bins_x()) {
        const std::uint32_t end = row[((last_x - 1) >> log2) + 1];
        for (std::uint32_t begin = row[(first_x - 1) >> log2]; begin < end; begin += Events::kMaxPushed, ++part) {
            const std::uint32_t stop = std::min<std::uint32_t>(end, begin + Events::kMaxPushed);
            if (part >= first_part && !visit(part, begin, stop)) return false;
        }
    }
    return true;
}

}  // namespace xorvox::kernels
