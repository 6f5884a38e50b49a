// A stream that keeps up: even intervals, whatever the producer and the display do.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "tests/catch.h"
#include "tests/unit/session/stream_rig.h"

namespace xorvox::host {
namespace {

using Intervals = std::vector<std::uint64_t>;

/// Boundaries that passed from one picture to the next.
std::vector<std::ptrdiff_t> cycles_between(const StreamRig& rig, std::size_t from) {
    std::vector<std::ptrdiff_t> cycles;
    const auto place = [&](const StreamRig::Shown& frame) {
        return std::lower_bound(rig.boundaries.begin(), rig.boundaries.end(), frame.boundary_ns);
    };
    for (std::size_t i = from + 1; i < rig.shown.size(); ++i) {
        cycles.push_back(place(rig.shown[i]) - place(rig.shown[i - 1]));
    }
    return cycles;
}

bool all_are(const auto& values, auto value) {
    return !values.empty() && std::all_of(values.begin(), values.end(), [&](auto v) { return v == value; });
}

/// Every frame is due after the boundary before the one that shows it, and by half a cycle: none can slip.
void check_margins(const StreamRig& rig) {
    for (const StreamRig::Shown& frame : rig.shown) {
        const std::uint64_t present_at_ns = rig.wire.asked.at(frame.id);
        if (present_at_ns == 0) continue;
        REQUIRE(frame.boundary_ns > present_at_ns);
        REQUIRE(frame.boundary_ns - present_at_ns > rig.cycle_ns / 3);
        REQUIRE(frame.boundary_ns - present_at_ns < rig.cycle_ns * 2 / 3);
    }
}

TEST_CASE("a producer that jitters by almost a period gives an even rate") {
    StreamRig rig({.period_ns = 20 * kMs});
    rig.produce = timed_producer(20 * kMs, 9 * kMs);
    rig.run(10'000 * kMs);
    rig.drain();
    const StreamStatistics statistics = rig.stream->statistics();
    CHECK(rig.shown.size() > 490);
    CHECK(rig.in_order());
    CHECK(statistics.presented == rig.shown.size());
    CHECK(statistics.offered == rig.shown.size());
    // A slot or two are missed until one frame is in store for the latest of all.
    const Intervals intervals = rig.intervals();
    const auto even = std::count(intervals.begin(), intervals.end(), 20 * kMs);
    const auto double_ones = std::count(intervals.begin(), intervals.end(), 40 * kMs);
    CHECK(even + double_ones == static_cast<std::ptrdiff_t>(intervals.size()));
    CHECK(double_ones == static_cast<std::ptrdiff_t>(statistics.slots_missed));
    CHECK(statistics.slots_missed <= 2);
    CHECK(statistics.late == 0);
    CHECK(statistics.given_up == 0);
    CHECK(statistics.lateness_max_ns == 0);
    CHECK(statistics.rate_hz == Approx(50.0).epsilon(0.01));
    check_margins(rig);
}

TEST_CASE("every cycle of the display shows a frame where no period is given, or a shorter one than a cycle") {
    const std::uint64_t period_ns = GENERATE(0u, 3'000'000u, 10'000'000u);
    const std::uint32_t pages = GENERATE(2u, 3u, 8u);
    StreamRigOptions options;
    options.pages = pages;
    StreamRig rig({.period_ns = period_ns}, options);
    rig.produce = greedy_producer(200);
    rig.run(2500 * kMs);
    CHECK(rig.shown.size() == 200);
    CHECK(all_are(rig.intervals(), 10 * kMs));
    CHECK(rig.stream->period_ns() == 10 * kMs);
    CHECK(rig.stream->idle());
    const StreamStatistics statistics = rig.stream->statistics();
    CHECK(statistics.rate_hz == Approx(100.0));
    CHECK(statistics.worst_interval_ns == 10 * kMs);
    CHECK(statistics.late + statistics.slots_missed + statistics.given_up + statistics.dropped == 0);
    CHECK(rig.most_in_flight <= std::min(3u, pages - 1));
    check_margins(rig);
}

TEST_CASE("a rate that does not divide the display's is kept on average, at the nearest boundaries") {
    StreamRig rig({.period_ns = 1'000'000'000 / 24});
    rig.produce = greedy_producer();
    rig.run(10'000 * kMs);
    const StreamStatistics statistics = rig.stream->statistics();
    CHECK(statistics.rate_hz == Approx(24.0).epsilon(0.005));
    CHECK(statistics.worst_interval_ns == 50 * kMs);
    for (const std::uint64_t interval : rig.intervals()) CHECK((interval == 40 * kMs || interval == 50 * kMs));
    CHECK(statistics.late == 0);
    CHECK(statistics.slots_missed == 0);
}

TEST_CASE("a display that runs a little faster or slower than it should sets the pace") {
    StreamRigOptions options;
    options.cycle_ns = GENERATE(9'850'000u, 9'990'000u, 10'010'000u, 10'150'000u);
    StreamRig rig({.period_ns = 20 * kMs}, options);
    rig.produce = greedy_producer();
    rig.run(10'000 * kMs);
    CHECK(all_are(rig.intervals(), 2 * options.cycle_ns));
    CHECK(rig.stream->statistics().late == 0);
    CHECK(rig.stream->statistics().slots_missed == 0);
    CHECK(rig.in_order());
    check_margins(rig);
}

TEST_CASE("a display whose cycles differ by 5 percent shows every frame at the boundary meant for it") {
    StreamRig rig({.period_ns = 30 * kMs});
    rig.next_cycle_ns = [seed = std::uint32_t{7}]() mutable {
        seed = seed * 1664525u + 1013904223u;
        return 9'500'000 + (seed >> 8) % 1'000'001;
    };
    rig.produce = greedy_producer();
    rig.run(10'000 * kMs);
    CHECK(rig.shown.size() > 320);
    CHECK(all_are(cycles_between(rig, 0), std::ptrdiff_t{3}));
    CHECK(rig.stream->statistics().late == 0);
    CHECK(rig.stream->statistics().slots_missed == 0);
    // It is late by what nobody could foresee of three cycles.
    CHECK(rig.stream->statistics().lateness_max_ns > 0);
    CHECK(rig.stream->statistics().lateness_max_ns < 3 * kMs);
    for (const std::uint64_t lateness : rig.lateness()) CHECK(lateness == 0);
}

TEST_CASE("slots of many cycles go along with the display too") {
    StreamRigOptions options;
    options.cycle_ns = GENERATE(9'900'000u, 10'100'000u);
    StreamRig rig({.period_ns = 100 * kMs}, options);
    rig.produce = greedy_producer();
    rig.run(20'000 * kMs);
    CHECK(all_are(cycles_between(rig, 0), std::ptrdiff_t{10}));
    CHECK(rig.stream->statistics().late == 0);
}

TEST_CASE("a display that turns a tenth faster than it should, and unevenly, shows a frame in each cycle") {
    StreamRig rig({.period_ns = 0});
    rig.next_cycle_ns = [seed = std::uint32_t{7}]() mutable {
        seed = seed * 1664525u + 1013904223u;
        return 8'600'000 + (seed >> 8) % 600'001;
    };
    rig.produce = greedy_producer();
    rig.run(10'000 * kMs);
    CHECK(rig.shown.size() > 1000);
    // From when its speed is known.
    CHECK(all_are(cycles_between(rig, 10), std::ptrdiff_t{1}));
    CHECK(rig.stream->statistics().slots_missed <= 1);
}

TEST_CASE("a slot that nothing is offered for is missed, and the rate stays in step") {
    StreamRig rig({.period_ns = 20 * kMs});
    std::uint32_t number = 0;
    rig.produce = [&](StreamRig& at) {
        if (at.stream->has_room() && number < 10) REQUIRE(at.offer(number++) == Status::Ok);
    };
    rig.run(500 * kMs);
    REQUIRE(rig.stream->idle());
    CHECK(rig.stream->statistics().slots_missed == 0);
    const std::uint64_t next = rig.stream->next_slot();
    CHECK(next > 10);
    number = 0;
    rig.produce = greedy_producer(10);
    rig.run(500 * kMs);
    const StreamStatistics statistics = rig.stream->statistics();
    REQUIRE(rig.shown.size() == 20);
    const std::uint64_t gap_ns = rig.shown[10].boundary_ns - rig.shown[9].boundary_ns;
    CHECK(gap_ns % (20 * kMs) == 0);
    CHECK(statistics.slots_missed == gap_ns / (20 * kMs) - 1);
    CHECK(statistics.worst_interval_ns == gap_ns);
    CHECK(next == 10 + statistics.slots_missed);
    CHECK(all_are(rig.intervals(10), 20 * kMs));
}

TEST_CASE("no more frames are in flight than allowed") {
    const std::uint32_t most = GENERATE(1u, 2u, 5u, 16u);
    StreamRigOptions options;
    options.pages = 8;
    StreamRig rig({.period_ns = 20 * kMs, .max_in_flight = most}, options);
    rig.produce = greedy_producer();
    rig.run(2'000 * kMs);
    CHECK(rig.most_in_flight == std::min(most, 7u));
    CHECK(all_are(rig.intervals(), 20 * kMs));
}

TEST_CASE("clocks that drift apart do not bring a stream out of step") {
    // The display's cycle is that of its clock: seen from the host it shifts by 1 ms in 10 s, and nothing is late.
    StreamRig rig({.period_ns = 20 * kMs});
    const double ppm = GENERATE(-100.0, 100.0);
    rig.produce = [offer = greedy_producer(), ppm, run = std::uint64_t{0}](StreamRig& at) mutable {
        offer(at);
        run += StreamRig::kStepNs;
        at.on_since_ns = 5'000'000'000 + static_cast<std::uint64_t>(1e9 + static_cast<double>(run) * ppm / 1e6);
    };
    rig.on_since_ns += 1'000'000'000;
    rig.run(20'000 * kMs);
    CHECK(all_are(rig.intervals(), 20 * kMs));
    const ClockOffset& clock = rig.session->clock();
    const double off_ns = static_cast<double>(clock.device_time_at(rig.now_ns)) - static_cast<double>(rig.device_ns());
    CHECK(std::abs(off_ns) <= static_cast<double>(clock.error_ns_at(rig.now_ns)));
    CHECK(clock.error_ns_at(rig.now_ns) < 100'000);
}

}  // namespace
}  // namespace xorvox::host
