// Calls of the simplicial covering that must succeed, with memory of their own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "voxelizer/simplicial.h"

namespace xorvox::test {

class SimplicialScratch {
public:
    explicit SimplicialScratch(const MeshView& mesh) : blocks_(simplicial_scratch_bytes(mesh) / sizeof(Block) + 1) {}
    std::span<std::byte> bytes() { return std::as_writable_bytes(std::span(blocks_)); }

private:
    struct alignas(16) Block {
        std::byte bytes[16];
    };
    std::vector<Block> blocks_;
};

/// The bits of voxelize_simplicial().
inline BitVolume covered(const MeshView& mesh, const Lattice& lattice, const SimplicialOptions& options = {},
                         SimplicialReport* report = nullptr) {
    SimplicialScratch scratch(mesh);
    BitVolume out(lattice);
    const Status status = voxelize_simplicial(mesh, lattice, options, scratch.bytes(), out.view(), report);
    if (status != Status::Ok) throw std::runtime_error(to_string(status));
    return out;
}

/// The sums of sum_inclusions().
inline std::vector<std::int16_t> sums(const MeshView& mesh, const Lattice& lattice,
                                      const SimplicialOptions& options = {}) {
    SimplicialScratch scratch(mesh);
    std::vector<std::int16_t> out(lattice.sample_count(), 77);
    const Status status = sum_inclusions(mesh, lattice, options, scratch.bytes(), out);
    if (status != Status::Ok) throw std::runtime_error(to_string(status));
    return out;
}

}  // namespace xorvox::test
