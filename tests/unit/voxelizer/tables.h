// Lattices given by tables, for the tests.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "voxelizer/lattice.h"

namespace xorvox::test {

/// Owns the tables of a lattice.
struct Tables {
    std::uint32_t nx = 0;
    std::uint32_t ny = 0;
    std::vector<glm::dvec2> plan;
    std::vector<double> z0;
    std::vector<double> z;

    Lattice view() const {
        return {.nx = nx, .ny = ny, .nz = static_cast<std::uint32_t>(z.size()), .plan = plan, .z0 = z0, .z = z};
    }
};

/// nx × ny columns at integer places from 0 to `side`, several at some of them, of nz uneven samples.
inline Tables random_tables(unsigned seed, std::uint32_t nx, std::uint32_t ny, std::uint32_t nz, int side) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> place(0, side);
    std::uniform_int_distribution<int> step(1, 3);
    Tables tables{.nx = nx, .ny = ny};
    for (std::uint32_t i = 0; i < nx * ny; ++i) {
        tables.plan.emplace_back(place(random), place(random));
        tables.z0.push_back(step(random));
    }
    double z = 0;
    for (std::uint32_t k = 0; k < nz; ++k) tables.z.push_back(z += step(random));
    return tables;
}

}  // namespace xorvox::test
