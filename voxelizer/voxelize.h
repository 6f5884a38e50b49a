// voxelize(): solid voxelization for programs with a heap, with failures in words.
#pragma once

#include "voxelizer/bit_volume.h"
#include "voxelizer/error.h"
#include "voxelizer/lattice.h"
#include "voxelizer/mesh.h"
#include "voxelizer/solid_voxelizer.h"

namespace xorvox {

/// The samples of `lattice` that are inside `mesh`: a SolidVoxelizer of one call, in one thread and with the best
/// kernel or as `options` say. Volume and working memory must fit into the machine, which is looked at before any work
/// is done. The message of a failure is that of describe_failure(), or says what memory or which threads could not be
/// had. `report` may be null. Hosted; calls may run at the same time.
Expected<BitVolume> voxelize(const MeshView& mesh, const Lattice& lattice, SolidReport* report = nullptr);
Expected<BitVolume> voxelize(const MeshView& mesh, const Lattice& lattice, const SolidOptions& options,
                             SolidReport* report = nullptr);

/// What it means that a solid voxelizer (voxelize_solid(), SolidVoxelizer, voxelize_simplicial()) answered `status`,
/// which is not Ok, for this mesh, this lattice, and this region of it: which vertex, which place in the mesh's tables
/// or which sizes are wrong, and what to do. `report` is the call's. Checks mesh and lattice again to find out, which
/// takes a pass over their tables.
Error describe_failure(Status status, const MeshView& mesh, const Lattice& lattice, const SolidReport& report);
Error describe_failure(Status status, const MeshView& mesh, const Lattice& lattice, const Region& region,
                       const SolidReport& report);

}  // namespace xorvox
