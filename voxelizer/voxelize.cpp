#include "voxelizer/voxelize.h"

#include <cstdint>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

namespace xorvox {
namespace {

std::string describe_lattice_fault(const Lattice& lattice, Status status) {
    const std::string shape = fmt::format("{} x {} x {} samples", lattice.nx, lattice.ny, lattice.nz);
    if (lattice.nx == 0 || lattice.ny == 0 || lattice.nz == 0) {
        return fmt::format("a lattice of {} has none: give every side at least 1", shape);
    }
    if (status == Status::OutOfRange) {
        return fmt::format(
            "a lattice of {} is too large: at most {} along a side, {} columns, and positions within double", shape,
            kMaxLatticeSide, kMaxLatticeColumns);
    }
    if (lattice.is_regular()) {
        return fmt::format(
            "a lattice with pitch ({}, {}, {}) and origin ({}, {}, {}): pitches must be positive, all finite",
            lattice.pitch.x, lattice.pitch.y, lattice.pitch.z, lattice.origin.x, lattice.origin.y, lattice.origin.z);
    }
    return fmt::format(
        "the tables of a lattice of {} have {} plan, {} z0 and {} z entries: one plan and z0 entry a column, "
        "one z entry a layer, increasing, all finite",
        shape, lattice.plan.size(), lattice.z0.size(), lattice.z.size());
}

std::string describe_mesh_fault(const MeshView& mesh, std::size_t bad_index) {
    if (bad_index < mesh.indices.size()) {
        return fmt::format("a face uses vertex {} (entry {} of the mesh's indices), but there are only {} vertices",
                           mesh.indices[bad_index], bad_index, mesh.positions.size());
    }
    return fmt::format("the mesh's tables do not fit together: {} indices, {} ring starts, {} face starts",
                       mesh.indices.size(), mesh.ring_starts.size(), mesh.face_starts.size());
}

std::string describe_vertex_fault(const MeshView& mesh, std::size_t vertex) {
    const glm::dvec3& p = mesh.positions[vertex];
    return fmt::format(
        "vertex {} (counted from 0) at ({}, {}, {}) is not finite or too far from the grid, whose reach is "
        "about 1000 times its longest side: correct the vertex or make the grid larger",
        vertex, p.x, p.y, p.z);
}

/// Asking for more than the machine has would succeed on systems that overcommit, and end the process later.
bool exceeds_memory(double bytes) {
    const long pages = sysconf(_SC_PHYS_PAGES);
    const long page_bytes = sysconf(_SC_PAGESIZE);
    return pages > 0 && page_bytes > 0 && bytes > static_cast<double>(pages) * static_cast<double>(page_bytes);
}

std::string describe_region_fault(const Lattice& lattice, const Region& region) {
    return fmt::format(
        "a region of {} x {} x {} samples from sample ({}, {}, {}) is not inside a lattice of {} x {} x {}: every side "
        "must be at least 1, and its end within the lattice",
        region.size.x, region.size.y, region.size.z, region.begin.x, region.begin.y, region.begin.z, lattice.nx,
        lattice.ny, lattice.nz);
}

std::string describe_memory(const Lattice& lattice, double volume_bytes, double work_bytes) {
    constexpr double kGiB = 1 << 30;
    return fmt::format(
        "a lattice of {} x {} x {} samples takes {:.1f} GiB, and {:.1f} GiB to work in, which is more than there is: "
        "take a smaller one",
        lattice.nx, lattice.ny, lattice.nz, volume_bytes / kGiB, work_bytes / kGiB);
}

}  // namespace

Error describe_failure(Status status, const MeshView& mesh, const Lattice& lattice, const Region& region,
                       const SolidReport& report) {
    switch (status) {
        case Status::Cancelled: return {"stopped before it was done"};
        case Status::OutOfMemory: return {"the working memory is not to be had: take a smaller lattice or mesh"};
        case Status::Unsupported: return {"this method takes regular lattices, without tables"};
        default: break;
    }
    if (const Status fault = validate(lattice); fault != Status::Ok) return {describe_lattice_fault(lattice, fault)};
    if (!is_inside(region, lattice)) return {describe_region_fault(lattice, region)};
    std::size_t bad_index = 0;
    if (validate(mesh, &bad_index) != Status::Ok) return {describe_mesh_fault(mesh, bad_index)};
    if (status == Status::OutOfRange && report.bad_vertex < mesh.positions.size()) {
        return {describe_vertex_fault(mesh, report.bad_vertex)};
    }
    return {fmt::format("a volume of another shape than {} x {} x {} was given for the result", region.size.x,
                        region.size.y, region.size.z)};
}

Error describe_failure(Status status, const MeshView& mesh, const Lattice& lattice, const SolidReport& report) {
    return describe_failure(status, mesh, lattice, whole(lattice), report);
}

Expected<BitVolume> voxelize(const MeshView& mesh, const Lattice& lattice, SolidReport* report) {
    return voxelize(mesh, lattice, SolidOptions{}, report);
}

Expected<BitVolume> voxelize(const MeshView& mesh, const Lattice& lattice, const SolidOptions& options,
                             SolidReport* report) {
    SolidReport own_report;
    SolidReport& found = report == nullptr ? own_report : *report;
    found = {};
    const auto failed = [&](Status status) { return tl::unexpected(describe_failure(status, mesh, lattice, found)); };
    if (const Status status = validate(lattice); status != Status::Ok) return failed(status);
    const double volume_bytes = 8.0 * static_cast<double>(volume_words(lattice.nx, lattice.ny, lattice.nz));
    double work_bytes = 0.0;
    const auto out_of_memory = [&] { return fail(describe_memory(lattice, volume_bytes, work_bytes)); };
    try {
        SolidVoxelizer voxelizer(options);
        work_bytes = static_cast<double>(voxelizer.memory_bytes(mesh.positions.size(), lattice));
        if (exceeds_memory(volume_bytes + work_bytes)) return out_of_memory();
        if (const Status status = voxelizer.set_mesh(mesh, &found); status != Status::Ok) return failed(status);
        if (const Status status = voxelizer.set_lattice(lattice); status != Status::Ok) return failed(status);
        BitVolume volume(lattice);
        if (const Status status = voxelizer.solid(volume.view(), &found); status != Status::Ok) return failed(status);
        return volume;
    } catch (const std::bad_alloc&) {
        return out_of_memory();
    } catch (const std::length_error&) {
        return out_of_memory();
    } catch (const std::system_error& error) {
        return fail(fmt::format("{} threads cannot be started ({}): take fewer", options.threads, error.what()));
    }
}

}  // namespace xorvox
