// CornerColors: the colours of a mesh, face by face, while it is read. Private to voxelizer/io.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "voxelizer/surface_colors.h"

namespace xorvox::io {

/// Tables begin with the first corner or face that has something to say, and are then filled up from the beginning: a
/// mesh without colours costs nothing.
class CornerColors {
public:
    /// To be called for corner after corner of the mesh, with what it has.
    void set_color(std::size_t corner, const glm::vec3& color) {
        put(colors.corner_colors, corner, color, glm::vec3(1.0f));
    }
    void set_texcoord(std::size_t corner, const glm::vec2& texcoord) {
        put(colors.corner_texcoords, corner, texcoord, glm::vec2(0.0f));
    }
    void set_material(std::size_t face, std::uint32_t material) {
        if (material != 0 || !colors.face_materials.empty()) put(colors.face_materials, face, material, 0u);
    }

    /// The tables, each empty or of one entry a corner or a face.
    SurfaceColors finish(std::size_t corners, std::size_t faces) && {
        if (!colors.corner_colors.empty()) colors.corner_colors.resize(corners, glm::vec3(1.0f));
        if (!colors.corner_texcoords.empty()) colors.corner_texcoords.resize(corners, glm::vec2(0.0f));
        if (!colors.face_materials.empty()) colors.face_materials.resize(faces, 0u);
        return std::move(colors);
    }

    SurfaceColors colors;

private:
    template <class T>
    static void put(std::vector<T>& table, std::size_t at, const T& value, const T& otherwise) {
        table.resize(at, otherwise);
        table.push_back(value);
    }
};

/// Linear light of a colour that a file gives as screens take it, in sRGB, 0 … 1 each.
glm::vec3 linear_color(const glm::dvec3& srgb);

/// Drops what has no effect: factors that are all white, texture coordinates without images.
void drop_white(SurfaceColors& colors);

}  // namespace xorvox::io
