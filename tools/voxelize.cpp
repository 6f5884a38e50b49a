#include <cstdio>

#include <fmt/format.h>

#include "tools/commands.h"
#include "tools/console.h"
#include "tools/mesh_input.h"
#include "tools/placement.h"
#include "tools/solid_methods.h"
#include "voxelizer/io/atomic_file.h"
#include "voxelizer/io/file_name.h"
#include "voxelizer/io/volume_file.h"

namespace xorvox::tools {
namespace {

Expected<MeshInput> read_mesh(const VoxelizeOptions& options) {
    if (options.method != "simplicial") return read_solid(options.mesh);
    return read_solid(options.mesh, "each hole flips the voxels between the apex and it");
}

const char* name_of(Axis axis) {
    return axis == Axis::X ? "x" : axis == Axis::Y ? "y" : "z";
}

void print_json(const VoxelizeOptions& options, const SolidFile& file, std::size_t open_edges) {
    const Lattice& grid = file.lattice;
    fmt::print(
        "{{\"mesh\": {}, \"output\": {}, \"grid\": [{}, {}, {}], \"origin\": [{}, {}, {}], \"pitch\": [{}, {}, {}], "
        "\"voxels\": {}, \"set\": {}, \"open_edges\": {}, \"method\": \"{}\"",
        json_string(options.mesh.path), json_string(options.output), grid.nx, grid.ny, grid.nz, grid.origin.x,
        grid.origin.y, grid.origin.z, grid.pitch.x, grid.pitch.y, grid.pitch.z, grid.sample_count(), file.set,
        open_edges, options.method);
    if (options.method == "column") {
        fmt::print(", \"kernel\": \"{}\", \"threads\": {}, \"slabs\": {}", file.kernel, file.threads, file.slabs);
    }
    if (options.method == "simplicial") {
        fmt::print(", \"apex\": [{}, {}, {}], \"sweep\": \"{}\"", file.apex->x, file.apex->y, file.apex->z,
                   name_of(options.simplicial.sweep));
    }
    if (const auto& signs = file.signs) {
        fmt::print(
            ", \"signed\": {{\"outside\": {}, \"inside\": {}, \"negative\": {}, \"multiple\": {}, \"lowest\": {}, "
            "\"highest\": {}}}",
            signs->outside, signs->inside, signs->negative, signs->multiple, signs->lowest, signs->highest);
    }
    fmt::print("}}\n");
}

void print_text(const VoxelizeOptions& options, const SolidFile& file, bool is_open) {
    const Lattice& grid = file.lattice;
    fmt::print("{}: {} of {} × {} × {} = {} voxels set\n", options.output, thousands(file.set), grid.nx, grid.ny,
               grid.nz, thousands(grid.sample_count()));
    const auto& signs = file.signs;
    if (!signs) return;
    if (is_open) {
        fmt::print(
            "signed sums: {} voxels 1, {} below 0, {} above 1; the mesh is open, and so they say nothing about the "
            "orientation of its faces\n",
            thousands(signs->inside), thousands(signs->negative), thousands(signs->multiple));
    } else if (signs->is_consistent()) {
        fmt::print("signed sums: {} voxels 1, the others 0; no fault of orientation and no overlap\n",
                   thousands(signs->inside));
    } else {
        fmt::print(
            "signed sums: {} voxels 1, {} below 0, {} above 1 (from {} to {}); faces run against their neighbours or "
            "inside out, or solids overlap\n",
            thousands(signs->inside), thousands(signs->negative), thousands(signs->multiple), signs->lowest,
            signs->highest);
    }
}

}  // namespace

Expected<void> voxelize(const VoxelizeOptions& options) {
    if (const auto known = io::check_volume_path(options.output, {.gzip = options.gzip}); !known) return known;
    // Whether it can be written is said now, not after the work.
    if (const auto probe = io::AtomicFile::create(options.output); !probe) return tl::unexpected(probe.error());
    const Expected<MeshInput> input = read_mesh(options);
    if (!input) return tl::unexpected(input.error());
    const MeshView mesh = input->mesh.view();
    const Expected<Lattice> lattice = place_grid(options.grid, mesh, options.mesh.path);
    if (!lattice) return tl::unexpected(lattice.error());

    const auto method = options.method == "simplicial"  ? voxelize_by_simplices
                        : options.method == "reference" ? voxelize_by_reference
                                                        : voxelize_by_column;
    const Expected<SolidFile> file = method(options, mesh, *lattice);
    if (!file) return tl::unexpected(file.error());
    if (file->set == 0)
        warn(io::printable_name(options.mesh.path) +
             ": no voxel is inside it; it may be thinner than a voxel, or beside the grid");
    if (options.json) {
        print_json(options, *file, input->report.open_edges);
    } else {
        print_text(options, *file, input->report.open_edges > 0);
    }
    return {};
}

}  // namespace xorvox::tools
