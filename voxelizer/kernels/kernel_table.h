// KernelTable: the operations that are compiled once for each instruction set. scalar.cpp is the reference; simd.cpp
// gives the others. All of them give the same bits, and the same events up to their order.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <glm/vec3.hpp>

#include "voxelizer/kernels/events.h"
#include "voxelizer/kernels/kernel.h"
#include "voxelizer/kernels/plan.h"
#include "voxelizer/snap.h"

namespace xorvox::kernels {

/// Vertices on the snapping grid. keys[i] packs what a vertex is to the columns, as (y << 16 | x): on regular plans the
/// first column and row at or beyond it, so that triangles whose keys agree in a half cover no column; on tables one
/// more than its cell, between 0 and the number of cells plus one. Behind the last point there are kPointSlack bytes
/// that may be read.
struct Vertices {
    const glm::ivec3* points = nullptr;
    const std::uint32_t* keys = nullptr;
};
inline constexpr std::size_t kPointSlack = 4;

/// Triangles as vertex numbers, three each. Every number is that of a vertex.
struct Triangles {
    const std::uint32_t* indices = nullptr;
    std::size_t count = 0;
};

/// The most triangles that are looked at in one call of a cross operation.
inline constexpr std::size_t kBlockTriangles = 512;

/// Where a block of triangles was left for want of room for events.
struct BlockProgress {
    std::size_t triangle = 0;  ///< The first that is not done.
    std::size_t part = 0;      ///< Rows or runs of it that are done.
};

/// Small triangles that wait for others with as many columns and rows, so that each has a lane.
struct SmallTriangles {
    static constexpr std::uint32_t kMaxSide = 16;
    static constexpr std::uint32_t kBatch = 16;
    static_assert(kBatch * kMaxSide * kMaxSide <= Events::kMaxPushed);

    struct Batch {
        std::int32_t points[3][4 * kBatch];  ///< x, y, z and something of each vertex.
        std::uint32_t low[kBatch];           ///< The lowest column and row: y << 16 | x.
        std::uint32_t count = 0;
    };
    /// Sides up to 8 are as they are, those above are rounded up to even ones: 12 in all.
    static constexpr std::uint32_t kSides = 12;
    static constexpr std::uint32_t side_class(std::uint32_t side) { return side <= 8 ? side - 1 : (side + 7) / 2; }
    static constexpr std::uint32_t class_side(std::uint32_t number) { return number < 8 ? number + 1 : 2 * number - 6; }

    std::array<Batch, kSides * kSides> batches;  ///< Of width class w and height class h at h · kSides + w.
};
static_assert(SmallTriangles::class_side(SmallTriangles::side_class(8)) == 8 &&
              SmallTriangles::class_side(SmallTriangles::side_class(9)) == 10 &&
              SmallTriangles::class_side(SmallTriangles::side_class(16)) == 16 &&
              SmallTriangles::side_class(SmallTriangles::kMaxSide) + 1 == SmallTriangles::kSides);

/// Columns of a table that wait for others, so that each has a lane, with a triangle that may cross it.
struct ColumnPairs {
    static constexpr std::uint32_t kBatch = 256;

    std::int32_t points[3][4 * kBatch];  ///< x, y, z and something of each vertex.
    TableColumn columns[kBatch];
    std::uint32_t count = 0;
};

/// What a thread leaves for later.
struct Waiting {
    SmallTriangles small;
    ColumnPairs pairs;
};

struct KernelTable {
    Kernel kernel;

    /// Snaps `count` points; false when one of them is beyond the grid, and `snapped` is then unspecified.
    bool (*snap)(const SnapGrid& grid, const glm::dvec3* points, std::size_t count, glm::ivec3* snapped);
    /// The keys of vertices on a regular plan, and on a table.
    void (*pack_regular)(const RegularPlan& plan, const glm::ivec3* points, std::size_t count, std::uint32_t* keys);
    void (*pack_table)(const TablePlan& plan, const glm::ivec3* points, std::size_t count, std::uint32_t* keys);

    /// Pushes the crossings of triangles from `progress` on, but for those that wait; true when the block is done,
    /// false when there is no room for more.
    bool (*cross_regular)(const RegularPlan& plan, const Vertices& vertices, const Triangles& triangles,
                          BlockProgress& progress, Waiting& waiting, Events& events);
    bool (*cross_table)(const TablePlan& plan, const Vertices& vertices, const Triangles& triangles,
                        BlockProgress& progress, Waiting& waiting, Events& events);
    /// Pushes the crossings of those that wait; false when there is no room for more.
    bool (*cross_waiting_regular)(const RegularPlan& plan, Waiting& waiting, Events& events);
    bool (*cross_waiting_table)(const TablePlan& plan, Waiting& waiting, Events& events);

    /// Copies a layer to the volume; past the cache with `stream`.
    void (*copy_layer)(const std::uint64_t* parities, std::uint64_t* out, std::size_t words, bool stream);
};

/// The table of a kernel that is among available_kernels().
const KernelTable& kernel_table(Kernel kernel);

extern const KernelTable kScalarTable;

}  // namespace xorvox::kernels
