// What holds for the colours of every model that a parser lets through.
#pragma once

#include <cmath>
#include <cstddef>

#include "tests/fuzz/io_mesh.h"
#include "voxelizer/io/parsed_model.h"

inline void check_colors(const xorvox::io::ParsedModel& parsed) {
    const xorvox::SurfaceColors& colors = parsed.colors;
    const std::size_t corners = parsed.mesh.indices.size();
    const std::size_t faces = parsed.mesh.view().face_count();
    require(colors.corner_colors.empty() || colors.corner_colors.size() == corners);
    require(colors.corner_texcoords.empty() || colors.corner_texcoords.size() == corners);
    require(colors.face_materials.empty() || colors.face_materials.size() == faces);
    for (const std::uint32_t material : colors.face_materials) require(material < colors.materials.size());
    for (const xorvox::SurfaceMaterial& material : colors.materials) {
        require(material.image == xorvox::SurfaceMaterial::kNoImage || material.image < colors.images.size());
    }
    for (const glm::vec2& t : colors.corner_texcoords) require(std::isfinite(t.x) && std::isfinite(t.y));
}

/// The mesh of a parsed model, whose colours hold.
inline xorvox::Expected<xorvox::Mesh> mesh_of(xorvox::Expected<xorvox::io::ParsedModel> parsed) {
    if (!parsed) return tl::unexpected(parsed.error());
    check_colors(*parsed);
    return std::move(parsed->mesh);
}
