#include "voxelizer/fit.h"

#include <limits>

#include "meshes.h"
#include "oracle.h"
#include "tests/catch.h"

using namespace xorvox;
using namespace xorvox::test;

TEST_CASE("bounds hold the vertices that faces use and no others") {
    Mesh mesh = box_mesh({1.0, 2.0, 3.0}, {4.0, 6.0, 8.0});
    mesh.positions.emplace_back(1e9, std::numeric_limits<double>::quiet_NaN(), 0.0);
    const Expected<Box> box = bounds(mesh.view());
    REQUIRE(box);
    CHECK(box->lower == glm::dvec3(1.0, 2.0, 3.0));
    CHECK(box->upper == glm::dvec3(4.0, 6.0, 8.0));
}

TEST_CASE("bounds refuse a mesh without faces and vertices that are no numbers") {
    const Expected<Box> none = bounds(MeshView{});
    REQUIRE_FALSE(none);
    CHECK_THAT(none.error().message, Catch::Matchers::Contains("no faces"));
    Mesh mesh = box_mesh({1.0, 2.0, 3.0}, {4.0, 6.0, 8.0});
    mesh.positions[9].y = std::numeric_limits<double>::infinity();
    const Expected<Box> bad = bounds(mesh.view());
    REQUIRE_FALSE(bad);
    CHECK_THAT(bad.error().message, Catch::Matchers::Contains("vertex 9"));
    CHECK_THAT(bad.error().message, Catch::Matchers::Contains("inf"));
}

TEST_CASE("a fitted cube has a margin of a 64th of the longest side on either side") {
    for (const std::uint32_t n : {1u, 8u, 64u, 100u, 4096u}) {
        const Expected<Lattice> lattice = fit_cube({{0.0, 10.0, -1.0}, {64.0, 20.0, 1.0}}, n);
        REQUIRE(lattice);
        CHECK(lattice->nx == n);
        CHECK(lattice->ny == n);
        CHECK(lattice->nz == n);
        CHECK(lattice->pitch == glm::dvec3(66.0 / n));
        CHECK(lattice->origin == glm::dvec3(-1.0, -18.0, -33.0));
    }
}

TEST_CASE("a cube fitted with 33 samples a side has all its faces on samples") {
    const Mesh mesh = box_mesh(glm::dvec3(0.0), glm::dvec3(32.0));
    const BitVolume got = voxelized(mesh.view(), *fit_cube(*bounds(mesh.view()), 33));
    CHECK(got.count() == 32 * 32 * 32);
    CHECK(got.test(0, 0, 0));
    CHECK_FALSE(got.test(32, 0, 0));
}

TEST_CASE("a flat mesh can be fitted, one of no size cannot") {
    CHECK(fit_cube({{0.0, 0.0, 5.0}, {1.0, 2.0, 5.0}}, 8));
    const Expected<Lattice> point = fit_cube({{1.0, 2.0, 3.0}, {1.0, 2.0, 3.0}}, 8);
    REQUIRE_FALSE(point);
    CHECK_THAT(point.error().message, Catch::Matchers::Contains("(1, 2, 3)"));
}

TEST_CASE("numbers of samples out of range and boxes beyond double are refused") {
    const Box box{glm::dvec3(0.0), glm::dvec3(1.0)};
    CHECK_FALSE(fit_cube(box, 0));
    CHECK_FALSE(fit_cube(box, 4097));
    CHECK_FALSE(fit_cube({glm::dvec3(-1.5e308), glm::dvec3(1.5e308)}, 8));
}
