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

Expected<MeshInput> read_input(const MeshOptions& options) {
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
    return input;
}

Expected<MeshInput> read_solid(const MeshOptions& options, const std::string& holes) {
    Expected<MeshInput> input = read_input(options);
    if (!input || input->report.closed_mod2) return input;
    const std::size_t open = input->report.open_edges;
    const std::string found =
        fmt::format("{}: {} open {}", io::printable_name(options.path), thousands(open), open == 1 ? "edge" : "edges");
    if (options.strict)
        return fail(found + ", and --strict wants a closed mesh; close its holes or leave out --strict");
    warn(found + "; " + holes + " (xorvox info tells more)");
    return input;
}

}  // namespace xorvox::tools
