// The mesh of a command: read, judged, and warned about.
#pragma once

#include <string>

#include "tools/commands.h"
#include "voxelizer/io/mesh_file.h"
#include "voxelizer/io/mesh_report.h"
#include "voxelizer/io/scene.h"
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

/// The same with all that its file holds.
struct SceneInput {
    io::Scene scene;
    io::MeshReport report;
};

inline constexpr const char* kHoles = "columns are counted from below, so holes may leave streaks";

/// Reads and examines a mesh that is going to be filled: open edges are a warning on standard error, which says what
/// `holes` do, or an error with `strict`.
Expected<MeshInput> read_solid(const MeshOptions& options, const std::string& holes = kHoles);

/// Reads and examines a scene.
Expected<SceneInput> read_scene_input(const MeshOptions& options);
/// The same for one that is going to be filled; what is in the file and not in the scene is a warning, too.
Expected<SceneInput> read_solid_scene(const MeshOptions& options);

}  // namespace xorvox::tools
