#include "voxelizer/solid.h"

#include <glm/vec3.hpp>

#include "voxelizer/column_flips.h"
#include "voxelizer/faces.h"
#include "voxelizer/plan_index.h"
#include "voxelizer/regular_columns.h"
#include "voxelizer/scratch.h"
#include "voxelizer/snap.h"

namespace xorvox {
namespace {

template <class Cross>
void cross_faces(const MeshView& mesh, SnappedVertices vertices, const Cross& cross) {
    for (std::size_t face = 0; face < mesh.face_count(); ++face) fan(mesh, face, vertices, cross);
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
        const RegularColumns columns(whole(lattice), grid);
        const auto flip = [&](std::uint32_t x, std::uint32_t y, std::int64_t k) {
            if (k < lattice.nz) flips.flip(column_bit(lattice.nx, x, y), static_cast<std::uint32_t>(k < 0 ? 0 : k));
        };
        cross_faces(mesh, vertices, [&](const glm::ivec3& a, const glm::ivec3& b, const glm::ivec3& c) {
            columns.cross(a, b, c, {0, lattice.ny}, flip);
        });
    } else {
        const PlanIndex columns(lattice, grid, memory);
        cross_faces(mesh, vertices, [&](const glm::ivec3& a, const glm::ivec3& b, const glm::ivec3& c) {
            columns.cross(a, b, c, flips);
        });
    }
    flips.accumulate();
    found.crossings = flips.count();
    return Status::Ok;
}

}  // namespace xorvox
