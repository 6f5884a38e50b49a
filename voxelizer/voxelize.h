// voxelize(): solid voxelization for programs with a heap, with failures in words.
#pragma once

#include "voxelizer/bit_volume.h"
#include "voxelizer/error.h"
#include "voxelizer/lattice.h"
#include "voxelizer/mesh.h"
#include "voxelizer/solid.h"

namespace xorvox {

/// The samples of `lattice` that are inside `mesh`: voxelize_solid() with memory of its own, in which volume and
/// scratch must fit (asked for before any work is done). The message of a failure names the vertex, the place in the
/// mesh's tables or the sizes that are wrong, and what to do. `report` may be null. Hosted; calls may run at the same
/// time.
Expected<BitVolume> voxelize(const MeshView& mesh, const Lattice& lattice, SolidReport* report = nullptr);

}  // namespace xorvox
