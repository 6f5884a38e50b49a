// Crossing lists made by hand: runs, counts, collisions and bits.
#include "voxelizer/crossings.h"

#include <algorithm>
#include <random>
#include <vector>

#include "tests/catch.h"

using namespace xorvox;

namespace {

using Column = std::vector<std::uint16_t>;
using Runs = std::vector<ColumnRun>;

Runs runs_of(const Column& crossings, std::uint32_t nz) {
    Runs room((crossings.size() + 1) / 2);
    const auto filled = column_runs(crossings, nz, room);
    return {filled.begin(), filled.end()};
}

CrossingLists lists(std::uint32_t nx, std::uint32_t ny, std::uint32_t nz, const std::vector<Column>& columns) {
    CrossingLists made{nx, ny, nz, {0}, {}};
    for (const Column& column : columns) {
        made.first_above.insert(made.first_above.end(), column.begin(), column.end());
        made.starts.push_back(made.first_above.size());
    }
    REQUIRE(made.starts.size() == std::size_t{nx} * ny + 1);
    return made;
}

CrossingLists random_lists(std::uint32_t nx, std::uint32_t ny, std::uint32_t nz, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<Column> columns(std::size_t{nx} * ny);
    for (Column& column : columns) {
        column.resize(random() % 7);
        for (std::uint16_t& k : column) k = static_cast<std::uint16_t>(random() % nz);
        std::sort(column.begin(), column.end());
    }
    return lists(nx, ny, nz, columns);
}

/// Straight from the definition: an odd number of crossings at or below the sample.
bool is_inside(const CrossingLists& lists, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    bool inside = false;
    for (const std::uint16_t k : lists.column(x, y)) inside ^= k <= z;
    return inside;
}

BitVolume bits_of(const CrossingLists& lists) {
    BitVolume out(lists.nx, lists.ny, lists.nz);
    for (std::uint64_t& word : out.view().words) word = ~std::uint64_t{0};
    to_bits(lists, out.view());
    return out;
}

}  // namespace

TEST_CASE("a pair of crossings is a run") {
    CHECK(runs_of({3, 17}, 64) == Runs{{3, 17}});
    CHECK(runs_of({0, 1, 4, 6, 7, 63}, 64) == Runs{{0, 1}, {4, 6}, {7, 63}});
}

TEST_CASE("a column without crossings has no runs") {
    CHECK(runs_of({}, 64).empty());
}

TEST_CASE("crossings that cancel give no run") {
    CHECK(runs_of({5, 5}, 64).empty());
    CHECK(runs_of({5, 5, 5, 5}, 64).empty());
    CHECK(runs_of({2, 2, 3, 9}, 64) == Runs{{3, 9}});
    CHECK(runs_of({5, 5, 5}, 8) == Runs{{5, 8}});
}

TEST_CASE("runs that touch are one") {
    CHECK(runs_of({0, 5, 5, 40}, 64) == Runs{{0, 40}});
    CHECK(runs_of({0, 5, 5, 5, 5, 40, 40, 41}, 64) == Runs{{0, 41}});
    CHECK(runs_of({1, 2, 2}, 64) == Runs{{1, 64}});
}

TEST_CASE("the top sample closes a run that is open") {
    CHECK(runs_of({7}, 8) == Runs{{7, 8}});
    CHECK(runs_of({0, 2, 4}, 4096) == Runs{{0, 2}, {4, 4096}});
}

TEST_CASE("the samples inside are counted without a volume") {
    CHECK(count_inside(lists(3, 1, 41, {{3, 17}, {}, {0, 5, 5, 40}})) == 14 + 40);
    CHECK(count_inside(lists(2, 1, 10, {{9}, {4, 4, 4}})) == 1 + 6);
    CHECK(count_inside(lists(2, 2, 10, {{}, {}, {}, {}})) == 0);
}

TEST_CASE("bits are those of the definition, and padding is zero, for rows of every length") {
    for (const std::uint32_t nx : {1u, 63u, 64u, 65u, 130u}) {
        const CrossingLists made = random_lists(nx, 3, 9, nx);
        const BitVolume bits = bits_of(made);
        std::size_t wrong = 0;
        std::uint64_t inside = 0;
        for (std::uint32_t z = 0; z < 9; ++z) {
            for (std::uint32_t y = 0; y < 3; ++y) {
                for (std::uint32_t x = 0; x < nx; ++x) {
                    const bool expected = is_inside(made, x, y, z);
                    inside += expected ? 1u : 0u;
                    wrong += bits.test(x, y, z) != expected ? 1u : 0u;
                }
            }
        }
        CHECK(wrong == 0);
        CHECK(bits.count() == inside);  // No set bit in the padding.
        CHECK(count_inside(made) == inside);
    }
}

TEST_CASE("the first column in which two solids share a sample is found") {
    const CrossingLists a = lists(2, 2, 10, {{0, 4}, {2, 8}, {5, 5}, {6}});
    const auto with_column_3 = [](const Column& column) {
        return lists(2, 2, 10, {{4, 9}, {0, 2, 8, 9}, {5}, column});
    };
    CHECK(first_collision(a, with_column_3({})) == 4);
    CHECK(first_collision(a, with_column_3({0, 6})) == 4);
    CHECK(first_collision(a, with_column_3({0, 7})) == 3);
    CHECK(first_collision(a, with_column_3({9})) == 3);
    CHECK(first_collision(a, with_column_3({9, 9})) == 4);
    CHECK(first_collision(a, lists(2, 2, 10, {{0, 1}, {}, {}, {}})) == 0);
    CHECK(first_collision(a, lists(2, 2, 10, {{}, {7}, {5}, {6}})) == 1);
    CHECK(first_collision(a, a) == 0);
}

TEST_CASE("collisions are those of the bits") {
    for (std::uint32_t seed = 0; seed < 200; ++seed) {
        const CrossingLists a = random_lists(3, 2, 12, 2 * seed);
        const CrossingLists b = random_lists(3, 2, 12, 2 * seed + 1);
        std::size_t expected = 6;
        for (std::uint32_t column = 6; column-- > 0;) {
            for (std::uint32_t z = 0; z < 12; ++z) {
                if (is_inside(a, column % 3, column / 3, z) && is_inside(b, column % 3, column / 3, z))
                    expected = column;
            }
        }
        CHECK(first_collision(a, b) == expected);
    }
}
