// Weld: vertices at one position become one vertex.
#pragma once

#include <cstdint>
#include <vector>

#include "voxelizer/mesh.h"

namespace xorvox::io {

/// Merges the vertices of `mesh` whose positions are equal and drops those that no face uses. Equal means equal
/// doubles, with -0 equal to 0 (the result has 0); no tolerance. The first of equal vertices stays, and vertices keep
/// their order. Faces keep their order and corners, even when they collapse. Every index of `mesh` must be below its
/// number of vertices, which must be below 2^32 - 1. Linear in time. Allocates; throws std::bad_alloc.
void weld(Mesh& mesh);

/// The same, but merges only vertices of one part. `parts` has one entry a vertex, before and after.
void weld(Mesh& mesh, std::vector<std::uint32_t>& parts);

}  // namespace xorvox::io
