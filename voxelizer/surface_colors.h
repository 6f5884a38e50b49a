// SurfaceColors: what colours the surface of a mesh has, corner by corner and face by face, as files tell it.
//
// The colour at a place of a face is the product of three: the material's factor, the material's image at the place's
// texture coordinates, and the colour between those of the corners. What is missing counts as white.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "voxelizer/image.h"

namespace xorvox {

/// How texture coordinates beyond 0 … 1 are taken.
enum class TextureWrap : std::uint8_t { Repeat, Mirror, Clamp };

struct SurfaceMaterial {
    static constexpr std::uint32_t kNoImage = 0xffff'ffff;

    glm::vec3 factor{1.0f};          ///< Linear light.
    std::uint32_t image = kNoImage;  ///< Index into SurfaceColors::images.
    TextureWrap wrap_u = TextureWrap::Repeat;
    TextureWrap wrap_v = TextureWrap::Repeat;
};

/// Belongs to a Mesh, whose corners are the entries of its `indices`; welding the mesh leaves it true, since faces keep
/// their corners. A table may be empty, else it has exactly the entries named.
struct SurfaceColors {
    std::vector<glm::vec3> corner_colors;       ///< One a corner, linear light; empty: white.
    std::vector<glm::vec2> corner_texcoords;    ///< One a corner; (0, 0) is the image's upper left; empty: no image.
    std::vector<std::uint32_t> face_materials;  ///< One a face; empty: all have material 0.
    std::vector<SurfaceMaterial> materials;     ///< Empty: one that is white.
    std::vector<Image> images;

    /// Whether nothing of it is coloured: no corner, and no material by a factor or an image.
    bool is_white() const {
        return corner_colors.empty() && std::ranges::all_of(materials, [](const SurfaceMaterial& material) {
                   return material.factor == glm::vec3(1.0f) && material.image == SurfaceMaterial::kNoImage;
               });
    }
};

}  // namespace xorvox
