// Fitting a lattice around a mesh. Hosted: the answers carry messages.
#pragma once

#include <cstdint>

#include "voxelizer/error.h"
#include "voxelizer/lattice.h"
#include "voxelizer/mesh.h"

namespace xorvox {

/// The bounding box of the vertices that faces use; the mesh must pass validate(). Fails when it has no faces, and when
/// such a vertex is not finite, which the message names.
Expected<Box> bounds(const MeshView& mesh);

/// The regular lattice of n samples a side over the cube centred on `box` with sides (longest side of the box) · (1 +
/// 2/64), whatever n is: at 64 samples one voxel stays free on either side. n is 1 to kMaxLatticeSide. Fails for
/// another n, and for a box of zero size, which has no scale to choose a pitch by, or of a size beyond double.
Expected<Lattice> fit_cube(const Box& box, std::uint32_t n);

}  // namespace xorvox
