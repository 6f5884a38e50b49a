#include "tools/bench/methods.h"

#include <cassert>
#include <memory>

#include "voxelizer/simplicial.h"
#include "voxelizer/solid.h"

namespace xorvox::tools {
namespace {

/// Aligned as scratch memory has to be: by operator new.
using Memory = std::shared_ptr<std::vector<std::byte>>;

Memory memory_of(std::size_t bytes) {
    return std::make_shared<std::vector<std::byte>>(bytes);
}

Job column_job(const SolidOptions& options, const MeshView& mesh, const Lattice& lattice, BitVolumeView volume) {
    return [voxelizer = std::make_shared<SolidVoxelizer>(options), mesh, lattice, volume]() -> JobOutcome {
        SolidReport report;
        for (const Status status : {voxelizer->set_mesh(mesh), voxelizer->set_lattice(lattice)}) {
            if (status != Status::Ok) return {.status = status};
        }
        const Status status = voxelizer->solid(volume, &report);
        return {.status = status, .times = voxelizer->times(), .crossings = report.crossings};
    };
}

Job simplicial_job(const MeshView& mesh, const Lattice& lattice, BitVolumeView volume) {
    return [scratch = memory_of(simplicial_scratch_bytes(mesh)), mesh, lattice, volume]() -> JobOutcome {
        return {.status = voxelize_simplicial(mesh, lattice, {}, *scratch, volume)};
    };
}

Job reference_job(const MeshView& mesh, const Lattice& lattice, BitVolumeView volume) {
    return [scratch = memory_of(solid_scratch_bytes(mesh, lattice)), mesh, lattice, volume]() -> JobOutcome {
        SolidReport report;
        const Status status = voxelize_solid(mesh, lattice, *scratch, volume, &report);
        return {.status = status, .crossings = report.crossings};
    };
}

}  // namespace

const std::vector<std::string>& method_names() {
    static const std::vector<std::string> names{"column", "simplicial", "reference"};
    return names;
}

bool has_threads(std::string_view method) {
    return method == "column";
}

Job make_job(std::string_view method, const SolidOptions& options, const MeshView& mesh, const Lattice& lattice,
             BitVolumeView volume) {
    if (method == "simplicial") return simplicial_job(mesh, lattice, volume);
    if (method == "reference") return reference_job(mesh, lattice, volume);
    assert(method == "column");
    return column_job(options, mesh, lattice, volume);
}

}  // namespace xorvox::tools
