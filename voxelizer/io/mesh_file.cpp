#include "voxelizer/io/mesh_file.h"

#include <utility>

#include <fmt/format.h>

#include "voxelizer/io/formats.h"
#include "voxelizer/io/read_model.h"
#include "voxelizer/io/text_scanner.h"

namespace xorvox::io {

Expected<void> check_size(std::string_view bytes, std::string_view source) {
    if (bytes.empty()) return fail(fmt::format("{}: byte 0: the file is empty; export the mesh again", source));
    if (bytes.size() > kMaxMeshFileBytes) {
        return fail(fmt::format("{}: longer than {} bytes, the most that is read; split or simplify the mesh", source,
                                kMaxMeshFileBytes));
    }
    return {};
}

Expected<double> unit_in_mm(std::string_view name) {
    if (name == "mm") return 1.0;
    if (name == "cm") return 10.0;
    if (name == "m") return 1000.0;
    if (name == "in") return 25.4;
    if (name == "ft") return 304.8;
    return fail(fmt::format("the unit {} is not known; use mm, cm, m, in or ft", quoted(name)));
}

Expected<UpAxis> up_axis(std::string_view name) {
    if (name == "x") return UpAxis::X;
    if (name == "y") return UpAxis::Y;
    if (name == "z") return UpAxis::Z;
    return fail(fmt::format("the axis {} is not known; use x, y or z", quoted(name)));
}

Expected<Mesh> read_mesh(const std::string& path, const MeshReadOptions& options) {
    auto scene = read_model(path, options, Wanted::Shape);
    if (!scene) return tl::unexpected(std::move(scene.error()));
    return std::move(scene->mesh);
}

}  // namespace xorvox::io
