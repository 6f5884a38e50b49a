// A slow voxelizer that shares no code with the fast one: every sample against every triangle.
//
// It snaps by its own arithmetic, moves each sample to (x + ε, y + ε², z + ε³) by calculating with polynomials in ε,
// and counts the triangles that a ray from the sample meets. Coordinates of 2^30 give determinants below 2^94.
#pragma once

#include <string>

#include "voxelizer/bit_volume.h"
#include "voxelizer/lattice.h"
#include "voxelizer/mesh.h"

namespace xorvox::test {

/// The axis along which the ray goes down. For meshes that are closed mod 2 all three must agree.
enum class Ray { X = 0, Y = 1, Z = 2 };

BitVolume oracle(const MeshView& mesh, const Lattice& lattice, Ray ray = Ray::Z);

/// What distinguishes two volumes, in words; empty when they are equal, padding included.
std::string difference(const BitVolume& got, const BitVolume& expected);

/// The bits of voxelize_solid(), which must accept the input; throws std::runtime_error otherwise.
BitVolume reference(const MeshView& mesh, const Lattice& lattice);

/// The same, and the bits of SolidVoxelizer with every kernel of this machine are equal; throws std::runtime_error that
/// says which is not.
BitVolume voxelized(const MeshView& mesh, const Lattice& lattice);

}  // namespace xorvox::test
