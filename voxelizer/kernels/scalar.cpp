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
    const auto cell = [&plan](std::int32_t coordinate, std::uint32_t cells) {
        return static_cast<std::uint32_t>(
            std::clamp<std::int64_t>((coordinate >> plan.cell_shift()) + std::int64_t{1}, 0, std::int64_t{cells} + 1));
    };
    for (std::size_t i = 0; i < count; ++i) {
        keys[i] = cell(points[i].y, plan.cells_y()) << 16 | cell(points[i].x, plan.cells_x());
    }
}

bool cross_regular(const RegularPlan& plan, const Vertices& vertices, const Triangles& triangles,
                   BlockProgress& progress, Waiting&, Events& events) {
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

template <class Plan>
bool cross_waiting(const Plan&, Waiting&, Events&) {
    return true;  // Nothing waits here.
}

bool cross_table(const TablePlan& plan, const Vertices& vertices, const Triangles& triangles, BlockProgress& progress,
                 Waiting&, Events& events) {
    for (; progress.triangle < triangles.count; ++progress.triangle, progress.part = 0) {
        const std::uint32_t* const index = triangles.indices + 3 * progress.triangle;
        const KeyBox box(vertices.keys[index[0]], vertices.keys[index[1]], vertices.keys[index[2]]);
        const Triangle t{vertices.points[index[0]], vertices.points[index[1]], vertices.points[index[2]]};
        Facet facet;
        if (plan.misses(t) || !facet.set(t.a, t.b, t.c)) continue;
        const bool done =
            visit_runs(plan, box, progress.part, [&](std::size_t part, std::uint32_t begin, std::uint32_t end) {
                progress.part = part;
                if (!events.has_room(end - begin)) return false;
                for (std::uint32_t place = begin; place < end; ++place)
                    push_if_crossed(plan, facet, plan.columns()[place], events);
                return true;
            });
        if (!done) return false;
    }
    return true;
}

void copy_layer(const std::uint64_t* parities, std::uint64_t* out, std::size_t words, bool) {
    std::copy_n(parities, words, out);
}

}  // namespace

const KernelTable kScalarTable{Kernel::Scalar, snap_points,   pack_regular,  pack_table, cross_regular,
                               cross_table,    cross_waiting, cross_waiting, copy_layer};

}  // namespace xorvox::kernels
