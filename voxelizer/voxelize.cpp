#include "voxelizer/voxelize.h"

#include <cstdint>
#include <new>
#include <stdexcept>
#include <vector>

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

}  // namespace

Expected<BitVolume> voxelize(const MeshView& mesh, const Lattice& lattice, SolidReport* report) {
    if (const Status status = validate(lattice); status != Status::Ok) {
        return fail(describe_lattice_fault(lattice, status));
    }
    const std::size_t scratch_bytes = solid_scratch_bytes(mesh, lattice);
    const double volume_bytes = 8.0 * static_cast<double>(volume_words(lattice.nx, lattice.ny, lattice.nz));
    const auto out_of_memory = [&] {
        return fail(fmt::format(
            "a lattice of {} x {} x {} samples takes {:.1f} GiB, more than there is: take a smaller one", lattice.nx,
            lattice.ny, lattice.nz, (volume_bytes + static_cast<double>(scratch_bytes)) / (1 << 30)));
    };
    if (exceeds_memory(volume_bytes + static_cast<double>(scratch_bytes))) return out_of_memory();
    SolidReport own_report;
    SolidReport& found = report == nullptr ? own_report : *report;
    try {
        struct alignas(16) Block {
            std::byte bytes[16];
        };
        std::vector<Block> scratch((scratch_bytes + sizeof(Block) - 1) / sizeof(Block));
        BitVolume volume(lattice);
        switch (voxelize_solid(mesh, lattice, std::as_writable_bytes(std::span(scratch)), volume.view(), &found)) {
            case Status::Ok: return volume;
            case Status::OutOfRange: return fail(describe_vertex_fault(mesh, found.bad_vertex));
            default: return fail(describe_mesh_fault(mesh, found.bad_index));
        }
    } catch (const std::bad_alloc&) {
        return out_of_memory();
    } catch (const std::length_error&) {
        return out_of_memory();
    }
}

}  // namespace xorvox
