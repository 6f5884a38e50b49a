// Peer: another library's solid voxelizer, measured beside ours.
#pragma once

#include <functional>
#include <string>

#include "voxelizer/bit_volume.h"
#include "voxelizer/lattice.h"
#include "voxelizer/mesh.h"

namespace xorvox::bench {

struct Peer {
    std::string name;
    std::function<void()> run;          ///< From the library's own mesh, made once, to its own volume; one thread.
    std::function<BitVolume()> voxels;  ///< The samples that the last run found inside.
};

/// VTK's vtkPolyDataToImageStencil with tolerance 0. A run ends with its run lists; no image is made of them. `mesh`
/// consists of triangles; `lattice` is regular.
Peer make_vtk_peer(const MeshView& mesh, const Lattice& lattice);

/// OpenVDB's meshToVolume, with a band of one voxel (less work than the usual three), and sdfInteriorMask. The same
/// demands.
Peer make_openvdb_peer(const MeshView& mesh, const Lattice& lattice);

}  // namespace xorvox::bench
