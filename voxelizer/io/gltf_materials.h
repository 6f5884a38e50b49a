// The materials of a glTF file. Private to voxelizer/io.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>

#include "voxelizer/io/gltf_model.h"
#include "voxelizer/surface_colors.h"

namespace xorvox::io {

struct GltfMaterial {
    SurfaceMaterial surface;  ///< Its image is a number of the model.
    int texcoord_set = 0;     ///< TEXCOORD_n.
    // KHR_texture_transform: scaled, turned, moved.
    glm::dvec2 scale{1.0};
    double rotation = 0.0;  ///< Radians.
    glm::dvec2 offset{0.0};

    glm::vec2 transformed(const glm::dvec2& texcoord) const;
};

/// Every material of the model, and at the end the white one of primitives that have none.
Expected<std::vector<GltfMaterial>> read_gltf_materials(const tinygltf::Model& model, const GltfData& data);

/// Decodes the images that `used` materials have, and numbers them anew in there.
Expected<std::vector<Image>> read_gltf_images(const tinygltf::Model& model, const GltfData& data,
                                              std::string_view source, const SideFiles& side_files,
                                              std::vector<SurfaceMaterial>& used);

}  // namespace xorvox::io
