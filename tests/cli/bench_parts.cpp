// What the numbers of `xorvox bench` are made of.
#include <vector>

#include "sim/canvas.h"
#include "tests/catch.h"
#include "tools/bench/floor.h"
#include "tools/bench/race.h"
#include "tools/bench/result.h"
#include "tools/bench/surface.h"

using namespace xorvox;
using namespace xorvox::tools;

TEST_CASE("the median is the middle number, or between the two in the middle", "[cli]") {
    CHECK(median({}) == 0.0);
    CHECK(median({3.0, 1.0, 100.0}) == 3.0);
    CHECK(median({4.0, 1.0, 2.0, 100.0}) == 3.0);
}

TEST_CASE("a race gives all their runs, in rounds", "[cli]") {
    std::vector<int> order;
    std::vector<Runner> runners;
    for (int i = 0; i < 2; ++i) runners.emplace_back([&order, i] { order.push_back(i); });
    race(runners, Pace{.least_runs = 2, .most_runs = 3, .budget_ms = 1e9});
    CHECK(runners[0].runs_ms.size() == 3);
    CHECK(runners[1].runs_ms.size() == 3);
    REQUIRE(order.size() == 2 * (2 + 3));  // two warm-ups each
    CHECK(std::vector<int>(order.end() - 6, order.end()) == std::vector<int>{0, 1, 0, 1, 0, 1});

    Runner slow([] {});
    race({&slow, 1}, Pace{.least_runs = 5, .most_runs = 9, .budget_ms = 0.0});
    CHECK(slow.runs_ms.size() == 5);
}

TEST_CASE("the floor's pass over a volume adds each layer to the next, mod 2", "[cli]") {
    for (const std::uint32_t ny : {1u, 2u, 3u, 5u}) {
        BitVolume volume(70, ny, 4);
        volume.view().flip(69, 0, 0);
        volume.view().flip(3, ny - 1, 1);
        volume.view().flip(69, 0, 3);
        xor_layers(volume.view());
        for (std::uint32_t z = 0; z < 4; ++z) {
            CHECK(volume.test(69, 0, z) == (z < 3));
            CHECK(volume.test(3, ny - 1, z) == (z >= 1));
        }
        CHECK(volume.count() == 6);
        clear(volume.view());
        CHECK(volume.count() == 0);
    }
}

TEST_CASE("the floor's pass over a mesh reads every corner", "[cli]") {
    Mesh mesh;
    for (int i = 0; i < 7; ++i) mesh.positions.emplace_back(1.5 * i, 2.5 * i, -3.5 * i);
    mesh.indices = {0, 1, 2, 2, 3, 4, 4, 5, 6};
    const std::uint64_t before = read_corners(mesh.view());
    for (const std::size_t vertex : {0u, 1u, 3u, 5u, 6u}) {  // 2 and 4 are read twice and cancel
        for (int axis = 0; axis < 3; ++axis) {
            Mesh moved = mesh;
            moved.positions[vertex][axis] += 1.0;
            CHECK(read_corners(moved.view()) != before);
        }
    }
}

TEST_CASE("surface voxels are those with a neighbour that is not inside", "[cli]") {
    struct Extent {
        std::uint32_t begin;
        std::uint32_t end;
    };
    for (const Extent x : {Extent{60, 130}, {0, 65}, {63, 128}, {64, 129}}) {  // the volume ends at 130, words at 64
        CAPTURE(x.begin, x.end);
        BitVolume volume(130, 7, 6);
        for (std::uint32_t z = 1; z < 5; ++z) {
            for (std::uint32_t y = 1; y < 6; ++y) {
                for (std::uint32_t i = x.begin; i < x.end; ++i) volume.view().flip(i, y, z);
            }
        }
        const std::size_t length = x.end - x.begin;
        const std::size_t shell = length * 5 * 4 - (length - 2) * 3 * 2;
        CHECK(count_surface(volume.view()) == shell);
        volume.view().flip(x.begin + 30, 3, 2);
        CHECK(count_surface(volume.view()) == shell + 5);  // of the hole's neighbours, one already was
    }
}

TEST_CASE("a broken line ends, and is as long drawn as left out, whatever its corners", "[cli]") {
    constexpr double kDashes[] = {9.0, 6.0};
    for (int i = 1; i <= 300; ++i) {
        const glm::dvec2 points[] = {{5.0, 5.5}, {5.0 + 1.37 * i, 5.5}, {450.0, 5.5}};
        sim::Canvas canvas(460, 11, {255, 255, 255});
        canvas.line(points, 1.0, {0, 0, 0}, kDashes);
        std::size_t ink = 0;
        for (std::size_t x = 0; x < 460; ++x) ink += canvas.image().rgb[3 * (5 * 460 + x)] < 128 ? 1u : 0u;
        CHECK(ink > 445 * 9 / 15);
        CHECK(ink < 445 * 9 / 15 + 60);  // round ends
    }
}

TEST_CASE("a chart of one result is drawn like one of many", "[cli]") {
    const BenchResult one{.model = "gem24",
                          .triangles = 24,
                          .size = 64,
                          .method = "column",
                          .kernel = "scalar",
                          .runs = 3,
                          .ms = 0.5,
                          .phases = {},
                          .floor = {},
                          .crossings = 7,
                          .set = 9,
                          .surface = 0};  // an empty volume has none
    const sim::Image image = bench_chart({&one, 1});
    CHECK(image.rgb.size() == std::size_t{3} * image.width * image.height);
    std::vector<BenchResult> many(40, one);
    for (std::size_t i = 0; i < many.size(); ++i) {
        many[i].model = "a rather long name of a model, number " + std::to_string(i);
        many[i].surface = i;
    }
    CHECK(bench_chart(many).height > image.height);  // for the legend
}
