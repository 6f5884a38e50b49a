// Methods: the solid voxelizers, each as a job that is done from mesh to bits again and again.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "voxelizer/bit_volume.h"
#include "voxelizer/lattice.h"
#include "voxelizer/mesh.h"
#include "voxelizer/solid_voxelizer.h"

namespace xorvox::tools {

/// "column" (SolidVoxelizer), "simplicial" (voxelize_simplicial(), apex at the centroid) and "reference"
/// (voxelize_solid()).
const std::vector<std::string>& method_names();

/// Whether the method works with more than one thread.
bool has_threads(std::string_view method);

/// How a job ended; zeros where the method has no such thing.
struct JobOutcome {
    Status status = Status::Ok;
    SolidTimes times;
    std::size_t crossings = 0;
};

/// One method on one mesh and lattice, the whole way from mesh to bits: indices checked, vertices snapped, crossings
/// found, bits written. Memory and threads are reused from run to run, nothing else is.
using Job = std::function<JobOutcome()>;

/// `method` is one of method_names(). Mesh and lattice are borrowed for the life of the job, and `volume`, which has
/// the lattice's shape and is overwritten by each run.
Job make_job(std::string_view method, const SolidOptions& options, const MeshView& mesh, const Lattice& lattice,
             BitVolumeView volume);

}  // namespace xorvox::tools
