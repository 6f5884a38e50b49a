#include "voxelizer/snap.h"

#include <cmath>
#include <limits>
#include <vector>

#include "meshes.h"
#include "tests/catch.h"

using namespace xorvox;
using namespace xorvox::test;

TEST_CASE("samples of a regular lattice snap to the middle of their steps") {
    for (const std::uint32_t n : {1u, 2u, 3u, 4u, 5u, 63u, 64u, 65u, 1000u, 4096u}) {
        const Lattice lattice{.nx = n, .ny = 1, .nz = 1, .origin = {0.1, -7.3, 1e5}, .pitch = {0.3, 1e-4, 12.7}};
        const SnapGrid grid = snap_grid(lattice);
        const std::int32_t pitch = std::int32_t{1} << grid.shift;
        CHECK(std::int64_t{pitch} * n <= 1 << 20);
        CHECK(std::int64_t{pitch} * n > 1 << 19);
        for (std::uint32_t x = 0; x < n; ++x) {
            glm::ivec3 q{0};
            REQUIRE(snap(grid, sample_position(lattice, x, 0, 0), q));
            REQUIRE(q.x == static_cast<std::int32_t>(x) * pitch + pitch / 2);
            REQUIRE(q.y == pitch / 2);
            REQUIRE(q.z == pitch / 2);
        }
    }
}

TEST_CASE("halves of a unit snap to the even neighbour") {
    const Lattice lattice{.nx = 4096, .ny = 1, .nz = 1};  // 2^8 units a pitch of 1.
    const SnapGrid grid = snap_grid(lattice);
    const double unit = 1.0 / 256.0;
    glm::ivec3 q{0};
    REQUIRE(snap(grid, glm::dvec3(0.5, 1.5, 2.5) * unit, q));
    CHECK(q == glm::ivec3(0, 2, 2));
    REQUIRE(snap(grid, glm::dvec3(-0.5, -1.5, -2.5) * unit, q));
    CHECK(q == glm::ivec3(0, -2, -2));
    REQUIRE(snap(grid, glm::dvec3(0.49, -0.51, 2.51) * unit, q));
    CHECK(q == glm::ivec3(0, -1, 3));
}

TEST_CASE("points snap as far as 2^30 units and no further") {
    const SnapGrid grid = snap_grid(Lattice{.nx = 4096, .ny = 1, .nz = 1});
    const double limit = 4194304.0;  // 2^30 / 2^8.
    glm::ivec3 q{0};
    REQUIRE(snap(grid, {limit, -limit, limit}, q));
    CHECK(q == glm::ivec3(kSnapLimit, -kSnapLimit, kSnapLimit));
    const double beyond = std::nextafter(limit, 1e9);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double bad : {beyond, -beyond, nan, HUGE_VAL, -HUGE_VAL}) {
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 p(1.0);
            p[axis] = bad;
            CHECK_FALSE(snap(grid, p, q));
        }
    }
    CHECK(q == glm::ivec3(kSnapLimit, -kSnapLimit, kSnapLimit));
}

TEST_CASE("a table lattice has 2^20 units along its plan and along its height") {
    const std::vector<glm::dvec2> plan{{-3.0, 1.0}, {5.0, 2.0}};
    const std::vector<double> z0{10.0, 12.0};
    const std::vector<double> z{-1.0, 0.0, 1.0};
    const SnapGrid grid = snap_grid({.nx = 2, .ny = 1, .nz = 3, .plan = plan, .z0 = z0, .z = z});
    glm::ivec3 q{0};
    REQUIRE(snap(grid, {-3.0, 1.0, 9.0}, q));
    CHECK(q == glm::ivec3(0));
    REQUIRE(snap(grid, {5.0, 9.0, 13.0}, q));
    CHECK(q == glm::ivec3(1 << 20));
}

TEST_CASE("plans and columns without size borrow a length, or take 1") {
    const std::vector<glm::dvec2> point{{2.0, 3.0}};
    const std::vector<double> rising{0.0, 4.0};
    const std::vector<double> flat{7.0};
    CHECK(snap_grid({.nx = 1, .ny = 1, .nz = 2, .plan = point, .z = rising}).length == glm::dvec3(4.0));
    CHECK(snap_grid({.nx = 1, .ny = 1, .nz = 1, .plan = point, .z = flat}).length == glm::dvec3(1.0));
    const std::vector<glm::dvec2> line{{2.0, 3.0}, {2.0, 8.0}};
    CHECK(snap_grid({.nx = 2, .ny = 1, .nz = 1, .plan = line, .z = flat}).length == glm::dvec3(5.0));
}
