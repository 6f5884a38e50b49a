// The methods of `voxelize`, from a mesh and a grid to a volume in a file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "tools/commands.h"
#include "voxelizer/lattice.h"
#include "voxelizer/mesh.h"
#include "voxelizer/simplicial.h"

namespace xorvox::tools {

/// What is in the file, and how it came about.
struct SolidFile {
    Lattice lattice;                   ///< The grid, or --region of it.
    std::uint64_t set = 0;             ///< Voxels.
    std::string kernel{};              ///< Of the method "column"; else empty.
    unsigned threads = 1;              ///< That worked on it.
    std::uint32_t slabs = 0;           ///< Of the method "column": more than one, and it was never whole in memory.
    std::optional<glm::dvec3> apex{};  ///< Of the method "simplicial", as snapped, in the units of the mesh.
    std::optional<InclusionReport> signs{};  ///< With --signed.
};

/// Each writes the volume of `mesh` on `lattice` to options.output. A signal stops the column method, and the writing
/// of all three, with an error; the other two it ends at once while they compute, before there is a file.
Expected<SolidFile> voxelize_by_column(const VoxelizeOptions& options, const MeshView& mesh, const Lattice& lattice);
Expected<SolidFile> voxelize_by_simplices(const VoxelizeOptions& options, const MeshView& mesh, const Lattice& lattice);
Expected<SolidFile> voxelize_by_reference(const VoxelizeOptions& options, const MeshView& mesh, const Lattice& lattice);

/// "a grid of 4 × 5 × 6 voxels".
std::string describe_grid(const Lattice& lattice);

}  // namespace xorvox::tools
