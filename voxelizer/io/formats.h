// What the parsers share with mesh_file.cpp. Private to voxelizer/io.
#pragma once

#include <string_view>

#include "voxelizer/error.h"
#include "voxelizer/io/image_file.h"
#include "voxelizer/io/mesh_file.h"
#include "voxelizer/io/read_file.h"

namespace xorvox::io {

inline constexpr FileKind kMeshFile{"a mesh file", kMaxMeshFileBytes, "split or simplify the mesh"};
inline constexpr FileKind kImageFile{"an image file", kMaxImageFileBytes, "make it smaller"};

/// An error when `bytes` are none or more than kMaxMeshFileBytes.
Expected<void> check_size(std::string_view bytes, std::string_view source);

bool begins_like_ply(std::string_view bytes);
bool begins_like_text_stl(std::string_view bytes);
bool begins_like_glb(std::string_view bytes);
/// Whether the size is 84 + 50 × the count at byte 80.
bool has_size_of_binary_stl(std::string_view bytes);

}  // namespace xorvox::io
