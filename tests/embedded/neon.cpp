// The kernels on a 64-bit ARM, in QEMU: random closed meshes, on grids and tables, by every kernel that is there.
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include <hwy/targets.h>

#include "voxelizer/solid.h"
#include "voxelizer/solid_voxelizer.h"

// What of Highway's library is used, which is not here for this processor. All 64-bit ARMs have NEON.
namespace hwy {
int64_t SupportedTargets() {
    return HWY_NEON;
}
void Abort(const char*, int, const char*, ...) {
    __builtin_trap();
}
}  // namespace hwy

using namespace xorvox;

namespace {

std::mt19937 g_random(1);

int below(int n) {
    return static_cast<int>(g_random() % static_cast<unsigned>(n));
}

struct Soup {
    std::vector<glm::dvec3> positions;
    std::vector<std::uint32_t> indices;

    /// Tetrahedra of a size in a box of 60; on samples, where they tie, or anywhere.
    Soup(int count, double size, bool on_samples) {
        for (int i = 0; i < count; ++i) {
            const glm::dvec3 base(below(60'000), below(60'000), below(60'000));
            const auto first = static_cast<std::uint32_t>(positions.size());
            for (int corner = 0; corner < 4; ++corner) {
                const glm::dvec3 offset(below(60'000), below(60'000), below(60'000));
                const glm::dvec3 p = (base * (1.0 - size) + offset * size) * 1e-3;
                positions.push_back(on_samples ? glm::dvec3(std::floor(p.x), std::floor(p.y), std::floor(p.z)) : p);
            }
            for (const std::uint32_t corner : {0, 1, 2, 0, 1, 3, 0, 2, 3, 1, 2, 3}) indices.push_back(first + corner);
        }
    }
};

int count_differences(const MeshView& mesh, const Lattice& lattice) {
    struct alignas(16) Block {
        std::byte bytes[16];
    };
    std::vector<Block> scratch(solid_scratch_bytes(mesh, lattice) / sizeof(Block) + 1);
    BitVolume expected(lattice);
    BitVolume got(lattice);
    if (voxelize_solid(mesh, lattice, std::as_writable_bytes(std::span(scratch)), expected.view()) != Status::Ok) {
        return 1;
    }
    int differences = 0;
    for (const Kernel kernel : available_kernels()) {
        SolidVoxelizer engine({.kernel = kernel, .threads = 2});
        const bool done = engine.set_mesh(mesh) == Status::Ok && engine.set_lattice(lattice) == Status::Ok &&
                          engine.solid(got.view()) == Status::Ok;
        if (done && got == expected) continue;
        std::printf("%s differs\n", to_string(kernel));
        ++differences;
    }
    return differences;
}

}  // namespace

int main() {
    if (best_kernel() != Kernel::Neon) {
        std::puts("there is no NEON kernel");
        return 1;
    }
    int differences = 0;
    for (int round = 0; round < 30; ++round) {
        const bool small = round % 3 == 0;
        const Soup soup(small ? 400 : 40, small ? 0.05 : 1.0, round % 2 == 0);
        const MeshView mesh{soup.positions, soup.indices, {}, {}};
        Lattice lattice;
        lattice.nx = 50;
        lattice.ny = 51;
        lattice.nz = round % 4 < 2 ? 40 : 90;
        lattice.origin = glm::dvec3(-0.5);
        differences += count_differences(mesh, lattice);

        std::vector<glm::dvec2> plan;
        std::vector<double> z{0.5};
        for (int i = 0; i < 50 * 51; ++i) plan.emplace_back(below(60'000) * 1e-3, below(60));
        while (z.size() < lattice.nz) z.push_back(z.back() + 1 + below(2));
        lattice.plan = plan;
        lattice.z = z;
        differences += count_differences(mesh, lattice);
    }
    std::printf("%d differences\n", differences);
    return differences == 0 ? 0 : 1;
}
