// MeshReport: what is right and wrong with a mesh, in numbers.
//
// Everything is counted by vertex numbers, so weld first (voxelizer/io/weld.h; read_mesh() does). Terms:
//
//   side        a step along a ring, from a corner to the next one, the last back to the first. Sides from a vertex to
//               itself are left out.
//   edge        a pair of different vertices that at least one side joins, whichever way it runs. Rings of fewer than
//               three different corners are left out: they go over their edge as often back as there, which for parity
//               is nothing.
//   open edge   an edge with an odd number of sides. Without open edges the mesh is closed mod 2, which is all that
//               parity needs: every line then crosses the surface an even number of times.
#pragma once

#include <cstddef>
#include <cstdint>

#include <glm/vec3.hpp>

#include "voxelizer/mesh.h"

namespace xorvox::io {

enum class Orientation : std::uint8_t {
    Undefined,  ///< Open or inconsistent edges, or a volume of zero.
    Outward,    ///< Closed, consistent, and the volume is positive: rings run counterclockwise seen from outside.
    Inward,     ///< The same with a negative volume.
};

/// "undefined", "outward" or "inward". Static storage.
const char* to_string(Orientation orientation);

struct MeshReport {
    std::size_t vertices = 0;   ///< Positions, used or not.
    std::size_t faces = 0;      ///< Polygons.
    std::size_t triangles = 0;  ///< After cutting each ring of n ≥ 3 corners into a fan of n - 2.
    glm::dvec3 min{0.0};        ///< The box around the vertices that faces use; both corners 0 when there are none.
    glm::dvec3 max{0.0};

    std::size_t open_edges = 0;          ///< See above; an edge with three sides is one, too.
    std::size_t non_manifold_edges = 0;  ///< Edges with more than two sides.
    std::size_t inconsistent_edges =
        0;  ///< Edges that are not open, along which more sides run one way than the other.
    /// Faces of zero area: every triangle of the fan from the first corner of each ring has a normal of exactly zero,
    /// computed in doubles that neither size nor place of the mesh makes overflow.
    std::size_t degenerate_faces = 0;
    /// Faces with the same sides as an earlier face, wherever their rings start and whichever way they run. For parity,
    /// two such faces cancel.
    std::size_t duplicate_faces = 0;
    std::size_t components = 0;  ///< Pieces; faces that share a vertex are of one piece.

    /// Sum of the signed volumes of the tetrahedra from the centre of the box to the triangles of all fans, in cubed
    /// units of the mesh. The volume enclosed if the orientation is outward; depends on the centre if there are open
    /// edges. Finite whenever a double can hold it; else infinite with the right sign (from a side of about 1e102 on),
    /// or 0 when it is too small (below about 1e-107). Never nan.
    double signed_volume = 0;
    bool closed_mod2 = false;  ///< No open edges.
    Orientation orientation = Orientation::Undefined;
};

/// Examines `mesh`, which must pass validate(), be of finite coordinates and have fewer than 2^32 - 1 vertices. Time
/// about linear. Allocates; throws std::bad_alloc.
MeshReport report(const MeshView& mesh);

}  // namespace xorvox::io
