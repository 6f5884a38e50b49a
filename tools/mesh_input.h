// The mesh of a command: read, judged, and warned about.
#pragma once

#include "tools/commands.h"
#include "voxelizer/io/mesh_file.h"
#include "voxelizer/io/mesh_report.h"
#include "voxelizer/mesh.h"

namespace xorvox::tools {

/// A mesh and what is wrong with it.
struct MeshInput {
    Mesh mesh;
    io::MeshReport report;
};

/// `--unit` and `--up` as the readers take them, and the importer of the rarer formats: what the environment variable
/// XORVOX_IMPORT names, else xorvox-import beside this program.
Expected<io::MeshReadOptions> read_options(const MeshOptions& options);

/// Reads and examines the mesh.
Expected<MeshInput> read_input(const MeshOptions& options);

/// The same for a mesh that is going to be filled: open edges are a warning on standard error, which says what `holes`
/// do, or an error with `strict`.
Expected<MeshInput> read_solid(const MeshOptions& options,
                               const std::string& holes = "columns are counted from below, so holes may leave streaks");

}  // namespace xorvox::tools
