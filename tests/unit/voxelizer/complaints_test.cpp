// What users of other voxelizers complain about, one test each.

#include <cmath>

#include "meshes.h"
#include "oracle.h"
#include "tests/catch.h"
#include "voxelizer/fit.h"
#include "voxelizer/voxelize.h"

using namespace xorvox;
using namespace xorvox::test;

TEST_CASE("complaint: axis-aligned faces are lost") {
    // All six faces on sample planes: on each axis the lower one is in and the upper one out, none is lost.
    for (std::uint32_t n = 1; n < 20; ++n) {
        const double side = n;
        const BitVolume got =
            voxelized(box_mesh(glm::dvec3(2.0), glm::dvec3(2.0 + side)).view(), integer_lattice({24, 24, 24}));
        CHECK(got.count() == std::size_t{n} * n * n);
        CHECK(got.test(2, 2, 2));
        CHECK(got.test(n + 1, n + 1, n + 1));
        CHECK_FALSE(got.test(n + 2, n + 1, n + 1));
    }
}

TEST_CASE("complaint: a cube comes out 8 x 8 x 7") {
    for (const double size : {1e-6, 0.1, 1.0, 3.7, 1e6}) {
        for (const glm::dvec3& place : {glm::dvec3(0.0), glm::dvec3(0.3, -0.7, 1.1), glm::dvec3(-5.0, 3.0, 17.0)}) {
            const glm::dvec3 lower = place * size;
            const Lattice lattice{.nx = 8, .ny = 8, .nz = 8, .origin = lower, .pitch = glm::dvec3(size / 8.0)};
            CHECK(voxelized(box_mesh(lower, lower + size).view(), lattice).count() == 8 * 8 * 8);
        }
    }
}

TEST_CASE("complaint: a fitted cube has sides of different lengths") {
    for (std::uint32_t n = 1; n <= 130; ++n) {
        const Mesh mesh = box_mesh(glm::dvec3(-1.0), glm::dvec3(1.0));
        const BitVolume got = voxelized(mesh.view(), *fit_cube(*bounds(mesh.view()), n));
        std::uint32_t first = 0;
        while (first < n && !got.test(first, n / 2, n / 2)) ++first;
        std::uint32_t last = first;
        while (last < n && got.test(last, n / 2, n / 2)) ++last;
        INFO(n);
        CHECK(got.count() == std::size_t{last - first} * (last - first) * (last - first));
    }
}

TEST_CASE("complaint: a grid size that is no multiple of 32 fails") {
    for (std::uint32_t n = 1; n <= 100; ++n) {
        INFO(n);
        const BitVolume got =
            voxelized(box_mesh(glm::dvec3(-1.0), glm::dvec3(200.0)).view(), integer_lattice({n, 3, 2}));
        CHECK(got.count() == n * 6);
        CHECK(voxelized(box_mesh(glm::dvec3(0.5), glm::dvec3(200.0)).view(), integer_lattice({n, n, n})).count() ==
              std::size_t{n - 1} * (n - 1) * (n - 1));
    }
}

TEST_CASE("complaint: crash on exactly aligned geometry") {
    // Every vertex on a sample, every edge along rows, columns or diagonals of samples.
    for (unsigned seed = 0; seed < 50; ++seed) {
        INFO(seed);
        IntegerPoints points(seed, glm::ivec3(0), glm::ivec3(3));
        const Mesh mesh = tetrahedra(points, 20);
        const Lattice lattice = integer_lattice({4, 4, 4});
        CHECK(difference(voxelized(mesh.view(), lattice), oracle(mesh.view(), lattice, Ray::X)) == "");
    }
}

TEST_CASE("complaint: crash or emptiness on tiny models") {
    IntegerPoints points(9, glm::ivec3(-50), glm::ivec3(50));
    const Mesh unit = tetrahedra(points, 6);
    const BitVolume expected = voxelized(unit.view(), *fit_cube(*bounds(unit.view()), 40));
    CHECK(expected.count() > 1000);
    for (const int exponent : {-1000, -300, -40, -20, 20, 300}) {
        INFO(exponent);
        Mesh mesh = unit;
        for (glm::dvec3& p : mesh.positions) p *= std::ldexp(1.0, exponent);
        CHECK(difference(voxelized(mesh.view(), *fit_cube(*bounds(mesh.view()), 40)), expected) == "");
    }
}

TEST_CASE("complaint: thin parts vanish") {
    // However thin, a plate that holds samples shows them, in any of the three directions.
    const Lattice lattice = integer_lattice({20, 20, 20});
    for (const double thickness : {0.5, 1e-2, 1e-4}) {
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 lower(2.5);
            glm::dvec3 upper(16.5);
            lower[axis] = 9.0 - thickness / 2.0;
            upper[axis] = 9.0 + thickness / 2.0;
            CHECK(voxelized(box_mesh(lower, upper).view(), lattice).count() == 14 * 14);
        }
    }
}

TEST_CASE("complaint: watertight input is required without saying so") {
    const Lattice lattice = integer_lattice({10, 10, 10});
    const Mesh closed = box_mesh(glm::dvec3(1.5), glm::dvec3(6.5));
    // The walls, which no column crosses, may be missing; without the lid the columns stay inside up to the top.
    Mesh open = closed;
    open.indices.resize(12);
    CHECK(difference(voxelized(open.view(), lattice), voxelized(closed.view(), lattice)) == "");
    open.indices.resize(6);
    CHECK(voxelized(open.view(), lattice).count() == 5 * 5 * 8);
}
