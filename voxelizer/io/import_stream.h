// ImportStream: what xorvox-import writes and import_foreign() reads. Private to voxelizer/io and tools/import.cpp.
//
//   0    "XORVOXI1"
//   8    u32 × 8: vertices, corners, faces, materials, images, notes, 1 with corner colours, 1 with texture coordinates
//   40   vertices × 3 f64 | corners × u32 vertex | faces × u32 corners of the face | faces × u32 material
//        corners × 3 f32 colours, sRGB | corners × 2 f32 texture coordinates, (0, 0) the upper left
//        materials × (3 f32 sRGB, u32 image or 0xffffffff, u32 wrap along u, u32 wrap along v)
//        images × (u32 1 for the name of a file, 0 for its content, u32 length, bytes)
//        notes × (u32 length, bytes)
//
// or "XORVOXE1" and, to the end, why the file is not read. All little-endian.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "voxelizer/error.h"
#include "voxelizer/surface_colors.h"

namespace xorvox::io {

struct ImportedImage {
    bool is_name = false;
    std::string bytes;  ///< The name of a file, or the content of one.
};

struct ImportedModel {
    std::vector<glm::dvec3> positions;
    std::vector<std::uint32_t> indices;
    std::vector<std::uint32_t> face_sizes;      ///< Corners of each face.
    std::vector<std::uint32_t> face_materials;  ///< One a face.
    std::vector<glm::vec3> corner_colors;       ///< sRGB; empty or one a corner.
    std::vector<glm::vec2> corner_texcoords;    ///< Empty or one a corner.
    std::vector<SurfaceMaterial> materials;     ///< Their factors in sRGB.
    std::vector<ImportedImage> images;
    std::vector<std::string> notes;
};

std::string encode_import(const ImportedModel& model);
std::string encode_import_error(std::string_view why);

/// The model, checked: counts that the bytes have, finite positions, indices below their ends, faces of three corners
/// or more. Errors say what is wrong, without the name of a file; `refused` tells whether they are the importer's own.
Expected<ImportedModel> parse_import(std::string_view bytes, bool& refused);

/// Null, or what is wrong with the model's colours: some not in 0 … 1, or texture coordinates that are not finite.
const char* color_fault(const ImportedModel& model);

}  // namespace xorvox::io
