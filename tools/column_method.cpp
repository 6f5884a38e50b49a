#include <algorithm>
#include <cstddef>
#include <new>
#include <optional>
#include <string>
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
#include "voxelizer/io/file_name.h"
#include "voxelizer/io/memory.h"
#include "voxelizer/io/volume_file.h"
#include "voxelizer/voxelize.h"

namespace xorvox::tools {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;

Expected<unsigned> chosen_threads(std::optional<std::uint32_t> threads) {
    if (!threads) return std::clamp(std::thread::hardware_concurrency(), 1u, kMaxSolidThreads);
    if (*threads >= 1 && *threads <= kMaxSolidThreads) return *threads;
    return fail(fmt::format("--threads is {}; it takes 1 to {}, or auto for one a core", *threads, kMaxSolidThreads));
}

Expected<SolidVoxelizer> start(const SolidOptions& solid) try {
    return SolidVoxelizer(solid);
} catch (const std::system_error&) {
    return fail(fmt::format("--threads: the system does not start {} of them; take fewer", solid.threads));
}

/// What such a voxelizer cannot do without.
Expected<std::uint64_t> least_memory(SolidOptions solid, const MeshView& mesh, const Lattice& lattice) {
    solid.event_bytes = 0;
    const Expected<SolidVoxelizer> smallest = start(solid);
    if (!smallest) return tl::unexpected(smallest.error());
    return smallest->memory_bytes(mesh.positions.size(), lattice);
}

/// A voxelizer whose events take only a part of what `memory_bytes` has to spare, so that it fits wherever any does.
Expected<SolidVoxelizer> make_voxelizer(const VoxelizeOptions& options, SolidOptions solid, const MeshView& mesh,
                                        const Lattice& lattice, std::uint64_t memory_bytes) {
    const Expected<Kernel> kernel = choose_kernel(options.kernel);
    if (!kernel) return tl::unexpected(kernel.error());
    const Expected<unsigned> threads = chosen_threads(options.threads);
    if (!threads) return tl::unexpected(threads.error());
    solid.kernel = *kernel;
    solid.threads = *threads;
    const Expected<std::uint64_t> least_bytes = least_memory(solid, mesh, lattice);
    if (!least_bytes) return tl::unexpected(least_bytes.error());
    const std::uint64_t spare_bytes = memory_bytes - std::min(memory_bytes, *least_bytes);
    solid.event_bytes = std::min<std::uint64_t>(solid.event_bytes, spare_bytes / 4);
    return start(solid);
}

/// What the volume and the work may take.
struct Memory {
    std::uint64_t bytes = 0;
    bool is_given = false;  ///< By --memory.
};

Memory allowed_memory(const VoxelizeOptions& options) {
    if (options.memory_mib) return {*options.memory_mib * kMiB, true};
    const std::uint64_t free = io::available_bytes();
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

/// Planes that share words of the volume, and are in the same slab: 64 of equal x.
std::uint32_t plane_step(const Lattice& file, io::SlabAxis axis) {
    return axis == io::SlabAxis::X ? std::min(64u, file.nx) : 1;
}

/// The volume of the thinnest slab.
std::uint64_t thin_slab_bytes(const Lattice& file, io::SlabAxis axis) {
    const bool along_x = axis == io::SlabAxis::X;
    const std::uint32_t step = plane_step(file, axis);
    return volume_words(along_x ? step : file.nx, file.ny, along_x ? file.nz : step) * sizeof(std::uint64_t);
}

/// Between slabs, and for the bytes of the file: once more the thinnest slab, and of layers one byte a voxel.
std::uint64_t writing_bytes(const Lattice& file, io::SlabAxis axis) {
    return thin_slab_bytes(file, axis) + (axis == io::SlabAxis::X ? 0 : std::uint64_t{file.nx} * file.ny);
}

/// Slabs as thick as memory allows: one, if the volume fits.
Expected<Slabs> cut(const Lattice& file, io::SlabAxis axis, std::uint64_t work_bytes, const Memory& memory) {
    const bool along_x = axis == io::SlabAxis::X;
    const glm::length_t number = along_x ? 0 : 2;
    const std::uint32_t all = along_x ? file.nx : file.nz;
    const std::uint32_t step = plane_step(file, axis);
    const std::uint64_t thin_bytes = thin_slab_bytes(file, axis);
    const std::uint64_t volume_bytes = volume_words(file.nx, file.ny, file.nz) * sizeof(std::uint64_t);
    work_bytes += writing_bytes(file, axis);
    if (work_bytes + volume_bytes <= memory.bytes) return Slabs{number, all};
    if (work_bytes + thin_bytes > memory.bytes) {
        return fail(fmt::format("{} needs at least {} MiB of memory, even slab by slab, and {} {} MiB; {}",
                                describe_grid(file), (work_bytes + thin_bytes + kMiB - 1) / kMiB,
                                memory.is_given ? "--memory allows" : "there are", memory.bytes / kMiB,
                                memory.is_given ? "allow more" : "choose fewer voxels"));
    }
    const std::uint64_t steps = (memory.bytes - work_bytes) / thin_bytes;
    return Slabs{number, static_cast<std::uint32_t>(std::min<std::uint64_t>(steps * step, all))};
}

/// How much of all the work is done, for the progress line. Voxelizing counts as the bytes of the volume, and writing
/// as those that the voxels are turned into on their way to the file.
class Work {
public:
    Work(Progress& progress, const std::string& output)
        : progress_(progress), writing_(io::extension_of(output) == ".bits" ? 1.0 / 2.0 : 8.0 / 9.0) {}

    /// From now on voxelized() is about so many of the planes, from the part `begin` of all.
    void begin_slab(double begin, double size) {
        begin_ = begin;
        size_ = size;
    }
    void voxelized(double part) {
        voxelized_ = begin_ + size_ * part;
        tell();
    }
    void written(double part) {
        written_ = part;
        tell();
    }

private:
    void tell() { progress_.done((1.0 - writing_) * voxelized_ + writing_ * written_); }

    Progress& progress_;
    double writing_;  // Its part of all the work.
    double begin_ = 0.0;
    double size_ = 1.0;
    double voxelized_ = 0.0;
    double written_ = 0.0;
};

/// The volume of `region` slab by slab, from the first to the last; its mesh and lattice are set.
Status voxelize_slabs(SolidVoxelizer& voxelizer, const Lattice& lattice, const Region& region, const Slabs& slabs,
                      Work& work, const SlabSink& sink, SolidReport& report) try {
    const std::uint32_t end = region.size[slabs.axis];
    if (slabs.planes < end && slabs.axis == 2 && region == whole(lattice)) {
        return voxelizer.slabs(slabs.planes, sink, &report);
    }
    std::vector<std::uint64_t> words;
    for (std::uint32_t first = 0; first < end; first += slabs.planes) {
        Region part = region;
        part.begin[slabs.axis] += first;
        part.size[slabs.axis] = std::min(slabs.planes, end - first);
        work.begin_slab(static_cast<double>(first) / end, static_cast<double>(part.size[slabs.axis]) / end);
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
    Work work(progress, options.output);
    const Memory memory = allowed_memory(options);
    SolidFile file{.lattice = part_of(lattice, region)};
    auto writer = io::VolumeWriter::create(options.output, file.lattice, stop.token(),
                                           [&](double part) { work.written(part); }, {.gzip = options.gzip});
    if (!writer) return tl::unexpected(writer.error());
    const io::SlabAxis axis = writer->slab_axis();
    const std::uint64_t slab_bytes = thin_slab_bytes(file.lattice, axis) + writing_bytes(file.lattice, axis);
    Expected<SolidVoxelizer> voxelizer =
        make_voxelizer(options, {.stop = stop.token(), .progress = [&](double part) { work.voxelized(part); }}, mesh,
                       lattice, memory.bytes - std::min(memory.bytes, slab_bytes));
    if (!voxelizer) return tl::unexpected(voxelizer.error());
    file.kernel = to_string(voxelizer->kernel());
    file.threads = voxelizer->threads();
    const std::uint64_t work_bytes = voxelizer->memory_bytes(mesh.positions.size(), lattice);
    const Expected<Slabs> slabs = cut(file.lattice, axis, work_bytes, memory);
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
    if (status == Status::Ok) status = voxelize_slabs(*voxelizer, lattice, region, *slabs, work, write, report);
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
