#include "tools/solid_methods.h"

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "tools/console.h"
#include "tools/placement.h"
#include "tools/stop.h"
#include "voxelizer/io/volume_file.h"
#include "voxelizer/snap.h"
#include "voxelizer/solid.h"
#include "voxelizer/voxelize.h"

namespace xorvox::tools {
namespace {

/// Memory as the core's functions want it.
class ScratchMemory {
public:
    explicit ScratchMemory(std::size_t bytes) : blocks_((bytes + sizeof(Block) - 1) / sizeof(Block)) {}
    std::span<std::byte> bytes() { return std::as_writable_bytes(std::span(blocks_)); }

private:
    struct alignas(16) Block {
        std::byte bytes[16];
    };
    std::vector<Block> blocks_;
};

Expected<void> check_whole_volume(const Lattice& lattice, std::uint64_t work_bytes) {
    const std::uint64_t volume_bytes = volume_words(lattice.nx, lattice.ny, lattice.nz) * sizeof(std::uint64_t);
    return check_memory(volume_bytes + work_bytes, describe_grid(lattice));
}

Error describe_simplicial_failure(Status status, const VoxelizeOptions& options, const MeshView& mesh,
                                  const Lattice& lattice, const SimplicialReport& report) {
    switch (report.fault) {
        case SimplicialFault::Apex:
            return {
                "--apex is not finite, or further from the grid than about 1000 times its longest side; choose a "
                "nearer one"};
        case SimplicialFault::Counter:
            return {"--signed: a voxel is in more tetrahedra than its 16 bits count; choose another --apex"};
        default: break;
    }
    const SolidReport solid{.bad_vertex = report.bad_vertex, .bad_index = report.bad_index};
    return {options.mesh.path + ": " + describe_failure(status, mesh, lattice, solid).message};
}

Expected<void> write(const VoxelizeOptions& options, const BitVolume& volume, const Lattice& lattice) {
    const StopRequests stop;
    const Progress progress("writing " + options.output);
    return io::write_volume(options.output, volume.view(), lattice, stop.token(), {.gzip = options.gzip});
}

}  // namespace

std::string describe_grid(const Lattice& lattice) {
    return fmt::format("a grid of {} × {} × {} voxels", lattice.nx, lattice.ny, lattice.nz);
}

Expected<SolidFile> voxelize_by_simplices(const VoxelizeOptions& options, const MeshView& mesh,
                                          const Lattice& lattice) {
    const std::size_t scratch_bytes = simplicial_scratch_bytes(mesh);
    const std::uint64_t sum_bytes = options.signed_sum ? lattice.sample_count() * sizeof(std::int16_t) : 0;
    if (const auto fits = check_whole_volume(lattice, scratch_bytes + sum_bytes); !fits) {
        return tl::unexpected(fits.error());
    }
    SolidFile file{.lattice = lattice};
    ScratchMemory scratch(scratch_bytes);
    SimplicialReport report;
    const auto failed = [&](Status status) {
        return tl::unexpected(describe_simplicial_failure(status, options, mesh, lattice, report));
    };
    if (options.signed_sum) {
        const Progress progress("summing");
        std::vector<std::int16_t> sums(lattice.sample_count());
        const Status status = sum_inclusions(mesh, lattice, options.simplicial, scratch.bytes(), sums, &report);
        if (status != Status::Ok) return failed(status);
        file.signs = inspect_inclusions(sums);
    }
    BitVolume volume(lattice);
    {
        const Progress progress("voxelizing");
        const Status status =
            voxelize_simplicial(mesh, lattice, options.simplicial, scratch.bytes(), volume.view(), &report);
        if (status != Status::Ok) return failed(status);
    }
    file.set = volume.count();
    const SnapGrid grid = snap_grid(lattice);
    file.apex = grid.origin + glm::dvec3(report.apex) * grid.length / std::ldexp(1.0, static_cast<int>(grid.shift));
    if (const auto written = write(options, volume, lattice); !written) return tl::unexpected(written.error());
    return file;
}

Expected<SolidFile> voxelize_by_reference(const VoxelizeOptions& options, const MeshView& mesh,
                                          const Lattice& lattice) {
    const std::size_t scratch_bytes = solid_scratch_bytes(mesh, lattice);
    if (const auto fits = check_whole_volume(lattice, scratch_bytes); !fits) return tl::unexpected(fits.error());
    ScratchMemory scratch(scratch_bytes);
    BitVolume volume(lattice);
    {
        const Progress progress("voxelizing");
        SolidReport report;
        const Status status = voxelize_solid(mesh, lattice, scratch.bytes(), volume.view(), &report);
        if (status != Status::Ok) {
            return fail(options.mesh.path + ": " + describe_failure(status, mesh, lattice, report).message);
        }
    }
    if (const auto written = write(options, volume, lattice); !written) return tl::unexpected(written.error());
    return SolidFile{.lattice = lattice, .set = volume.count()};
}

}  // namespace xorvox::tools
