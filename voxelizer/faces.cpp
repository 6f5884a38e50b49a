#include "voxelizer/faces.h"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace xorvox {
namespace {

/// Stands for a vertex that cannot be snapped: files may have such vertices where no face uses them.
constexpr glm::ivec3 kBeyondGrid{std::numeric_limits<std::int32_t>::min()};

bool lexicographically_less(const glm::ivec3& a, const glm::ivec3& b) {
    if (a.x != b.x) return a.x < b.x;
    if (a.y != b.y) return a.y < b.y;
    return a.z < b.z;
}

}  // namespace

bool fits(const BitVolumeView& volume, const Lattice& lattice) {
    if (volume.nx != lattice.nx || volume.ny != lattice.ny || volume.nz != lattice.nz) return false;
    // In 64 bits, because on a microcontroller the product may exceed SIZE_MAX.
    return volume.words.size() == std::uint64_t{row_words(lattice.nx)} * lattice.ny * lattice.nz;
}

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

const glm::ivec3* smallest_vertex(const MeshView& mesh, std::size_t face, SnappedVertices vertices) {
    const glm::ivec3* smallest = nullptr;
    for (std::size_t r = mesh.face_begin(face); r < mesh.face_end(face); ++r) {
        for (const std::uint32_t index : mesh.ring(r)) {
            if (smallest == nullptr || lexicographically_less(vertices[index], *smallest)) smallest = &vertices[index];
        }
    }
    return smallest;
}

}  // namespace xorvox
