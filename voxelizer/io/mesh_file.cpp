#include "voxelizer/io/mesh_file.h"

#include <cmath>
#include <new>
#include <utility>

#include <fmt/format.h>

#include "voxelizer/io/file_bytes.h"
#include "voxelizer/io/file_name.h"
#include "voxelizer/io/formats.h"
#include "voxelizer/io/text_scanner.h"
#include "voxelizer/io/weld.h"

namespace xorvox::io {
namespace {

Expected<Mesh> parse_any(std::string_view bytes, const std::string& name) {
    if (begins_like_ply(bytes)) return parse_ply(bytes, name);
    if (has_size_of_binary_stl(bytes)) return parse_stl(bytes, name);
    const std::string ending = extension_of(name);
    if (ending == ".ply") return parse_ply(bytes, name);
    if (ending == ".stl") return parse_stl(bytes, name);
    if (ending == ".obj") return parse_obj(bytes, name);
    if (begins_like_text_stl(bytes)) return parse_stl(bytes, name);
    return fail(fmt::format(
        "{}: neither its content nor its extension {} is of a known format; xorvox reads .ply, .stl and .obj", name,
        quoted(ending)));
}

Expected<void> place(Mesh& mesh, const MeshReadOptions& options, std::string_view source) {
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        glm::dvec3& p = mesh.positions[i];
        if (options.up == UpAxis::Y) p = {p.x, -p.z, p.y};
        if (options.up == UpAxis::X) p = {p.y, p.z, p.x};
        p *= options.scale;
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
            return fail(
                fmt::format("{}: vertex {} is beyond the range of a double after scaling by {}; use a smaller unit",
                            source, i, options.scale));
        }
    }
    return {};
}

}  // namespace

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
    const std::string name = printable_name(path);
    if (!std::isfinite(options.scale) || options.scale <= 0) {
        return fail(fmt::format("{}: cannot be scaled by {}; use a finite positive number", name, options.scale));
    }
    try {
        const auto bytes = read_file_bytes(path, name, kMaxMeshFileBytes, "a mesh file");
        if (!bytes) return tl::unexpected(bytes.error());
        if (auto ok = check_size(*bytes, name); !ok) return tl::unexpected(std::move(ok.error()));
        auto mesh = parse_any(*bytes, name);
        if (!mesh) return mesh;
        if (auto ok = place(*mesh, options, name); !ok) return tl::unexpected(std::move(ok.error()));
        weld(*mesh);
        return mesh;
    } catch (const std::bad_alloc&) {
        return fail(fmt::format("{}: not enough memory to read it; split or simplify the mesh", name));
    }
}

}  // namespace xorvox::io
