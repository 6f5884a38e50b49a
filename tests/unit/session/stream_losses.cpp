// A stream that does not keep up: what is dropped, late and given up, held against what the device's end has seen.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/catch.h"
#include "tests/unit/session/stream_rig.h"
#include "tests/unit/voxelizer/allocations.h"

namespace xorvox::host {
namespace {

/// The smallest value that is not below `percent` of them.
std::uint64_t percentile(std::vector<std::uint64_t> values, std::size_t percent) {
    std::sort(values.begin(), values.end());
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (100 * (i + 1) >= percent * values.size()) return values[i];
    }
    return 0;
}

/// Everything that the stream reports, against the device's end. `offered` frames in all; the cycles are even.
void check_against_device(const StreamRig& rig, std::uint64_t offered) {
    const StreamStatistics statistics = rig.stream->statistics();
    const std::uint64_t accepted = rig.device.status(rig.device_ns()).frames_accepted;
    const std::vector<std::uint64_t> lateness = rig.lateness();
    const auto late = std::count_if(lateness.begin(), lateness.end(), [](std::uint64_t ns) { return ns > 0; });
    const std::vector<std::uint64_t> intervals = rig.intervals();

    CHECK(rig.in_order());
    CHECK(statistics.offered == offered);
    CHECK(statistics.sent == accepted);
    CHECK(statistics.dropped == offered - accepted);
    CHECK(statistics.presented == rig.shown.size());
    CHECK(statistics.given_up == accepted - rig.shown.size());
    CHECK(statistics.late == static_cast<std::uint64_t>(late));
    CHECK(statistics.lateness_p50_ns == percentile(lateness, 50));
    CHECK(statistics.lateness_p99_ns == percentile(lateness, 99));
    CHECK(statistics.lateness_max_ns == *std::max_element(lateness.begin(), lateness.end()));
    CHECK(statistics.worst_interval_ns == *std::max_element(intervals.begin(), intervals.end()));
    const auto span_ns = static_cast<double>(rig.shown.back().boundary_ns - rig.shown.front().boundary_ns);
    CHECK(statistics.rate_hz == Approx(1e9 * static_cast<double>(intervals.size()) / span_ns));
}

TEST_CASE("over a link that is too slow the rate falls to what it carries, and what was dropped is counted") {
    // 8.6 KB at 1.6 us a byte take 14 ms: more than a cycle, less than two.
    const auto policy = GENERATE(DropPolicy::DropOldest, DropPolicy::DropNewest, DropPolicy::Wait);
    StreamRigOptions options;
    options.pages = GENERATE(2u, 4u);
    options.ns_per_byte = 1600;
    StreamRig rig({.period_ns = 10 * kMs, .policy = policy}, options);
    std::uint64_t offered = 0;
    rig.produce = [&, next_ns = rig.now_ns](StreamRig& at) mutable {
        if (at.now_ns < next_ns) return;
        next_ns += 10 * kMs;
        if (at.offer(static_cast<std::uint32_t>(offered)) == Status::Ok) ++offered;
    };
    rig.run(3'000 * kMs);
    rig.drain();
    check_against_device(rig, offered);
    const StreamStatistics statistics = rig.stream->statistics();
    if (policy == DropPolicy::Wait) {
        CHECK(statistics.dropped == 0);
    } else {
        CHECK(statistics.dropped > 80);
    }
    // Two pages take a frame a presentation; more let the link work all the time.
    CHECK(statistics.rate_hz == Approx(options.pages == 2 ? 50.0 : 71.0).epsilon(0.03));
    // Only the first frames, before it is known how long they take.
    CHECK(statistics.late <= 3);
}

TEST_CASE("over a link whose speed changes, late frames and those given up are counted") {
    StreamRigOptions options;
    options.pages = GENERATE(2u, 3u, 6u);
    StreamRig rig({.period_ns = 10 * kMs, .policy = DropPolicy::DropOldest}, options);
    std::uint64_t offered = 0;
    std::uint32_t seed = 5;
    rig.produce = [&, next_ns = rig.now_ns](StreamRig& at) mutable {
        if (at.now_ns < next_ns) return;
        next_ns += 10 * kMs;
        seed = seed * 1664525u + 1013904223u;
        // Now and then it is as good as interrupted.
        at.wire.ns_per_byte = offered % 16 < 12 ? 200 : 2000 + (seed >> 16) % 6000;
        REQUIRE(at.offer(static_cast<std::uint32_t>(offered)) == Status::Ok);
        ++offered;
    };
    rig.run(10'000 * kMs);
    rig.wire.ns_per_byte = 0;
    rig.drain();
    check_against_device(rig, offered);
    const StreamStatistics statistics = rig.stream->statistics();
    CHECK(statistics.late > 20);
    CHECK(statistics.dropped > 20);
    CHECK(statistics.lateness_p99_ns >= 10 * kMs);
    if (options.pages > 2) CHECK(statistics.given_up > 0);
}

TEST_CASE("each policy keeps the frames that it promises") {
    struct Case {
        DropPolicy policy;
        std::vector<Status> answers;
        std::vector<std::uint32_t> shown;
        std::uint64_t offered;
        std::uint64_t dropped;
    };
    const auto ok = Status::Ok, full = Status::WouldBlock;
    const auto c = GENERATE_COPY(Case{DropPolicy::Wait, {ok, ok, full, full, full}, {1, 2}, 2, 0},
                                 Case{DropPolicy::DropOldest, {ok, ok, ok, ok, ok}, {4, 5}, 5, 3},
                                 Case{DropPolicy::DropNewest, {ok, ok, ok, ok, ok}, {1, 2}, 5, 3});
    StreamRig rig({.period_ns = 20 * kMs, .policy = c.policy, .queue_frames = 2});
    std::vector<Status> answers;
    for (std::uint32_t number = 1; number <= 5; ++number) {
        CHECK(rig.stream->has_room() == (number <= 2));
        answers.push_back(rig.offer(number));
    }
    CHECK(answers == c.answers);
    CHECK(rig.stream->offer({}) == Status::InvalidArgument);
    rig.drain();
    std::vector<std::uint32_t> shown;
    for (const auto& frame : rig.shown) shown.push_back(frame.number);
    CHECK(shown == c.shown);
    CHECK(rig.stream->statistics().offered == c.offered);
    CHECK(rig.stream->statistics().dropped == c.dropped);
}

TEST_CASE("under faults of the link nothing is shown out of order, and every frame sent has a fate") {
    std::uint64_t resent = 0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        StreamRigOptions options;
        options.pages = seed % 2 == 0 ? 2 : 4;
        options.faults = transport::FaultOptions{
            .seed = seed, .drop = 0.01, .repeat = 0.01, .reorder = 0.01, .cut = 0.01, .flip = 0.01};
        options.session.answer_timeout_ns = 20'000'000;
        options.session.attempts = 1000;
        StreamRig rig({.period_ns = 20 * kMs}, options);
        rig.produce = greedy_producer(100);
        rig.run(4'000 * kMs);
        rig.drain();
        CAPTURE(seed);
        const StreamStatistics statistics = rig.stream->statistics();
        REQUIRE(rig.in_order());
        REQUIRE(rig.shown.back().number == 99);
        REQUIRE(statistics.sent == 100);
        REQUIRE(statistics.presented + statistics.given_up == 100);
        REQUIRE(rig.session->statistics().frames_accepted == 100);
        REQUIRE(statistics.presented <= rig.shown.size());
        REQUIRE(statistics.presented > 80);
        resent += rig.session->statistics().frames_resent;
    }
    CHECK(resent > 20);
}

TEST_CASE("a device that is reset in the middle of a stream goes on with its new clock") {
    StreamRigOptions options;
    options.ns_per_byte = 500;
    StreamRig rig({.period_ns = 20 * kMs}, options);
    rig.produce = greedy_producer();
    rig.run(1'000 * kMs);
    // While a frame is on its way.
    while (rig.session->idle()) rig.step();
    const std::size_t shown_before = rig.shown.size();
    const std::uint32_t last_before = rig.shown.back().number;
    REQUIRE(shown_before > 40);
    const std::uint64_t clock_ns = GENERATE(std::uint64_t{0}, 3'100'000'000u);
    rig.reset_device(clock_ns);
    rig.run(3'000 * kMs);
    CHECK(rig.session->statistics().hellos == 2);
    REQUIRE(rig.shown.size() > shown_before + 20);
    CHECK(rig.in_order());
    CHECK(rig.shown[shown_before].number > last_before);
    // Evenly again, after the first two.
    for (const std::uint64_t interval : rig.intervals(shown_before + 2)) CHECK(interval == 20 * kMs);
    CHECK(rig.stream->statistics().worst_interval_ns < 100 * kMs);
    rig.drain();
    const StreamStatistics statistics = rig.stream->statistics();
    CHECK(statistics.sent == statistics.presented + statistics.given_up);
    CHECK(statistics.given_up <= 4);
    CHECK(statistics.lateness_max_ns < 20 * kMs);
    const auto device_ns = rig.session->clock().device_time_at(rig.now_ns);
    CHECK(device_ns <= rig.device_ns() + StreamRig::kStepNs);
    CHECK(device_ns + StreamRig::kStepNs >= rig.device_ns());
}

TEST_CASE("a display that stands fails the session, with the reason, and the stream says so") {
    StreamRig rig({.period_ns = 20 * kMs});
    rig.produce = greedy_producer();
    rig.run(500 * kMs);
    rig.turns = false;
    Status status = Status::Ok;
    for (int i = 0; i < 200'000 && (status == Status::Ok || status == Status::WouldBlock); ++i) {
        rig.now_ns += StreamRig::kStepNs;
        status = rig.stream->poll(rig.now_ns);
        (void)rig.device.poll(rig.device_ns());
    }
    CHECK(status == Status::Closed);
    CHECK(rig.session->error().message.find("has not shown it for 10 s") != std::string::npos);
    CHECK(rig.offer(1) == Status::Closed);
}

TEST_CASE("after the first frames a stream allocates nothing") {
    StreamRig rig({.period_ns = 20 * kMs, .policy = DropPolicy::DropOldest},
                  {.session = {.deltas = true, .compress = true}});
    rig.produce = timed_producer(10 * kMs);
    rig.run(1'000 * kMs);
    rig.wire.writes_down = false;
    rig.shown.reserve(rig.shown.size() + 1000);
    rig.boundaries.reserve(rig.boundaries.size() + 1000);
    const std::uint64_t presented = rig.stream->statistics().presented;
    const std::size_t before = test::allocation_count();
    rig.run(4'000 * kMs);
    const std::size_t after = test::allocation_count();
    CHECK(after == before);
    CHECK(before > 0);
    CHECK(rig.stream->statistics().presented > presented + 190);
}

}  // namespace
}  // namespace xorvox::host
