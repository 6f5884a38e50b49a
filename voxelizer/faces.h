// What the solid methods share: the vertices of a mesh on the snapping grid, and its faces as triangles on them.
//
// Freestanding; internal to the voxelizer.
#pragma once

#include <cstddef>
#include <span>

#include <glm/vec3.hpp>

#include "voxelizer/bit_volume.h"
#include "voxelizer/lattice.h"
#include "voxelizer/mesh.h"
#include "voxelizer/snap.h"

namespace xorvox {

using SnappedVertices = std::span<const glm::ivec3>;

/// Whether `volume` has the shape of the lattice, and the words that go with it.
bool fits(const BitVolumeView& volume, const Lattice& lattice);

/// Snaps all vertices; false when a face uses one that is beyond the grid, the first of which is then `bad_vertex`.
/// Other vertices beyond the grid, which no face uses, are of no consequence.
bool snap_vertices(const MeshView& mesh, const SnapGrid& grid, std::span<glm::ivec3> snapped, std::size_t& bad_vertex);

/// The lexicographically smallest vertex of the face, or null when it has none.
const glm::ivec3* smallest_vertex(const MeshView& mesh, std::size_t face, SnappedVertices vertices);

/// Calls visit(a, b, c) for every triangle of the face's mod-2 fan: from its smallest vertex to each edge of its rings,
/// so that a polygon gives the same surface whatever its first vertex. A triangle is visited as it is.
template <class Visit>
void fan(const MeshView& mesh, std::size_t face, SnappedVertices vertices, const Visit& visit) {
    const std::size_t first = mesh.face_begin(face);
    const std::size_t last = mesh.face_end(face);
    if (last - first == 1 && mesh.ring(first).size() == 3) {
        const auto ring = mesh.ring(first);
        visit(vertices[ring[0]], vertices[ring[1]], vertices[ring[2]]);
        return;
    }
    const glm::ivec3* const apex = smallest_vertex(mesh, face, vertices);
    for (std::size_t r = first; r < last; ++r) {
        const auto ring = mesh.ring(r);
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const std::size_t next = i + 1 == ring.size() ? 0 : i + 1;
            visit(*apex, vertices[ring[i]], vertices[ring[next]]);
        }
    }
}

}  // namespace xorvox
