// voxelize_solid on lattices given by tables, against the oracle.

#include <cmath>
#include <numbers>

#include "meshes.h"
#include "oracle.h"
#include "tables.h"
#include "tests/catch.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

/// Two panels back to back on a rotor: LED columns at radii offset, offset + 1, … in `slices` directions.
Tables rotor(std::uint32_t radii, std::uint32_t slices, double offset) {
    Tables t{.nx = 2 * radii, .ny = slices};
    for (std::uint32_t s = 0; s < slices; ++s) {
        for (std::uint32_t column = 0; column < t.nx; ++column) {
            const double r = (column % radii + offset) * (column < radii ? 1.0 : -1.0);
            const double angle = 2.0 * std::numbers::pi * s / slices;
            t.plan.emplace_back(r * std::cos(angle), r * std::sin(angle));
        }
    }
    return t;
}

std::vector<double> even(std::uint32_t n, double first, double pitch) {
    std::vector<double> z;
    for (std::uint32_t k = 0; k < n; ++k) z.push_back(first + k * pitch);
    return z;
}

void check_against_oracle(const Tables& tables, const Mesh& mesh) {
    const BitVolume got = voxelized(mesh.view(), tables.view());
    CHECK(difference(got, oracle(mesh.view(), tables.view(), Ray::Z)) == "");
    CHECK(difference(got, oracle(mesh.view(), tables.view(), Ray::X)) == "");
}

}  // namespace

TEST_CASE("a rotating panel gets the oracle's bits") {
    Tables t = rotor(7, 25, 0.5);
    t.z = even(6, -5.0, 2.0);
    for (unsigned seed = 0; seed < 6; ++seed) {
        IntegerPoints points(seed, glm::ivec3(-8, -8, -7), glm::ivec3(8, 8, 7));
        check_against_oracle(t, tetrahedra(points, 6));
    }
}

TEST_CASE("columns at one place get the same bits") {
    Tables t = rotor(5, 16, 0.0);  // Radius 0: 32 columns on the axis.
    t.z = even(7, -3.0, 1.0);
    IntegerPoints points(1, glm::ivec3(-5), glm::ivec3(5));
    const Mesh mesh = tetrahedra(points, 9);
    check_against_oracle(t, mesh);
    const BitVolume got = voxelized(mesh.view(), t.view());
    for (std::uint32_t y = 0; y < t.ny; ++y) {
        for (std::uint32_t k = 0; k < 7; ++k) {
            CHECK(got.test(0, y, k) == got.test(0, 0, k));
            CHECK(got.test(5, y, k) == got.test(0, 0, k));
        }
    }
}

TEST_CASE("uneven layers, as of a crank, get the oracle's bits") {
    Tables t = rotor(4, 9, 1.0);
    for (int k = 0; k < 21; ++k) t.z.push_back(-6.0 * std::cos(std::numbers::pi * k / 20.0));
    IntegerPoints points(2, glm::ivec3(-5, -5, -6), glm::ivec3(5, 5, 6));
    check_against_oracle(t, tetrahedra(points, 12));
}

TEST_CASE("layers at whole heights tie with faces at those heights") {
    Tables t{.nx = 4, .ny = 4, .z = {0.0, 1.0, 3.0, 4.0, 8.0}};
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 4; ++x) t.plan.emplace_back(x * x, y);  // Longest side 9: units are no binary fractions.
    }
    const Mesh mesh = box_mesh({0, 0, 1}, {4, 3, 4});
    const BitVolume got = voxelized(mesh.view(), t.view());
    CHECK(got.count() == 2 * 3 * 2);
    CHECK(got.test(1, 2, 1));
    CHECK_FALSE(got.test(1, 2, 3));
    check_against_oracle(t, mesh);
}

TEST_CASE("a helix, whose columns start at different heights, gets the oracle's bits") {
    Tables t = rotor(5, 24, 1.0);
    for (std::uint32_t y = 0; y < t.ny; ++y) {
        for (std::uint32_t x = 0; x < t.nx; ++x) t.z0.push_back(10.0 * y / t.ny);
    }
    t.z = even(5, -8.0, 1.0);
    IntegerPoints points(3, glm::ivec3(-6, -6, -9), glm::ivec3(6, 6, 7));
    check_against_oracle(t, tetrahedra(points, 9));
}

TEST_CASE("free points, columns of one sample, get the oracle's bits") {
    Tables t{.nx = 150, .ny = 1, .z = {0.0}};
    IntegerPoints points(4, glm::ivec3(-6), glm::ivec3(6));
    for (int i = 0; i < 150; ++i) {
        const glm::dvec3 p = points();
        t.plan.emplace_back(p.x, p.y);
        t.z0.push_back(p.z);
    }
    check_against_oracle(t, tetrahedra(points, 12));
}

TEST_CASE("plans without width or depth are voxelized like others") {
    IntegerPoints points(5, glm::ivec3(-3), glm::ivec3(3));
    const Mesh mesh = tetrahedra(points, 12);
    const Tables one_column{.nx = 1, .ny = 1, .plan = {{0.0, 0.0}}, .z = {-2.0, -1.0, 0.0, 1.0}};
    check_against_oracle(one_column, mesh);
    const Tables one_point{.nx = 1, .ny = 1, .plan = {{0.0, 0.0}}, .z = {0.0}};
    check_against_oracle(one_point, mesh);
    const Tables same_point{.nx = 3, .ny = 1, .plan = {{1.0, 1.0}, {1.0, 1.0}, {1.0, 1.0}}, .z = {1.0}};
    check_against_oracle(same_point, mesh);
    Tables line{.nx = 1, .ny = 7, .z = {-1.0, 0.0, 1.0}};
    for (int i = -3; i <= 3; ++i) line.plan.emplace_back(0.0, i);
    check_against_oracle(line, mesh);
    Tables layer = rotor(4, 12, 0.5);
    layer.z = {0.0};
    check_against_oracle(layer, mesh);
}

TEST_CASE("a regular lattice written as tables has the same bits") {
    // 2^m + 1 samples over whole units: both snapping grids then hold the mesh's coordinates exactly.
    const glm::uvec3 n{17, 9, 17};
    Tables t{.nx = n.x, .ny = n.y, .z = even(n.z, 0.0, 1.0)};
    for (std::uint32_t y = 0; y < n.y; ++y) {
        for (std::uint32_t x = 0; x < n.x; ++x) t.plan.emplace_back(x, y);
    }
    for (unsigned seed = 20; seed < 30; ++seed) {
        IntegerPoints points(seed, glm::ivec3(-10), glm::ivec3(80));
        const Mesh mesh = tetrahedra(points, 10, glm::dvec3(0.25));
        CHECK(difference(voxelized(mesh.view(), t.view()), voxelized(mesh.view(), integer_lattice(n))) == "");
    }
}

TEST_CASE("rows of a table lattice keep their padding clear") {
    Tables t{.nx = 67, .ny = 3, .z = even(5, 0.0, 1.0)};
    for (int i = 0; i < 3 * 67; ++i) t.plan.emplace_back(i % 67, i / 67);
    const BitVolume got = voxelized(box_mesh(glm::dvec3(-1.0), glm::dvec3(99.0)).view(), t.view());
    CHECK(got.count() == 67 * 3 * 5);
    for (std::uint32_t k = 0; k < 5; ++k) {
        for (std::uint32_t y = 0; y < 3; ++y) CHECK(got.view().row(y, k)[1] == 7);
    }
}

TEST_CASE("on tables too, faces beyond 64-bit range are exact") {
    Tables t = rotor(5, 12, 0.5);
    t.z = even(6, -3.0, 1.0);
    for (unsigned seed = 40; seed < 50; ++seed) {
        IntegerPoints points(seed, glm::ivec3(-4'000), glm::ivec3(4'000));
        check_against_oracle(t, tetrahedra(points, 6));
    }
}
