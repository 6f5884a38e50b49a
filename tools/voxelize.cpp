#include <cstdio>

#include <fmt/format.h>

#include "tools/commands.h"
#include "tools/console.h"
#include "tools/mesh_input.h"
#include "tools/placement.h"
#include "voxelizer/io/atomic_file.h"
#include "voxelizer/io/volume_file.h"
#include "voxelizer/voxelize.h"

namespace xorvox::tools {

Expected<void> voxelize(const VoxelizeOptions& options) {
    if (const auto known = io::check_volume_path(options.output); !known) return known;
    // Whether it can be written is said now, not after the work.
    if (const auto probe = io::AtomicFile::create(options.output); !probe) return tl::unexpected(probe.error());
    const Expected<MeshInput> input = read_solid(options.mesh);
    if (!input) return tl::unexpected(input.error());
    const MeshView mesh = input->mesh.view();
    const Expected<Lattice> lattice = place_grid(options.grid, mesh, options.mesh.path);
    if (!lattice) return tl::unexpected(lattice.error());
    const std::uint64_t volume_bytes = volume_words(lattice->nx, lattice->ny, lattice->nz) * sizeof(std::uint64_t);
    const std::string what = fmt::format("a grid of {} × {} × {} voxels", lattice->nx, lattice->ny, lattice->nz);
    if (const auto fits = check_memory(volume_bytes + solid_scratch_bytes(mesh, *lattice), what); !fits) return fits;

    Expected<BitVolume> volume;
    {
        const Progress progress("voxelizing");
        volume = xorvox::voxelize(mesh, *lattice);
        if (!volume) return fail(options.mesh.path + ": " + volume.error().message);
    }
    {
        const Progress progress("writing " + options.output);
        if (const auto written = io::write_volume(options.output, volume->view(), *lattice); !written) return written;
    }
    const std::size_t set = volume->count();
    if (set == 0)
        warn(options.mesh.path + ": no voxel is inside it; it may be thinner than a voxel, or beside the grid");
    if (options.json) {
        fmt::print(
            "{{\"mesh\": {}, \"output\": {}, \"grid\": [{}, {}, {}], \"origin\": [{}, {}, {}], \"pitch\": [{}, {}, "
            "{}], "
            "\"voxels\": {}, \"set\": {}, \"open_edges\": {}}}\n",
            json_string(options.mesh.path), json_string(options.output), lattice->nx, lattice->ny, lattice->nz,
            lattice->origin.x, lattice->origin.y, lattice->origin.z, lattice->pitch.x, lattice->pitch.y,
            lattice->pitch.z, lattice->sample_count(), set, input->report.open_edges);
    } else {
        fmt::print("{}: {} of {} × {} × {} = {} voxels set\n", options.output, thousands(set), lattice->nx, lattice->ny,
                   lattice->nz, thousands(lattice->sample_count()));
    }
    return {};
}

}  // namespace xorvox::tools
