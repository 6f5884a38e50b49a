// The reference kernel: one triangle, one row, one sample at a time, in integers.
#include <algorithm>

#include "voxelizer/facet.h"
#include "voxelizer/kernels/direct.h"
#include "voxelizer/kernels/kernel_table.h"

namespace xorvox::kernels {
namespace {

bool snap_points(const SnapGrid& grid, const glm::dvec3* points, std::size_t count, glm::ivec3* snapped) {
    bool all = true;
    for (std::size_t i = 0; i < count; ++i) all &= snap(grid, points[i], snapped[i]);
    return all;
}

void pack_regular(const RegularPlan& plan, const glm::ivec3* points, std::size_t count, std::uint32_t* keys) {
    for (std::size_t i = 0; i < count; ++i) {
        const auto x = static_cast<std::uint32_t>(plan.columns.xs_between(points[i].x, points[i].x).begin);
        const auto y = static_cast<std::uint32_t>(plan.columns.ys_between(points[i].y, points[i].y).begin);
        keys[i] = y << 16 | x;
    }
}

void pack_table(const TablePlan& plan, const glm::ivec3* points, std::size_t count, std::uint32_t* keys) {
    const auto bin = [&plan](std::int32_t coordinate, std::uint32_t bins) {
        return static_cast<std::uint32_t>(
            std::clamp<std::int64_t>((coordinate >> plan.bin_shift()) + std::int64_t{1}, 0, std::int64_t{bins} + 1));
    };
    for (std::size_t i = 0; i < count; ++i) {
        keys[i] = bin(points[i].y, plan.bins_y()) << 16 | bin(points[i].x, plan.bins_x());
    }
}

bool cross_regular(const RegularPlan& plan, const Vertices& vertices, const Triangles& triangles,
                   BlockProgress& progress, SmallTriangles&, Events& events) {
    for (; progress.triangle < triangles.count; ++progress.triangle, progress.part = 0) {
        const std::uint32_t* const index = triangles.indices + 3 * progress.triangle;
        const KeyBox box(vertices.keys[index[0]], vertices.keys[index[1]], vertices.keys[index[2]]);
        const Triangle triangle{vertices.points[index[0]], vertices.points[index[1]], vertices.points[index[2]]};
        if (box.is_empty() || plan.misses(triangle)) continue;
        const std::size_t rows_at_once = std::max<std::size_t>(1, Events::kMaxPushed / box.width());
        while (progress.part < box.height()) {
            const std::size_t some = std::min(rows_at_once, box.height() - progress.part);
            if (!events.has_room(some * box.width())) return false;
            const std::uint32_t y = box.y() + static_cast<std::uint32_t>(progress.part);
            cross_rows_exactly(plan, triangle, y, y + static_cast<std::uint32_t>(some), events);
            progress.part += some;
        }
    }
    return true;
}

bool cross_small(const RegularPlan&, SmallTriangles&, Events&) {
    return true;
}

class TableCrossing {
public:
    TableCrossing(const TablePlan& plan, Events& events) : plan_(plan), events_(events) {}
    bool set(const Triangle& t) { return !plan_.misses(t) && facet_.set(t.a, t.b, t.c); }
    void cross(std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t place = begin; place < end; ++place) push_if_crossed(plan_, facet_, place, events_);
    }

private:
    const TablePlan& plan_;
    Events& events_;
    Facet facet_;
};

bool cross_table(const TablePlan& plan, const Vertices& vertices, const Triangles& triangles, BlockProgress& progress,
                 Events& events) {
    TableCrossing crossing(plan, events);
    return cross_bins(plan, vertices, triangles, progress, events, crossing);
}

void copy_layer(const std::uint64_t* parities, std::uint64_t* out, std::size_t words, bool) {
    std::copy_n(parities, words, out);
}

}  // namespace

const KernelTable kScalarTable{Kernel::Scalar, snap_points, pack_regular, pack_table,
                               cross_regular,  cross_small, cross_table,  copy_layer};

}  // namespace xorvox::kernels
