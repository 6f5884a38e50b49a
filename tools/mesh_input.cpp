#include "tools/mesh_input.h"

#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "tools/console.h"
#include "voxelizer/io/file_name.h"

namespace xorvox::tools {
namespace {

std::string import_program() {
    const char* const named = std::getenv("XORVOX_IMPORT");
    if (named && *named != '\0') return named;
    std::error_code failed;
    const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", failed);
    return failed ? std::string() : (self.parent_path() / "xorvox-import").string();
}

/// Warns of open edges, or refuses them.
Expected<void> judge(const io::MeshReport& report, const MeshOptions& options, const std::string& holes) {
    if (report.closed_mod2) return {};
    const std::size_t open = report.open_edges;
    const std::string found =
        fmt::format("{}: {} open {}", io::printable_name(options.path), thousands(open), open == 1 ? "edge" : "edges");
    if (options.strict) {
        return fail(found + ", and --strict wants a closed mesh; close its holes or leave out --strict");
    }
    warn(found + "; " + holes + " (xorvox info tells more)");
    return {};
}

}  // namespace

Expected<io::MeshReadOptions> read_options(const MeshOptions& options) {
    io::MeshReadOptions read;
    if (!options.unit.empty()) {
        const Expected<double> scale = io::unit_in_mm(options.unit);
        if (!scale) return fail("--unit: " + scale.error().message);
        read.scale = *scale;
    }
    if (!options.up.empty()) {
        const Expected<io::UpAxis> up = io::up_axis(options.up);
        if (!up) return fail("--up: " + up.error().message);
        read.up = *up;
    }
    read.import_program = import_program();
    return read;
}

Expected<MeshInput> read_solid(const MeshOptions& options, const std::string& holes) {
    const Expected<io::MeshReadOptions> read = read_options(options);
    if (!read) return tl::unexpected(read.error());
    MeshInput input;
    {
        const Progress progress("reading " + options.path);
        Expected<Mesh> mesh = io::read_mesh(options.path, *read);
        if (!mesh) return tl::unexpected(mesh.error());
        input.mesh = std::move(*mesh);
        input.report = io::report(input.mesh.view());
    }
    if (const auto judged = judge(input.report, options, holes); !judged) return tl::unexpected(judged.error());
    return input;
}

Expected<SceneInput> read_scene_input(const MeshOptions& options) {
    const Expected<io::MeshReadOptions> read = read_options(options);
    if (!read) return tl::unexpected(read.error());
    SceneInput input;
    const Progress progress("reading " + options.path);
    Expected<io::Scene> scene = io::read_scene(options.path, *read);
    if (!scene) return tl::unexpected(scene.error());
    input.scene = std::move(*scene);
    input.report = io::report(input.scene.mesh.view());
    return input;
}

Expected<SceneInput> read_solid_scene(const MeshOptions& options) {
    Expected<SceneInput> input = read_scene_input(options);
    if (!input) return input;
    if (const auto judged = judge(input->report, options, kHoles); !judged) return tl::unexpected(judged.error());
    for (const std::string& note : input->scene.notes) warn(io::printable_name(options.path) + ": " + note);
    return input;
}

}  // namespace xorvox::tools
