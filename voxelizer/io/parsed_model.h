// ParsedModel: what a parser makes of a model file, before it is placed and welded. Private to voxelizer/io.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "voxelizer/error.h"
#include "voxelizer/io/node_motion.h"
#include "voxelizer/io/side_files.h"
#include "voxelizer/mesh.h"
#include "voxelizer/surface_colors.h"

namespace xorvox::io {

struct ParsedModel {
    Mesh mesh;  ///< In the file's units and axes. With `motion`, each vertex is in the space of its part.
    SurfaceColors colors;
    std::string colors_fault;            ///< See Scene.
    std::vector<std::string> notes;      ///< See Scene.
    std::shared_ptr<NodeMotion> motion;  ///< Null: nothing moves.
    std::vector<std::uint32_t> parts;    ///< With `motion`: the part of each vertex.
};

/// Whether the colours of a file are wanted, or its shape alone.
enum class Wanted : std::uint8_t { Shape, ShapeAndColors };

Expected<ParsedModel> parse_colored_ply(std::string_view bytes, std::string_view source, Wanted wanted);
Expected<ParsedModel> parse_colored_obj(std::string_view bytes, std::string_view source, Wanted wanted,
                                        const SideFiles& side_files);
Expected<ParsedModel> parse_gltf(std::string_view bytes, std::string_view source, Wanted wanted,
                                 const SideFiles& side_files);

}  // namespace xorvox::io
