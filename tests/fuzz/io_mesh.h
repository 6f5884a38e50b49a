// What holds for every mesh that a parser lets through, and for every message when it does not.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "voxelizer/error.h"
#include "voxelizer/io/mesh_report.h"
#include "voxelizer/io/weld.h"
#include "voxelizer/mesh.h"

inline void require(bool holds) {
    if (!holds) std::abort();
}

using Parser = xorvox::Expected<xorvox::Mesh> (*)(std::string_view bytes, std::string_view source);

inline int check_parser(Parser parse, const std::uint8_t* data, std::size_t size) {
    auto mesh = parse({reinterpret_cast<const char*>(data), size}, "file");
    if (!mesh) {
        require(mesh.error().message.starts_with("file: "));
        require(mesh.error().message.find('\n') == std::string::npos);
        return 0;
    }
    require(mesh->view().face_count() > 0);
    require(validate(mesh->view()) == xorvox::Status::Ok);
    for (std::size_t r = 0; r < mesh->view().ring_count(); ++r) require(mesh->view().ring(r).size() >= 3);
    for (const glm::dvec3& p : mesh->positions) require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));

    const std::size_t vertices = mesh->positions.size();
    const std::size_t faces = mesh->view().face_count();
    xorvox::io::weld(*mesh);
    require(mesh->positions.size() <= vertices && mesh->view().face_count() == faces);
    require(validate(mesh->view()) == xorvox::Status::Ok);
    const auto report = xorvox::io::report(mesh->view());
    require(report.faces == faces && report.duplicate_faces < faces && report.components <= faces &&
            report.components > 0);
    require(!std::isnan(report.signed_volume));
    return 0;
}
