#include "voxelizer/io/scene.h"

#include <cmath>
#include <new>
#include <utility>

#include <fmt/format.h>
#include <glm/mat4x4.hpp>

#include "voxelizer/io/file_name.h"
#include "voxelizer/io/foreign_mesh.h"
#include "voxelizer/io/formats.h"
#include "voxelizer/io/read_file.h"
#include "voxelizer/io/read_model.h"
#include "voxelizer/io/text_scanner.h"
#include "voxelizer/io/weld.h"

namespace xorvox::io {
namespace {

struct Read {
    ParsedModel model;
    UpAxis up = UpAxis::Z;  ///< What the format says.
};

Expected<Read> with_up(Expected<ParsedModel> parsed, UpAxis up) {
    if (!parsed) return tl::unexpected(std::move(parsed.error()));
    return Read{std::move(*parsed), up};
}

Expected<ParsedModel> without_colors(Expected<Mesh> mesh) {
    if (!mesh) return tl::unexpected(std::move(mesh.error()));
    ParsedModel parsed;
    parsed.mesh = std::move(*mesh);
    return parsed;
}

Expected<Read> parse_any(std::string_view bytes, const std::string& path, const std::string& name, Wanted wanted) {
    const auto ply = [&] { return with_up(parse_colored_ply(bytes, name, wanted), UpAxis::Z); };
    const auto stl = [&] { return with_up(without_colors(parse_stl(bytes, name)), UpAxis::Z); };
    const auto gltf = [&] { return with_up(parse_gltf(bytes, name, wanted, SideFiles(path)), UpAxis::Y); };
    if (begins_like_ply(bytes)) return ply();
    if (begins_like_glb(bytes)) return gltf();
    if (has_size_of_binary_stl(bytes)) return stl();
    const std::string ending = extension_of(name);
    if (ending == ".ply") return ply();
    if (ending == ".stl") return stl();
    if (ending == ".obj") return with_up(parse_colored_obj(bytes, name, wanted, SideFiles(path)), UpAxis::Z);
    if (ending == ".gltf" || ending == ".glb") return gltf();
    if (begins_like_text_stl(bytes)) return stl();
    return fail(fmt::format(
        "{}: neither its content nor its extension {} is of a known format; xorvox reads .ply, .stl and .obj, .gltf "
        "and .glb, and by another program {}",
        name, quoted(ending), foreign_endings()));
}

Expected<Read> read_any(const std::string& path, const std::string& name, Wanted wanted) {
    const auto bytes = read_file(path, name, kMeshFile);
    if (!bytes) return tl::unexpected(bytes.error());
    if (auto ok = check_size(*bytes, name); !ok) return tl::unexpected(std::move(ok.error()));
    return parse_any(*bytes, path, name, wanted);
}

// Turns `up` to z, and scales.
glm::dmat4 placement(UpAxis up, double scale) {
    glm::dmat4 m(0.0);
    const auto put = [&m, scale](int to, int from, double sign) { m[from][to] = sign * scale; };
    switch (up) {
        case UpAxis::Z: put(0, 0, 1.0), put(1, 1, 1.0), put(2, 2, 1.0); break;
        case UpAxis::Y: put(0, 0, 1.0), put(1, 2, -1.0), put(2, 1, 1.0); break;
        case UpAxis::X: put(0, 1, 1.0), put(1, 2, 1.0), put(2, 0, 1.0); break;
    }
    m[3][3] = 1.0;
    return m;
}

// A matrix would turn an infinity of one coordinate into NaN in the others, and takes longer.
glm::dvec3 placed(glm::dvec3 p, UpAxis up, double scale) {
    if (up == UpAxis::Y) p = {p.x, -p.z, p.y};
    if (up == UpAxis::X) p = {p.y, p.z, p.x};
    return p * scale;
}

Expected<void> check_finite(const Mesh& mesh, std::string_view name, double scale) {
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::dvec3& p = mesh.positions[i];
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
            return fail(
                fmt::format("{}: vertex {} is beyond the range of a double after scaling by {}; use a smaller unit",
                            name, i, scale));
        }
    }
    return {};
}

}  // namespace

Expected<Scene> read_model(const std::string& path, const MeshReadOptions& options, Wanted wanted) {
    const std::string name = printable_name(path);
    if (!std::isfinite(options.scale) || options.scale <= 0) {
        return fail(fmt::format("{}: cannot be scaled by {}; use a finite positive number", name, options.scale));
    }
    try {
        auto read = is_foreign(path)
                        ? with_up(import_foreign(path, name, wanted, options.import_program), foreign_up(path))
                        : read_any(path, name, wanted);
        if (!read) return tl::unexpected(std::move(read.error()));
        ParsedModel& model = read->model;
        const UpAxis up = options.up.value_or(read->up);
        Scene scene;
        scene.mesh = std::move(model.mesh);
        if (model.motion) {
            weld(scene.mesh, model.parts);
            model.motion->attach(std::move(scene.mesh.positions), std::move(model.parts), placement(up, options.scale));
            scene.mesh.positions = model.motion->rest_positions();
        } else {
            for (glm::dvec3& p : scene.mesh.positions) p = placed(p, up, options.scale);
        }
        if (auto ok = check_finite(scene.mesh, name, options.scale); !ok) return tl::unexpected(std::move(ok.error()));
        if (!model.motion) weld(scene.mesh);
        scene.motion = std::move(model.motion);
        scene.colors = std::move(model.colors);
        scene.colors_fault = std::move(model.colors_fault);
        scene.notes = std::move(model.notes);
        return scene;
    } catch (const std::bad_alloc&) {
        return fail(fmt::format("{}: not enough memory to read it; split or simplify the mesh", name));
    }
}

Expected<Scene> read_scene(const std::string& path, const MeshReadOptions& options) {
    return read_model(path, options, Wanted::ShapeAndColors);
}

}  // namespace xorvox::io
