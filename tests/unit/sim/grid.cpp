#include "sim/grid.h"

#include <cmath>
#include <cstdint>
#include <random>
#include <set>
#include <tuple>
#include <vector>

#include "tests/catch.h"

namespace xorvox {
namespace {

TEST_CASE("cells keep a margin, and places as even as they are in their middles") {
    const sim::Bounds bounds{{-3.0, 1.0, 0.0}, {97.0, 9.0, 4.0}};
    const sim::Cells cells(bounds, {2.0, 1.0, 0.5}, 1'000'000);
    CHECK(cells.cell_mm() == glm::dvec3(2.0, 1.0, 0.5));
    CHECK(cells.size()[0] == 51 + 12);
    CHECK(cells.size()[1] == 9 + 12);
    CHECK(cells.size()[2] == 9 + 12);
    CHECK(cells.steps_to({-3.0, 1.0, 0.0}) == glm::dvec3(6.5));
    CHECK(cells.steps_to({97.0, 9.0, 4.0}).x == 56.5);
}

TEST_CASE("cells are doubled until there are few enough") {
    const sim::Bounds bounds{glm::dvec3(0.0), glm::dvec3(1000.0)};
    const sim::Cells cells(bounds, glm::dvec3(1.0), 1'000'000);
    CHECK(cells.cell_mm() == glm::dvec3(16.0));
    CHECK(cells.size()[0] * cells.size()[1] * cells.size()[2] <= 1'000'000);
}

TEST_CASE("what is walled in is what has all 26 neighbours, also where rows run over words") {
    using Place = std::tuple<int, int, int>;
    std::mt19937 random(5);
    const int size[3] = {140, 9, 8};
    std::set<Place> set;
    for (int x = 0; x < size[0]; ++x) {
        for (int y = 0; y < size[1]; ++y) {
            for (int z = 0; z < size[2]; ++z) {
                if (random() % 40 != 0) set.insert({x, y, z});
            }
        }
    }
    const sim::Bounds bounds{glm::dvec3(0.0), glm::dvec3(size[0] - 1, size[1] - 1, size[2] - 1)};
    sim::WallGrid walls(sim::Cells(bounds, glm::dvec3(1.0), 1'000'000));
    for (const auto& [x, y, z] : set) walls.set({x, y, z});
    walls.erode();
    std::size_t walled_in = 0;
    for (int x = 0; x < size[0]; ++x) {
        for (int y = 0; y < size[1]; ++y) {
            for (int z = 0; z < size[2]; ++z) {
                bool all = true;
                for (int i = 0; i < 27; ++i)
                    all = all && set.count({x + i % 3 - 1, y + i / 3 % 3 - 1, z + i / 9 - 1}) > 0;
                REQUIRE(walls.test({x, y, z}) == all);
                walled_in += all;
            }
        }
    }
    CHECK(walled_in > 1000);
}

TEST_CASE("density is shared by the cells around a place, and spreads without loss") {
    const sim::Bounds bounds{glm::dvec3(0.0), {8.0, 9.0, 10.0}};
    sim::DensityGrid density(sim::Cells(bounds, glm::dvec3(1.0), 1'000'000));
    density.add({4.0, 5.0, 5.0}, 1.0);
    CHECK(density.at({4.0, 5.0, 5.0}) == Approx(1.0));
    CHECK(density.at({4.5, 5.0, 5.0}) == Approx(0.5));
    density.blur();
    CHECK(density.at({4.0, 5.0, 5.0}) == Approx(1.0 / 8.0));
    CHECK(density.at({3.0, 5.0, 5.0}) == Approx(1.0 / 16.0));
    CHECK(density.at({4.0, 6.0, 4.0}) == Approx(1.0 / 32.0));
    CHECK(density.at({5.0, 6.0, 6.0}) == Approx(1.0 / 64.0));
    density.blur();
    double total = 0.0;
    for (int x = 0; x <= 8; ++x) {
        for (int y = 0; y <= 9; ++y) {
            for (int z = 0; z <= 10; ++z) total += density.at({x, y, z});
        }
    }
    CHECK(total == Approx(1.0));
    density.add({4.0, 5.0, 5.0}, -density.at({4.0, 5.0, 5.0}));
    density.add({4.25, 5.0, 8.0}, 8.0);
    CHECK(density.fall_at({4.0, 5.0, 9.0}).z > 1.0);
    CHECK(density.fall_at({4.0, 5.0, 7.0}).z < -1.0);
}

}  // namespace
}  // namespace xorvox
