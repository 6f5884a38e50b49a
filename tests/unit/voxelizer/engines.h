// Every way in which a SolidVoxelizer can be set up on this machine.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "voxelizer/solid_voxelizer.h"

namespace xorvox::test {

/// All kernels with one thread, and the slowest and the fastest with 2, 3 and 7.
inline std::vector<SolidOptions> all_engines() {
    std::vector<SolidOptions> engines;
    for (const Kernel kernel : available_kernels()) engines.push_back({.kernel = kernel});
    for (const unsigned threads : {2u, 3u, 7u}) {
        engines.push_back({.kernel = Kernel::Scalar, .threads = threads});
        engines.push_back({.kernel = best_kernel(), .threads = threads});
    }
    return engines;
}

inline std::string name_of(const SolidOptions& engine) {
    return std::string(to_string(engine.kernel)) + ", " + std::to_string(engine.threads) + " threads";
}

/// A voxelizer with mesh and lattice set; throws std::runtime_error when they are refused.
inline SolidVoxelizer engine_for(const MeshView& mesh, const Lattice& lattice, const SolidOptions& options = {}) {
    SolidVoxelizer engine(options);
    if (engine.set_mesh(mesh) != Status::Ok) throw std::runtime_error("the mesh is refused");
    if (engine.set_lattice(lattice) != Status::Ok) throw std::runtime_error("the lattice is refused");
    return engine;
}

/// The bits of a region of `all`.
inline BitVolume part_of(const BitVolume& all, const Region& region) {
    BitVolume part(region.size.x, region.size.y, region.size.z);
    for (std::uint32_t k = 0; k < region.size.z; ++k) {
        for (std::uint32_t y = 0; y < region.size.y; ++y) {
            for (std::uint32_t x = 0; x < region.size.x; ++x) {
                if (all.test(region.begin.x + x, region.begin.y + y, region.begin.z + k)) part.view().flip(x, y, k);
            }
        }
    }
    return part;
}

}  // namespace xorvox::test
