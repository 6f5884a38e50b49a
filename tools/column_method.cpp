#include <algorithm>
#include <cstddef>
#include <new>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "tools/console.h"
#include "tools/kernel_choice.h"
#include "tools/placement.h"
#include "tools/solid_methods.h"
#include "tools/stop.h"
#include "voxelizer/io/volume_file.h"
#include "voxelizer/voxelize.h"

namespace xorvox::tools {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;

Expected<unsigned> chosen_threads(std::uint32_t threads) {
    if (threads == 0) return std::clamp(std::thread::hardware_concurrency(), 1u, kMaxSolidThreads);
    if (threads <= kMaxSolidThreads) return threads;
    return fail(fmt::format("--threads is {}; it takes 1 to {}, or auto for one a core", threads, kMaxSolidThreads));
}

Expected<SolidVoxelizer> make_voxelizer(const VoxelizeOptions& options, SolidOptions solid) {
    const Expected<Kernel> kernel = choose_kernel(options.kernel);
    if (!kernel) return tl::unexpected(kernel.error());
    const Expected<unsigned> threads = chosen_threads(options.threads);
    if (!threads) return tl::unexpected(threads.error());
    solid.kernel = *kernel;
    solid.threads = *threads;
    try {
        return SolidVoxelizer(std::move(solid));
    } catch (const std::system_error&) {
        return fail(fmt::format("--threads: the system does not start {} of them; take fewer", *threads));
    }
}

/// What the volume and the work may take.
struct Memory {
    std::uint64_t bytes = 0;
    bool is_given = false;  ///< By --memory.
};

Memory allowed_memory(const VoxelizeOptions& options) {
    if (options.memory_mib) return {*options.memory_mib * kMiB, true};
    const std::uint64_t free = available_bytes();
    return {free - free / 8, false};
}

/// The voxels of `region` as a grid of their own.
Lattice part_of(const Lattice& lattice, const Region& region) {
    Lattice part = lattice;
    part.nx = region.size.x;
    part.ny = region.size.y;
    part.nz = region.size.z;
    part.origin += glm::dvec3(region.begin) * lattice.pitch;
    return part;
}

/// A volume in slabs of up to `planes` planes along an axis.
struct Slabs {
    glm::length_t axis = 2;
    std::uint32_t planes = 1;
};

/// Slabs as thick as memory allows: one, if the volume fits.
Expected<Slabs> cut(const Lattice& file, io::SlabAxis axis, std::uint64_t work_bytes, const Memory& memory) {
    const bool along_x = axis == io::SlabAxis::X;
    const glm::length_t number = along_x ? 0 : 2;
    // 64 planes of equal x share their words.
    glm::uvec3 thin(file.nx, file.ny, file.nz);
    const std::uint32_t all = thin[number];
    const std::uint32_t step = along_x ? std::min(64u, all) : 1;
    thin[number] = step;
    const std::uint64_t thin_bytes = volume_words(thin.x, thin.y, thin.z) * sizeof(std::uint64_t);
    const std::uint64_t volume_bytes = volume_words(file.nx, file.ny, file.nz) * sizeof(std::uint64_t);
    // Between slabs, and for the bytes of the file: once more the thinnest slab, and of layers one byte a voxel.
    work_bytes += thin_bytes + (along_x ? 0 : std::uint64_t{file.nx} * file.ny);
    if (work_bytes + volume_bytes <= memory.bytes) return Slabs{number, all};
    if (work_bytes + thin_bytes > memory.bytes) {
        return fail(fmt::format("{} needs at least {} MiB of memory, even slab by slab, and {} {} MiB; {}",
                                describe_grid(file), (work_bytes + thin_bytes) / kMiB + 1,
                                memory.is_given ? "--memory allows" : "there are", memory.bytes / kMiB,
                                memory.is_given ? "allow more" : "choose fewer voxels"));
    }
    const std::uint64_t steps = (memory.bytes - work_bytes) / thin_bytes;
    return Slabs{number, static_cast<std::uint32_t>(std::min<std::uint64_t>(steps * step, all))};
}

/// Of all the work, what the voxelizer's progress is about.
struct Share {
    double begin = 0.0;
    double size = 1.0;
};

/// The volume of `region` slab by slab, from the first to the last; its mesh and lattice are set.
Status voxelize_slabs(SolidVoxelizer& voxelizer, const Lattice& lattice, const Region& region, const Slabs& slabs,
                      Share& share, const SlabSink& sink, SolidReport& report) try {
    const std::uint32_t end = region.size[slabs.axis];
    if (slabs.planes < end && slabs.axis == 2 && region == whole(lattice)) {
        return voxelizer.slabs(slabs.planes, sink, &report);
    }
    std::vector<std::uint64_t> words;
    for (std::uint32_t first = 0; first < end; first += slabs.planes) {
        Region part = region;
        part.begin[slabs.axis] += first;
        part.size[slabs.axis] = std::min(slabs.planes, end - first);
        share = {static_cast<double>(first) / end, static_cast<double>(part.size[slabs.axis]) / end};
        words.resize(volume_words(part.size.x, part.size.y, part.size.z));
        const BitVolumeView slab{words, part.size.x, part.size.y, part.size.z};
        if (const Status status = voxelizer.solid(part, slab, &report); status != Status::Ok) return status;
        if (!sink(slab, first)) return Status::Cancelled;
    }
    return Status::Ok;
} catch (const std::bad_alloc&) {
    return Status::OutOfMemory;
}

}  // namespace

Expected<SolidFile> voxelize_by_column(const VoxelizeOptions& options, const MeshView& mesh, const Lattice& lattice) {
    const Region region = options.region.value_or(whole(lattice));
    if (!is_inside(region, lattice)) {
        return fail(fmt::format("--region takes {} × {} × {} voxels from {},{},{}, which are not in {}", region.size.x,
                                region.size.y, region.size.z, region.begin.x, region.begin.y, region.begin.z,
                                describe_grid(lattice)));
    }
    const StopRequests stop;
    Progress progress("voxelizing and writing " + options.output);
    Share share;
    const Memory memory = allowed_memory(options);
    Expected<SolidVoxelizer> voxelizer =
        make_voxelizer(options, {.event_bytes = std::min<std::size_t>(SolidOptions{}.event_bytes, memory.bytes / 4),
                                 .stop = stop.token(),
                                 .progress = [&](double part) { progress.done(share.begin + share.size * part); }});
    if (!voxelizer) return tl::unexpected(voxelizer.error());

    SolidFile file{.lattice = part_of(lattice, region)};
    file.kernel = to_string(voxelizer->kernel());
    file.threads = voxelizer->threads();
    auto writer = io::VolumeWriter::create(options.output, file.lattice, stop.token());
    if (!writer) return tl::unexpected(writer.error());
    const std::uint64_t work_bytes = voxelizer->memory_bytes(mesh.positions.size(), lattice);
    const Expected<Slabs> slabs = cut(file.lattice, writer->slab_axis(), work_bytes, memory);
    if (!slabs) return tl::unexpected(slabs.error());

    Expected<void> written;
    const auto write = [&](ConstBitVolumeView slab, std::uint32_t first) {
        ++file.slabs;
        file.set += slab.count();
        written = writer->write(slab, first);
        return written.has_value();
    };
    SolidReport report;
    Status status = voxelizer->set_mesh(mesh, &report);
    if (status == Status::Ok) status = voxelizer->set_lattice(lattice);
    if (status == Status::Ok) status = voxelize_slabs(*voxelizer, lattice, region, *slabs, share, write, report);
    if (!written) return tl::unexpected(written.error());
    if (status == Status::Cancelled) return fail(options.output + ": stopped; nothing was written");
    if (status == Status::OutOfMemory) {
        return fail(fmt::format("{} found less memory than {} MiB; give a smaller --memory, and it goes slab by slab",
                                describe_grid(file.lattice), memory.bytes / kMiB));
    }
    if (status != Status::Ok) {
        return fail(options.mesh.path + ": " + describe_failure(status, mesh, lattice, region, report).message);
    }
    if (const auto committed = writer->commit(); !committed) return tl::unexpected(committed.error());
    return file;
}

}  // namespace xorvox::tools
