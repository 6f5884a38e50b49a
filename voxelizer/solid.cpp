#include "voxelizer/solid.h"

#include <algorithm>
#include <limits>

#include <glm/vec3.hpp>

#include "voxelizer/column_flips.h"
#include "voxelizer/plan_index.h"
#include "voxelizer/regular_columns.h"
#include "voxelizer/scratch.h"
#include "voxelizer/snap.h"

namespace xorvox {
namespace {

using SnappedVertices = std::span<const glm::ivec3>;

/// Stands for a vertex that cannot be snapped: files may have such vertices where no face uses them.
constexpr glm::ivec3 kBeyondGrid{std::numeric_limits<std::int32_t>::min()};

bool fits(const BitVolumeView& volume, const Lattice& lattice) {
    if (volume.nx != lattice.nx || volume.ny != lattice.ny || volume.nz != lattice.nz) return false;
    // In 64 bits, because on a microcontroller the product may exceed SIZE_MAX.
    return volume.words.size() == std::uint64_t{row_words(lattice.nx)} * lattice.ny * lattice.nz;
}

/// Snaps all vertices; false when a face uses one that is beyond the grid, the first of which is then `bad_vertex`.
bool snap_vertices(const MeshView& mesh, const SnapGrid& grid, std::span<glm::ivec3> snapped, std::size_t& bad_vertex) {
    bool all_snapped = true;
    for (std::size_t i = 0; i < snapped.size(); ++i) {
        snapped[i] = kBeyondGrid;
        all_snapped &= snap(grid, mesh.positions[i], snapped[i]);
    }
    if (all_snapped) return true;
    std::size_t first = snapped.size();
    for (const std::uint32_t index : mesh.used_indices()) {
        if (snapped[index] == kBeyondGrid) first = std::min<std::size_t>(first, index);
    }
    if (first == snapped.size()) return true;
    bad_vertex = first;
    return false;
}

bool lexicographically_less(const glm::ivec3& a, const glm::ivec3& b) {
    if (a.x != b.x) return a.x < b.x;
    if (a.y != b.y) return a.y < b.y;
    return a.z < b.z;
}

/// Calls visit(apex, a, b) for every edge (a, b) of the face: the mod-2 fan.
template <class Visit>
void fan(const MeshView& mesh, std::size_t face, SnappedVertices vertices, const Visit& visit) {
    const std::size_t first = mesh.face_begin(face);
    const std::size_t last = mesh.face_end(face);
    if (last - first == 1 && mesh.ring(first).size() == 3) {
        const auto ring = mesh.ring(first);
        visit(vertices[ring[0]], vertices[ring[1]], vertices[ring[2]]);
        return;
    }
    const glm::ivec3* apex = nullptr;
    for (std::size_t r = first; r < last; ++r) {
        for (const std::uint32_t index : mesh.ring(r)) {
            if (apex == nullptr || lexicographically_less(vertices[index], *apex)) apex = &vertices[index];
        }
    }
    for (std::size_t r = first; r < last; ++r) {
        const auto ring = mesh.ring(r);
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const std::size_t next = i + 1 == ring.size() ? 0 : i + 1;
            visit(*apex, vertices[ring[i]], vertices[ring[next]]);
        }
    }
}

template <class Columns>
void cross_faces(const MeshView& mesh, SnappedVertices vertices, const Columns& columns, ColumnFlips& flips) {
    for (std::size_t face = 0; face < mesh.face_count(); ++face) {
        fan(mesh, face, vertices,
            [&](const glm::ivec3& a, const glm::ivec3& b, const glm::ivec3& c) { columns.cross(a, b, c, flips); });
    }
}

}  // namespace

std::size_t solid_scratch_bytes(const MeshView& mesh, const Lattice& lattice) {
    return Scratch::bytes<glm::ivec3>(mesh.positions.size()) + PlanIndex::scratch_bytes(lattice);
}

Status voxelize_solid(const MeshView& mesh, const Lattice& lattice, std::span<std::byte> scratch, BitVolumeView out,
                      SolidReport* report) {
    SolidReport ignored;
    SolidReport& found = report == nullptr ? ignored : *report;
    found = {};
    if (const Status status = validate(lattice); status != Status::Ok) return status;
    if (!fits(out, lattice) || !is_aligned(scratch)) return Status::InvalidArgument;
    if (const Status status = validate(mesh, &found.bad_index); status != Status::Ok) return status;
    if (scratch.size() < solid_scratch_bytes(mesh, lattice)) return Status::OutOfMemory;

    Scratch memory(scratch);
    const SnapGrid grid = snap_grid(lattice);
    const std::span<glm::ivec3> vertices = memory.take<glm::ivec3>(mesh.positions.size());
    if (!snap_vertices(mesh, grid, vertices, found.bad_vertex)) return Status::OutOfRange;

    ColumnFlips flips(out);
    if (lattice.is_regular()) {
        cross_faces(mesh, vertices, RegularColumns(lattice, grid), flips);
    } else {
        cross_faces(mesh, vertices, PlanIndex(lattice, grid, memory), flips);
    }
    flips.accumulate();
    found.crossings = flips.count();
    return Status::Ok;
}

}  // namespace xorvox
