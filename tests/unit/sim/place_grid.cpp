#include "sim/place_grid.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <random>
#include <set>
#include <vector>

#include <glm/geometric.hpp>

#include "tests/catch.h"

namespace xorvox {
namespace {

std::vector<glm::dvec3> cloud(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(-50.0, 50.0);
    std::vector<glm::dvec3> places;
    for (std::size_t i = 0; i < count; ++i) places.emplace_back(place(random), place(random), place(random));
    return places;
}

TEST_CASE("a grid finds the places within a radius, and no others") {
    const std::vector<glm::dvec3> places = cloud(2000, 1);
    sim::PlaceGrid grid(9.0, 10);
    for (const glm::dvec3& place : places) grid.add(place);
    REQUIRE(grid.size() == places.size());
    for (const double radius : {0.0, 3.0, 9.0}) {
        for (std::size_t i = 0; i < 100; ++i) {
            std::set<std::uint32_t> expected;
            for (std::uint32_t n = 0; n < places.size(); ++n) {
                if (glm::distance(places[n], places[i]) <= radius) expected.insert(n);
            }
            std::set<std::uint32_t> found;
            grid.near(places[i], radius, [&](std::uint32_t n, double distance) {
                CHECK(distance == glm::distance(places[n], places[i]));
                found.insert(n);
            });
            CHECK(found == expected);
        }
    }
}

TEST_CASE("the smallest distance is that of the nearest two, whatever their order") {
    std::vector<glm::dvec3> places = cloud(300, 2);
    double expected = std::numeric_limits<double>::infinity();
    for (std::size_t a = 0; a < places.size(); ++a) {
        for (std::size_t b = 0; b < a; ++b) expected = std::min(expected, glm::distance(places[a], places[b]));
    }
    std::mt19937 random(3);
    for (int i = 0; i < 20; ++i) {
        std::shuffle(places.begin(), places.end(), random);
        CHECK(sim::smallest_distance(places, 1e-9) == expected);
    }
}

TEST_CASE("places that are the same have no distance") {
    std::vector<glm::dvec3> places(1000, glm::dvec3(1.0, 2.0, 3.0));
    const double infinity = std::numeric_limits<double>::infinity();
    CHECK(sim::smallest_distance(places, 1e-9) == infinity);
    CHECK(sim::smallest_distance(std::vector{places[0]}, 0.0) == infinity);
    for (int i = 0; i < 1000; ++i) places.emplace_back(4.0, 2.0, 3.0 + 1e-12 * i);
    CHECK(sim::smallest_distance(places, 1e-8) == Approx(3.0));
}

}  // namespace
}  // namespace xorvox
