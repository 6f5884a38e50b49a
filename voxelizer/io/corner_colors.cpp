#include "voxelizer/io/corner_colors.h"

#include <algorithm>

#include "voxelizer/elementary.h"

namespace xorvox::io {

glm::vec3 linear_color(const glm::dvec3& srgb) {
    const auto linear = [](double value) { return elementary::linear_from_srgb(static_cast<float>(value)); };
    return {linear(srgb.r), linear(srgb.g), linear(srgb.b)};
}

void drop_white(SurfaceColors& colors) {
    const bool is_white = colors.images.empty() && std::all_of(colors.materials.begin(), colors.materials.end(),
                                                               [](const SurfaceMaterial& material) {
                                                                   return material.factor == glm::vec3(1.0f);
                                                               });
    if (colors.images.empty()) colors.corner_texcoords = {};
    if (is_white) {
        colors.materials = {};
        colors.face_materials = {};
    }
}

}  // namespace xorvox::io
