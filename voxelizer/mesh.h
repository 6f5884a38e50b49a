// Mesh: polygons as they came from the file; MeshView: the same, borrowed.
//
//   positions     P0 P1 P2 P3 …                 one dvec3 a vertex, in the file's units
//   indices       3 0 1 | 2 1 0 | 4 5 6 7       vertex numbers, ring after ring
//   ring_starts   0       3       6       10    where ring r begins; one more entry than rings
//   face_starts   0       1               3     which ring face f begins with; one more entry than faces
//
// Both tables may be empty: without ring_starts every three indices are a triangle, without face_starts every ring is a
// face. A face with more than one ring is a polygon with holes (or with several parts): for parity all its rings count
// alike, in either direction.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "voxelizer/status.h"

namespace xorvox {

/// A borrowed mesh: the four arrays drawn at the head of this file. Freestanding; the caller keeps the arrays alive and
/// unchanged for as long as the view is used. The views of an unchanged mesh may be read by any number of threads.
struct MeshView {
    std::span<const glm::dvec3> positions;
    std::span<const std::uint32_t> indices;
    std::span<const std::uint32_t> ring_starts;
    std::span<const std::uint32_t> face_starts;

    constexpr std::size_t ring_count() const {
        return ring_starts.empty() ? indices.size() / 3 : ring_starts.size() - 1;
    }
    constexpr std::size_t face_count() const { return face_starts.empty() ? ring_count() : face_starts.size() - 1; }
    /// The vertex numbers of ring `r`; `r` < ring_count().
    constexpr std::span<const std::uint32_t> ring(std::size_t r) const {
        if (ring_starts.empty()) return indices.subspan(3 * r, 3);
        return indices.subspan(ring_starts[r], ring_starts[r + 1] - ring_starts[r]);
    }
    /// The first ring of face `f`, and one past its last; `f` < face_count().
    constexpr std::size_t face_begin(std::size_t f) const { return face_starts.empty() ? f : face_starts[f]; }
    constexpr std::size_t face_end(std::size_t f) const { return face_starts.empty() ? f + 1 : face_starts[f + 1]; }
    /// The vertex numbers of all faces, one after the other; the mesh must pass validate().
    constexpr std::span<const std::uint32_t> used_indices() const {
        if (face_count() == 0) return {};
        const std::size_t first = face_begin(0);
        const std::size_t last = face_end(face_count() - 1);
        if (ring_starts.empty()) return indices.subspan(3 * first, 3 * (last - first));
        return indices.subspan(ring_starts[first], ring_starts[last] - ring_starts[first]);
    }
};

/// Whether `mesh` is well formed: both tables never decreasing and inside of what they point into, whole triangles
/// where there is no ring table, and every vertex number of a face below positions.size(). Coordinates are not looked
/// at. A part of face_starts (or of ring_starts) is a view of some of the faces, and well formed too.
///
/// Ok or InvalidArgument; `*bad_index`, unless null, is then the place in `indices` of the first vertex number that is
/// too large, or indices.size() when a table is at fault.
Status validate(const MeshView& mesh, std::size_t* bad_index = nullptr);

/// A mesh that owns its arrays. Hosted only.
struct Mesh {
    std::vector<glm::dvec3> positions;
    std::vector<std::uint32_t> indices;
    std::vector<std::uint32_t> ring_starts;
    std::vector<std::uint32_t> face_starts;

    MeshView view() const { return {positions, indices, ring_starts, face_starts}; }
};

}  // namespace xorvox
