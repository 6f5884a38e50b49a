#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include <glm/geometric.hpp>

#include "tests/catch.h"
#include "tests/unit/voxelizer/meshes.h"
#include "voxelizer/nearest_surface.h"

using namespace xorvox;

namespace {

bool same(const SurfacePoint& a, const SurfacePoint& b) {
    return a.face == b.face && a.corners == b.corners && a.weights == b.weights &&
           a.distance_squared == b.distance_squared;
}

glm::dvec3 position(const Mesh& mesh, const SurfacePoint& place) {
    glm::dvec3 sum(0.0);
    for (int i = 0; i < 3; ++i) {
        sum += place.weights[i] * mesh.positions[mesh.indices[place.corners[static_cast<std::size_t>(i)]]];
    }
    return sum;
}

/// Points in and around the cube from -1 to 1, walked through in steps as a display's rows are.
std::vector<glm::dvec3> walk(unsigned seed, std::size_t count) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-1.5, 1.5);
    std::vector<glm::dvec3> points;
    while (points.size() < count) {
        const glm::dvec3 begin(any(random), any(random), any(random));
        for (int i = 0; i < 16 && points.size() < count; ++i) points.push_back(begin + glm::dvec3(0.05 * i, 0, 0));
    }
    return points;
}

/// `count` triangles of a size about `size` in the cube from -1 to 1; some are degenerate, some there twice.
Mesh soup(unsigned seed, std::size_t count, double size) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    const auto vector = [&] { return glm::dvec3(any(random), any(random), any(random)); };
    Mesh mesh;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 a = vector();
        const glm::dvec3 along = size * vector();
        switch (i % 8) {
            case 0: test::add_triangle(mesh, a, a, a); break;
            case 1: test::add_triangle(mesh, a, a + along, a); break;
            case 2: test::add_triangle(mesh, a, a + along, a - 0.3 * along); break;
            case 3: test::add_triangle(mesh, a, a + along, a + 0.4 * along + 1e-7 * vector()); break;
            default: test::add_triangle(mesh, a, a + along, a + size * vector()); break;
        }
        if (i % 5 == 0) {
            const auto last = std::vector(mesh.indices.end() - 3, mesh.indices.end());
            mesh.indices.insert(mesh.indices.end(), last.begin(), last.end());
        }
    }
    return mesh;
}

void check_against_all(const Mesh& mesh, const NearestSurface& surface, const std::vector<glm::dvec3>& points) {
    std::vector<SurfacePoint> places(points.size());
    surface.nearest(points, places);
    for (std::size_t i = 0; i < points.size(); ++i) {
        INFO("point " << i);
        REQUIRE(same(places[i], surface.nearest_of_all(points[i])));
        const auto& w = places[i].weights;
        REQUIRE(std::min({w.x, w.y, w.z}) >= 0.0);
        REQUIRE(std::abs(w.x + w.y + w.z - 1.0) < 1e-15);
        REQUIRE(glm::distance(points[i], position(mesh, places[i])) ==
                Approx(std::sqrt(places[i].distance_squared)).margin(1e-12));
    }
}

}  // namespace

TEST_CASE("the nearest place of a triangle is inside, on a side or at a corner") {
    Mesh mesh;
    test::add_triangle(mesh, {0, 0, 0}, {4, 0, 0}, {0, 4, 0});
    const NearestSurface surface(mesh.view());
    const struct {
        glm::dvec3 point, weights;
        double distance_squared;
    } cases[] = {{{1, 1, 3}, {0.5, 0.25, 0.25}, 9.0}, {{-1, -2, 0}, {1, 0, 0}, 5.0},
                 {{6, -1, 0}, {0, 1, 0}, 5.0},        {{-1, 5, 1}, {0, 0, 1}, 3.0},
                 {{2, -2, 0}, {0.5, 0.5, 0}, 4.0},    {{-3, 1, 4}, {0.75, 0, 0.25}, 25.0},
                 {{4, 4, 0}, {0, 0.5, 0.5}, 8.0},     {{1, 0, 0}, {0.75, 0.25, 0}, 0.0}};
    for (const auto& c : cases) {
        SurfacePoint place;
        surface.nearest({&c.point, 1}, {&place, 1});
        CHECK(place.weights == c.weights);
        CHECK(place.distance_squared == c.distance_squared);
        CHECK(place.face == 0);
        CHECK(place.corners == std::array<std::uint32_t, 3>{0, 1, 2});
    }
}

TEST_CASE("no place of the surface is nearer than the one that is found") {
    const Mesh mesh = soup(1, 60, 0.5);
    const NearestSurface surface(mesh.view());
    std::mt19937 random(2);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    for (const glm::dvec3& point : walk(3, 300)) {
        const double found = std::sqrt(surface.nearest_of_all(point).distance_squared);
        for (int i = 0; i < 400; ++i) {
            const std::size_t triangle = random() % (mesh.indices.size() / 3);
            double v = share(random);
            double w = share(random);
            if (v + w > 1.0) v = 1.0 - v, w = 1.0 - w;
            const auto corner = [&](std::size_t c) { return mesh.positions[mesh.indices[3 * triangle + c]]; };
            const glm::dvec3 place = (1.0 - v - w) * corner(0) + v * corner(1) + w * corner(2);
            REQUIRE(found <= glm::distance(point, place) + 1e-12);
        }
    }
}

TEST_CASE("the tree finds what a look at all triangles finds, degenerate ones and doubles included") {
    for (const std::size_t count : {1u, 2u, 5u, 6u, 19u, 20u, 21u, 333u, 2000u}) {
        INFO(count << " triangles");
        const Mesh mesh = soup(static_cast<unsigned>(count), count, count < 100 ? 1.0 : 0.1);
        const NearestSurface surface(mesh.view());
        check_against_all(mesh, surface, walk(4, 800));
        // Corners, and places between them, are at distance 0 from several triangles.
        std::vector<glm::dvec3> corners(
            mesh.positions.begin(),
            mesh.positions.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(mesh.positions.size(), 300)));
        check_against_all(mesh, surface, corners);
    }
}

TEST_CASE("of places at the same distance the lowest face's counts") {
    const Mesh box = test::box_mesh({-1, -1, -1}, {1, 1, 1});
    const NearestSurface surface(box.view());
    const glm::dvec3 middle(0.0);
    SurfacePoint place;
    surface.nearest({&middle, 1}, {&place, 1});
    CHECK(place.face == 0);
    std::vector<glm::dvec3> points;
    for (int x = -4; x <= 4; ++x) {
        for (int y = -4; y <= 4; ++y) {
            for (int z = -4; z <= 4; ++z) points.push_back(glm::dvec3(x, y, z) / 2.0);
        }
    }
    check_against_all(box, surface, points);
    std::vector<SurfacePoint> forward(points.size());
    surface.nearest(points, forward);
    std::reverse(points.begin(), points.end());
    std::vector<SurfacePoint> backward(points.size());
    surface.nearest(points, backward);
    for (std::size_t i = 0; i < points.size(); ++i) REQUIRE(same(forward[i], backward[points.size() - 1 - i]));
}

TEST_CASE("a polygon is found by its fan, and its corners are entries of the indices") {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {9, 0, 0}, {9, 1, 0}, {8, 0, 0}};
    mesh.indices = {4, 5, 6, 0, 1, 2, 3};
    mesh.ring_starts = {0, 3, 7};
    const NearestSurface surface(mesh.view());
    const glm::dvec3 points[] = {{1, 3, 1}, {3, 1, 1}, {8.5, 0.25, 1}};
    SurfacePoint places[3];
    surface.nearest(points, places);
    CHECK(places[0].face == 1);
    CHECK(places[0].corners == std::array<std::uint32_t, 3>{3, 5, 6});
    CHECK(places[1].corners == std::array<std::uint32_t, 3>{3, 4, 5});
    CHECK(places[2].face == 0);
    CHECK(places[2].corners == std::array<std::uint32_t, 3>{0, 1, 2});
}

TEST_CASE("a mesh that moves is found where it is") {
    Mesh mesh = soup(9, 700, 0.2);
    NearestSurface surface(mesh.view());
    std::mt19937 random(10);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    for (int step = 0; step < 4; ++step) {
        for (glm::dvec3& p : mesh.positions) {
            // Turned, stretched and moved; at the end scattered.
            p = step < 3 ? glm::dvec3(0.6 * p.x - 0.8 * p.y, 0.8 * p.x + 0.6 * p.y, 1.1 * p.z + 0.1)
                         : glm::dvec3(any(random), any(random), any(random));
        }
        surface.set_positions(mesh.positions);
        check_against_all(mesh, surface, walk(static_cast<unsigned>(step), 400));
        CHECK(
            same(surface.nearest_of_all({0.1, 0.2, 0.3}), NearestSurface(mesh.view()).nearest_of_all({0.1, 0.2, 0.3})));
    }
}

TEST_CASE("far from the origin, and far from the mesh, the nearest place is found") {
    for (const double scale : {1e-6, 1.0, 1e6}) {
        Mesh mesh = soup(11, 300, 0.3);
        for (glm::dvec3& p : mesh.positions) p = scale * p + glm::dvec3(1e5, -3e4, 7.0);
        const NearestSurface surface(mesh.view());
        std::vector<glm::dvec3> points = walk(12, 300);
        for (glm::dvec3& p : points) p = scale * p + glm::dvec3(1e5, -3e4, 7.0);
        for (std::size_t i = 0; i < 100; ++i) points.push_back(1e7 * points[i]);
        std::vector<SurfacePoint> places(points.size());
        surface.nearest(points, places);
        for (std::size_t i = 0; i < points.size(); ++i) REQUIRE(same(places[i], surface.nearest_of_all(points[i])));
    }
}

TEST_CASE("a mesh without triangles has no surface") {
    CHECK(NearestSurface(MeshView{}).empty());
}
