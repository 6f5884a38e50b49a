// read_model: what read_mesh() and read_scene() share. Private to voxelizer/io.
#pragma once

#include <string>

#include "voxelizer/error.h"
#include "voxelizer/io/mesh_file.h"
#include "voxelizer/io/parsed_model.h"
#include "voxelizer/io/scene.h"

namespace xorvox::io {

/// read_scene(), whose colours are left out with Wanted::Shape.
Expected<Scene> read_model(const std::string& path, const MeshReadOptions& options, Wanted wanted);

}  // namespace xorvox::io
