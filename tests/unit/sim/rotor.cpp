#include "sim/rotor.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/catch.h"
#include "tests/unit/sim/displays.h"

namespace xorvox {
namespace {

using namespace test;
using sim::Rotor;
using sim::RotorConditions;

constexpr std::uint64_t kSecond = 1'000'000'000;

/// 25 turns a second: 40 ms each.
DisplayDescription turning(IndexSource source = IndexSource::Pulses, std::uint32_t pulses = 1, double phase = 0.0) {
    DisplayDescription display = rotor_of(8, 4, 12);
    display.sync = {.index = source, .index_pulses = pulses, .index_phase = phase};
    return display;
}

struct Heard {
    std::vector<std::uint64_t> pulses;
    std::int64_t steps = 0;
    std::vector<std::int64_t> steps_at_pulses;
};

Heard listen(const DisplayDescription& display, const RotorConditions& conditions, std::uint64_t until_ns) {
    Heard heard;
    Rotor rotor(display, conditions);
    std::uint64_t before = 0;
    for (; rotor.next_event().time_ns <= until_ns; rotor.take_event()) {
        const auto [time_ns, steps] = rotor.next_event();
        REQUIRE(time_ns >= before);
        before = time_ns;
        heard.steps += steps;
        if (steps != 0) continue;
        heard.pulses.push_back(time_ns);
        heard.steps_at_pulses.push_back(heard.steps);
    }
    return heard;
}

std::vector<double> intervals_ms(const std::vector<std::uint64_t>& pulses) {
    std::vector<double> all;
    for (std::size_t i = 1; i < pulses.size(); ++i)
        all.push_back(static_cast<double>(pulses[i] - pulses[i - 1]) * 1e-6);
    return all;
}

TEST_CASE("pulses of a perfect rotor come exactly where the description says") {
    using Times = std::vector<std::uint64_t>;
    const auto ms = [](Times times) {
        for (std::uint64_t& time : times) time *= 1'000'000;
        return times;
    };
    CHECK(listen(turning(), {}, kSecond / 10).pulses == ms({0, 40, 80}));
    CHECK(listen(turning(IndexSource::Pulses, 1, 0.25), {}, kSecond / 10).pulses == ms({10, 50, 90}));
    CHECK(listen(turning(IndexSource::Pulses, 4), {}, kSecond / 20).pulses == ms({0, 10, 20, 30, 40, 50}));
    CHECK(listen(turning(IndexSource::Pulses, 2, 0.75), {}, kSecond / 20).pulses == ms({10, 30, 50}));
    CHECK(listen(turning(IndexSource::None), {}, kSecond).pulses.empty());

    DisplayDescription clockwise = turning(IndexSource::Pulses, 2, 0.75);
    clockwise.clockwise = true;
    CHECK(listen(clockwise, {}, kSecond / 20).pulses == ms({10, 30, 50}));

    DisplayDescription halves = turning(IndexSource::Pulses, 1, 0.5);  // A cycle is half a turn, and 40 ms long.
    halves.sweep_deg = 180.0;
    CHECK(listen(halves, {}, kSecond / 10).pulses == ms({20, 100}));

    DisplayDescription helix = helix_of(4, 4, 10, 4);  // 100 cycles, 25 turns a second.
    helix.sync.index = IndexSource::Pulses;
    CHECK(listen(helix, {}, kSecond / 10).pulses == ms({0, 40, 80}));

    DisplayDescription plane = swept_of(4, 4, 10, MotionProfile::Sine);
    plane.cycles_per_second = 20.0;
    plane.sync.index = IndexSource::Pulses;
    CHECK(listen(plane, {}, kSecond / 10).pulses == ms({0, 50, 100}));
}

TEST_CASE("an encoder tells all its steps, and at its mark those before it") {
    const std::uint32_t steps = GENERATE(1u, 7u, 16u, 100u, 4096u);
    const Heard heard = listen(turning(IndexSource::Encoder, steps), {}, kSecond);
    CHECK(heard.steps == 25 * static_cast<std::int64_t>(steps));
    REQUIRE(heard.pulses.size() == 26);
    for (std::size_t turn = 0; turn < heard.pulses.size(); ++turn) {
        CHECK(heard.steps_at_pulses[turn] == static_cast<std::int64_t>(turn * steps));
        CHECK(heard.pulses[turn] == turn * 40'000'000);
    }
}

TEST_CASE("an encoder's mark is at its phase") {
    const Heard heard = listen(turning(IndexSource::Encoder, 100, 0.25), {}, kSecond);
    REQUIRE(heard.pulses.size() == 25);
    CHECK(heard.pulses[0] == 10'000'000);
    CHECK(heard.steps_at_pulses[0] == 25);
    CHECK(heard.steps_at_pulses[1] == 125);
}

TEST_CASE("a perfect rotor is where the time says, in cycles of the description") {
    const Rotor rotor(turning(), {});
    CHECK(rotor.cycles_at(0) == 0.0);
    CHECK(rotor.cycles_at(10'000'000) == Approx(0.25).margin(1e-12));
    CHECK(rotor.cycles_at(3600 * kSecond) == Approx(90'000.0).margin(1e-9));
    CHECK(rotor.cycles_at(1) > 0.0);

    DisplayDescription helix = helix_of(4, 4, 10, 4);
    CHECK(Rotor(helix, {}).cycles_at(kSecond) == Approx(100.0).margin(1e-9));
    DisplayDescription halves = turning();
    halves.sweep_deg = 180.0;
    CHECK(Rotor(halves, {}).cycles_at(kSecond) == Approx(25.0).margin(1e-9));
}

TEST_CASE("without index the device's clock is the master, and what stands cannot jitter") {
    DisplayDescription plane = swept_of(4, 4, 10, MotionProfile::Constant);
    plane.cycles_per_second = 30.0;  // 33333333.3 ns
    const std::uint64_t hour = 3600 * 30 * cycle_ns(plane);
    CHECK(Rotor(plane, {}).cycles_at(hour) == Approx(3600.0 * 30.0).margin(1e-9));
    CHECK(Rotor(stack_of(4, 4, 4), {.speed = 0.5, .jitter = 0.3}).cycles_at(kSecond) == Approx(100.0).margin(1e-9));
}

TEST_CASE("a rotor turns at its speed") {
    const RotorConditions faster{.speed = 1.25};
    CHECK(Rotor(turning(), faster).cycles_at(kSecond) == Approx(31.25));
    CHECK(intervals_ms(listen(turning(), faster, kSecond / 10).pulses) == std::vector{32.0, 32.0, 32.0});
}

TEST_CASE("a rotor spins up from rest at even acceleration") {
    const RotorConditions conditions{.spin_up_s = 2.0};
    const Rotor rotor(turning(), conditions);
    CHECK(rotor.cycles_at(kSecond) == Approx(6.25));
    CHECK(rotor.cycles_at(2 * kSecond) == Approx(25.0));
    CHECK(rotor.cycles_at(3 * kSecond) == Approx(50.0));
    const Heard heard = listen(turning(), conditions, 3 * kSecond);
    REQUIRE(heard.pulses.size() == 51);
    CHECK(heard.pulses[1] == 400'000'000);  // 6.25 t² = 1
    CHECK(heard.pulses[4] == 800'000'000);
    CHECK(heard.pulses[50] == 3 * kSecond);
}

TEST_CASE("a rotor that grows slower stands in the end, and is heard no more") {
    const RotorConditions conditions{.acceleration = -0.5};
    const Rotor rotor(turning(), conditions);
    CHECK(rotor.cycles_at(kSecond) == Approx(25.0 * 0.75));
    CHECK(rotor.cycles_at(2 * kSecond) == Approx(25.0));
    CHECK(rotor.cycles_at(1000 * kSecond) == rotor.cycles_at(3 * kSecond));
    CHECK(listen(turning(), conditions, Rotor::kNever - 1).pulses.size() >= 25);

    const Rotor grows(turning(), {.acceleration = 0.5});
    CHECK(grows.cycles_at(kSecond) == Approx(25.0 * 1.25));
}

TEST_CASE("with jitter turns are longer and shorter, by no more than that, and evenly so") {
    const RotorConditions conditions{.jitter = 0.1, .seed = 5};
    const std::vector<double> lengths = intervals_ms(listen(turning(), conditions, 40 * kSecond).pulses);
    REQUIRE(lengths.size() > 900);
    const auto [least, most] = std::minmax_element(lengths.begin(), lengths.end());
    CHECK(*least >= 36.0 - 1e-5);
    CHECK(*least < 36.2);
    CHECK(*most <= 44.0 + 1e-5);
    CHECK(*most > 43.8);
    double sum = 0.0;
    for (const double length : lengths) sum += length;
    CHECK(sum / static_cast<double>(lengths.size()) == Approx(40.0).margin(0.3));
}

TEST_CASE("a rotor is where its pulses are, whatever its conditions") {
    const RotorConditions conditions =
        GENERATE(RotorConditions{.jitter = 0.3}, RotorConditions{.spin_up_s = 1.5, .jitter = 0.2},
                 RotorConditions{.acceleration = -0.3, .jitter = 0.2}, RotorConditions{.acceleration = 0.7});
    const DisplayDescription display = turning(IndexSource::Pulses, 4, 0.5);
    const Rotor rotor(display, conditions);
    const Heard heard = listen(display, conditions, 3 * kSecond);
    REQUIRE(heard.pulses.size() > 100);
    for (std::size_t i = heard.pulses.size(); i-- > 0;) {  // Backwards, too.
        REQUIRE(rotor.cycles_at(heard.pulses[i]) == Approx(0.25 * static_cast<double>(i)).margin(2e-7));
    }
    double before = 0.0;
    for (std::uint64_t time = 0; time < 4 * kSecond; time += 777'777) {
        const double now = rotor.cycles_at(time);
        REQUIRE(now >= before);
        REQUIRE(now - before < 0.15);
        before = now;
    }
}

TEST_CASE("as many pulses are missed and doubled as was asked for") {
    const std::size_t perfect = listen(turning(), {}, 40 * kSecond).pulses.size();
    const auto part = [&](const RotorConditions& conditions) {
        const std::size_t heard = listen(turning(), conditions, 40 * kSecond).pulses.size();
        return static_cast<double>(heard) / static_cast<double>(perfect);
    };
    CHECK(part({.missed = 0.2}) == Approx(0.8).margin(0.05));
    CHECK(part({.doubled = 0.2}) == Approx(1.2).margin(0.05));
    CHECK(part({.missed = 1.0}) == 0.0);
    CHECK(part({.doubled = 1.0}) > 1.99);
}

TEST_CASE("a doubled pulse comes within a fifth of the way to the next") {
    const std::vector<double> gaps =
        intervals_ms(listen(turning(IndexSource::Pulses, 2), {.doubled = 1.0}, 10 * kSecond).pulses);
    for (std::size_t i = 0; i < gaps.size(); i += 2) {
        REQUIRE(gaps[i] > 0.0);
        REQUIRE(gaps[i] <= 4.0);
    }
    CHECK(*std::max_element(gaps.begin(), gaps.end()) < 20.0);
}

TEST_CASE("noise moves edges, by no more than that, and the rotor not at all") {
    const RotorConditions conditions{.noise = 0.05};
    const std::vector<std::uint64_t> pulses = listen(turning(), conditions, 10 * kSecond).pulses;
    double worst = 0.0;
    for (std::size_t i = 0; i < pulses.size(); ++i) {
        const double off_ms = static_cast<double>(pulses[i]) * 1e-6 - 40.0 * static_cast<double>(i);
        REQUIRE(std::abs(off_ms) <= 2.0 + 1e-6);
        worst = std::max(worst, std::abs(off_ms));
    }
    CHECK(worst > 1.9);
    CHECK(Rotor(turning(), conditions).cycles_at(10 * kSecond) == Approx(250.0));
    // More than the way to the next would change their order.
    const std::vector<double> gaps =
        intervals_ms(listen(turning(IndexSource::Pulses, 8), {.doubled = 1.0, .noise = 0.5}, 10 * kSecond).pulses);
    CHECK(*std::min_element(gaps.begin(), gaps.end()) >= 0.0);
}

TEST_CASE("an encoder's mark is missed, doubled and noisy; its steps are not") {
    const DisplayDescription display = turning(IndexSource::Encoder, 100);
    const Heard missed = listen(display, {.missed = 0.5}, 10 * kSecond);
    CHECK(missed.steps == Approx(25'000).margin(6));
    CHECK(missed.pulses.size() == Approx(125).margin(30));
    const Heard doubled = listen(display, {.doubled = 1.0}, 10 * kSecond);
    CHECK(doubled.steps == Approx(25'000).margin(6));
    CHECK(doubled.pulses.size() == 501);
    const Heard noisy = listen(display, {.noise = 0.1}, 10 * kSecond);
    CHECK(noisy.steps == Approx(25'000).margin(6));  // Those since the last report are not told yet.
    std::int64_t worst = 0;
    for (std::size_t i = 1; i < noisy.steps_at_pulses.size(); ++i) {
        worst = std::max(worst, std::abs(noisy.steps_at_pulses[i] - 100 * static_cast<std::int64_t>(i)));
    }
    CHECK(worst >= 8);
    CHECK(worst <= 10);
}

TEST_CASE("a rotor that stalls stands at once, and is heard no more") {
    const RotorConditions conditions{.jitter = 0.1, .doubled = 1.0, .noise = 0.1, .stall_s = 0.5};
    const Rotor rotor(turning(), conditions);
    CHECK(rotor.cycles_at(kSecond / 2) > 10.0);
    CHECK(rotor.cycles_at(kSecond / 2) == rotor.cycles_at(Rotor::kNever));
    const Heard heard = listen(turning(), conditions, Rotor::kNever - 1);
    CHECK(heard.pulses.back() <= kSecond / 2);
    CHECK(listen(turning(), {.stall_s = 0.5}, Rotor::kNever - 1).pulses.size() == 13);
    CHECK(listen(turning(), {.stall_s = -1.0}, Rotor::kNever - 1).pulses.size() == 1);
}

TEST_CASE("conditions out of their range are taken to its end") {
    CHECK(Rotor(turning(), {.speed = -3.0}).cycles_at(kSecond) == Approx(0.025));
    CHECK(Rotor(turning(), {.speed = 1e9}).cycles_at(kSecond) == Approx(25'000.0));
    const std::vector<double> lengths = intervals_ms(listen(turning(), {.jitter = 7.0}, 10 * kSecond).pulses);
    CHECK(*std::max_element(lengths.begin(), lengths.end()) <= 60.0);
}

TEST_CASE("the same seed gives the same pulses on every machine, another one others") {
    const auto heard = [](std::uint64_t seed) {
        const RotorConditions conditions{.jitter = 0.2, .missed = 0.1, .doubled = 0.1, .noise = 0.02, .seed = seed};
        return listen(turning(IndexSource::Pulses, 3), conditions, kSecond).pulses;
    };
    CHECK(heard(1) == heard(1));
    CHECK(heard(1) != heard(2));
    const std::vector<std::uint64_t> pulses = heard(7);
    REQUIRE(pulses.size() > 6);
    CHECK(std::vector(pulses.begin(), pulses.begin() + 6) ==
          std::vector<std::uint64_t>{53'692, 12'623'120, 25'697'905, 38'677'163, 48'929'053, 59'577'976});
}

}  // namespace
}  // namespace xorvox
