#include "voxelizer/io/weld.h"

#include <map>
#include <random>
#include <tuple>

#include "tests/catch.h"

using namespace xorvox;

namespace {

Mesh mesh_of(std::vector<glm::dvec3> positions, std::vector<std::uint32_t> indices) {
    return {std::move(positions), std::move(indices), {}, {}};
}

using List = std::vector<std::uint32_t>;

}  // namespace

TEST_CASE("weld keeps the first of equal vertices and the order of the rest") {
    Mesh mesh = mesh_of({{3, 0, 0}, {1, 0, 0}, {3, 0, 0}, {2, 0, 0}, {1, 0, 0}, {0, 0, 5}}, {0, 1, 3, 2, 4, 5});
    io::weld(mesh);
    CHECK(mesh.positions == std::vector<glm::dvec3>{{3, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 5}});
    CHECK(mesh.indices == List{0, 1, 2, 0, 1, 3});
}

TEST_CASE("weld takes -0 for 0 and keeps the least difference apart") {
    Mesh mesh = mesh_of({{-0.0, 1, -0.0}, {0.0, 1, 0.0}, {5e-324, 1, 0}}, {0, 1, 2});
    io::weld(mesh);
    REQUIRE(mesh.positions.size() == 2);
    CHECK_FALSE(std::signbit(mesh.positions[0].x));
    CHECK(mesh.indices == List{0, 0, 1});
}

TEST_CASE("weld drops vertices that no face uses") {
    Mesh mesh = mesh_of({{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {8, 8, 8}, {0, 1, 0}}, {1, 2, 4});
    io::weld(mesh);
    CHECK(mesh.positions.size() == 3);
    CHECK(mesh.indices == List{0, 1, 2});
}

TEST_CASE("weld agrees with an ordered map on random vertices") {
    std::mt19937 random(4);
    Mesh mesh;
    for (int i = 0; i < 9000; ++i) {
        mesh.positions.emplace_back(random() % 16, -0.125 * static_cast<double>(random() % 16),
                                    1e-9 * static_cast<double>(random() % 16));
        mesh.indices.push_back(static_cast<std::uint32_t>(random() % static_cast<unsigned>(i + 1)));
    }
    const Mesh before = mesh;
    io::weld(mesh);
    std::map<std::tuple<double, double, double>, std::uint32_t> first;
    std::vector<bool> used(before.positions.size());
    for (const std::uint32_t v : before.indices) used[v] = true;
    for (std::size_t v = 0; v < used.size(); ++v) {
        const glm::dvec3 p = before.positions[v] + 0.0;
        if (used[v]) first.try_emplace({p.x, p.y, p.z}, static_cast<std::uint32_t>(first.size()));
    }
    CHECK(mesh.positions.size() == first.size());
    bool same = true;
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const glm::dvec3 p = before.positions[before.indices[i]] + 0.0;
        same = same && mesh.indices[i] == first.at({p.x, p.y, p.z}) && mesh.positions[mesh.indices[i]] == p;
    }
    CHECK(same);
}

TEST_CASE("weld merges vertices of one part only, when there are parts") {
    Mesh mesh = mesh_of({{1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 0, 0}}, {0, 1, 2, 4, 1, 0});
    std::vector<std::uint32_t> parts{0, 7, 0, 0, 7};
    io::weld(mesh, parts);
    CHECK(mesh.positions == std::vector<glm::dvec3>{{1, 0, 0}, {1, 0, 0}});
    CHECK(parts == List{0, 7});
    CHECK(mesh.indices == List{0, 1, 0, 1, 1, 0});
}
