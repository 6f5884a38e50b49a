#include "driver/device/phase.h"

#include <random>

#include "tests/catch.h"

using namespace xorvox::device;

TEST_CASE("mul_div is exact, rounded down and up, however large the product") {
    __extension__ using Wide = unsigned __int128;
    std::mt19937_64 random(1);
    for (int i = 0; i < 200'000; ++i) {
        const std::uint64_t a = random() >> (1 + random() % 63);
        const std::uint64_t b = random() >> (1 + random() % 63);
        std::uint64_t c = (random() >> random() % 64) | 1;
        const Wide product = Wide{a} * b;
        if (product / c >> 63 != 0) c |= a;  // now it is b at most
        REQUIRE(mul_div(a, b, c) == static_cast<std::uint64_t>(product / c));
        REQUIRE(mul_div(a, b, c, true) == static_cast<std::uint64_t>((product + c - 1) / c));
    }
    static_assert(mul_div(~std::uint64_t{0}, 7, 7) == ~std::uint64_t{0});
}

TEST_CASE("a phase line comes to a phase exactly when time_of says, and never runs backwards") {
    std::mt19937_64 random(2);
    for (int round = 0; round < 2000; ++round) {
        const std::uint64_t interval = 1 + (random() >> (23 + random() % 40));
        const std::uint64_t step = 65536 + (random() >> (29 + random() % 30));
        const std::uint64_t first = step - step / 8 + random() % (step / 4);
        const PhaseLine line{random() >> 20, random(), interval, first, step};
        REQUIRE(line.at(line.from_ns) == line.phase);
        REQUIRE(line.at(0) == line.phase);
        REQUIRE(line.at(line.from_ns + interval) == line.phase + first);
        REQUIRE(line.at(line.from_ns + 5 * interval) == line.phase + first + 4 * step);
        REQUIRE(line.time_of(line.phase - 1) == line.from_ns);
        for (int i = 0; i < 50; ++i) {
            const Phase to = line.phase + 1 + random() % (3 * step);
            const std::uint64_t time_ns = line.time_of(to);
            REQUIRE(phase_between(to, line.at(time_ns)) >= 0);
            REQUIRE(phase_between(to, line.at(time_ns - 1)) < 0);
        }
    }
}
