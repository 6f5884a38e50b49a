#include "sim/timing.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "driver/wire/packet.h"
#include "sim/make_sim.h"
#include "tests/catch.h"

namespace xorvox {
namespace {

using device::Dark;
using sim::FrameTiming;
using sim::make_sim;
using sim::SimRig;
using sim::Timing;
using sim::TimingWatch;

constexpr std::uint64_t kMs = 1'000'000;

/// A device that does what a test says, with a cycle every 10 ms.
struct Told {
    TimingWatch watch;
    TimingWatch::State state;
    std::uint32_t sequence = 0;

    template <class Message>
    static std::vector<std::byte> packet(std::uint32_t sequence, const Message& message) {
        std::vector<std::byte> packet(wire::kMinPacketBytes);
        std::size_t size = 0;
        REQUIRE(wire::encode_packet(3, sequence, message, packet, size) == Status::Ok);
        packet.resize(size);
        return packet;
    }
    Told() { watch.received(packet(sequence++, wire::HelloRequest{}), 0); }

    void begins(std::uint32_t frame, std::uint64_t ms, std::uint64_t asked_ms = 0) {
        const wire::FrameBegin begin{.frame = frame, .frame_bytes = 8, .present_at_ns = asked_ms * kMs};
        watch.received(packet(sequence++, begin), ms * kMs);
    }
    void accepted(std::uint32_t frame, std::uint64_t ms) {
        const wire::Acknowledge accepted{.stage = wire::AckStage::Accepted, .frame = frame, .device_time_ns = ms * kMs};
        watch.sent(packet(0, accepted), ms * kMs);
    }
    void refused(std::uint32_t frame, std::uint64_t ms) {
        watch.sent(packet(0, wire::Nack{.reason = wire::NackReason::Gap, .frame = frame}), ms * kMs);
    }
    void shows(std::uint32_t frame) {
        state.has_frame = true;
        state.frame = frame;
    }
    void lights(std::uint64_t ms) {
        state.dark = Dark::No;
        state.locked = true;
        state.cycle = static_cast<std::uint32_t>(ms / 10);
        watch.look(state, ms * kMs);
    }
    void is_dark(Dark why, std::uint64_t ms) {
        state.dark = why;
        state.locked = why != Dark::NotLocked;
        watch.look(state, ms * kMs);
    }
    const Timing& timing() const { return watch.timing(); }
};

TEST_CASE("frames that are presented in the dark are known to be replaced once the next one is presented") {
    Told told;
    told.is_dark(Dark::NotLocked, 1);
    for (std::uint32_t frame = 1; frame <= 4; ++frame) {
        told.begins(frame, 10 * frame);
        told.accepted(frame, 10 * frame + 1);
        told.shows(frame);
        told.is_dark(Dark::NotLocked, 10 * frame + 2);
    }
    REQUIRE(told.watch.frames().size() == 3);
    for (std::uint32_t frame = 1; frame <= 3; ++frame) {
        const FrameTiming& timing = told.watch.frames()[frame - 1];
        CHECK(timing.frame == frame);
        CHECK(timing.presented_ns == (10 * frame + 2) * kMs);
        CHECK(timing.first_light_ns == FrameTiming::kNever);
        CHECK_FALSE(timing.dropped);
    }
    told.lights(50);
    REQUIRE(told.watch.frames().size() == 4);
    CHECK(told.watch.frames()[3].first_light_ns == 50 * kMs);
    CHECK(told.timing().presented == 4);
    CHECK(told.timing().dropped == 0);
    CHECK(told.timing().latency.frames == 1);
}

TEST_CASE("a frame's way is told: first packet, accepted, presented, first light") {
    Told told;
    told.begins(7, 3);
    told.accepted(7, 5);
    told.is_dark(Dark::NoPicture, 8);
    told.shows(7);
    told.state.cycle = 1;
    told.is_dark(Dark::DeadZone, 10);
    told.lights(12);
    REQUIRE(told.watch.frames().size() == 1);
    const FrameTiming& frame = told.watch.frames()[0];
    CHECK(frame.frame == 7);
    CHECK(frame.first_packet_ns == 3 * kMs);
    CHECK(frame.accepted_ns == 5 * kMs);
    CHECK(frame.presented_ns == 10 * kMs);
    CHECK(frame.first_light_ns == 12 * kMs);
    CHECK_FALSE(frame.late);
    CHECK_FALSE(frame.dropped);
    CHECK(told.timing().latency.frames == 1);
    CHECK(told.timing().latency.mean_ns == 9e6);
}

TEST_CASE("latency has its least, mean and most") {
    Told told;
    for (std::uint32_t frame = 1; frame <= 3; ++frame) {
        told.begins(frame, 10 * frame - 2 * frame);
        told.accepted(frame, 10 * frame - frame);
        told.shows(frame);
        told.lights(10 * frame);
    }
    CHECK(told.timing().latency.frames == 3);
    CHECK(told.timing().latency.least_ns == 2 * kMs);
    CHECK(told.timing().latency.mean_ns == Approx(4e6));
    CHECK(told.timing().latency.most_ns == 6 * kMs);
}

TEST_CASE("a frame that misses a boundary is late, by what was asked or since it was whole") {
    const auto is_late = [](std::uint64_t accepted_ms, std::uint64_t asked_ms) {
        Told told;
        told.begins(1, 11, asked_ms);
        told.accepted(1, accepted_ms);
        told.lights(10);
        told.lights(20);
        told.lights(30);
        told.shows(1);
        told.lights(40);
        REQUIRE(told.watch.frames().size() == 1);
        CHECK(told.timing().late == (told.watch.frames()[0].late ? 1u : 0u));
        return told.watch.frames()[0].late;
    };
    CHECK_FALSE(is_late(31, 0));
    CHECK_FALSE(is_late(30, 0));  // At a boundary it comes after it.
    CHECK(is_late(29, 0));
    CHECK_FALSE(is_late(15, 35));
    CHECK_FALSE(is_late(15, 31));
    CHECK(is_late(15, 30));
    CHECK(is_late(35, 20));  // It came too late for its time.
}

TEST_CASE("a frame that waits until the rotation is found is not late") {
    Told told;
    told.begins(1, 1);
    told.accepted(1, 1);
    told.is_dark(Dark::NotLocked, 2);
    told.state.cycle = 5;
    told.is_dark(Dark::NoPicture, 55);
    told.shows(1);
    told.lights(60);
    CHECK(told.timing().presented == 1);
    CHECK(told.timing().late == 0);
}

TEST_CASE("a frame that a later one overtakes was dropped, one that is not due was not") {
    Told told;
    for (const std::uint32_t frame : {1u, 2u, 3u}) {
        told.begins(frame, frame, frame == 3 ? 50 : 0);
        told.accepted(frame, frame);
    }
    told.shows(2);
    told.lights(10);
    CHECK(told.timing().dropped == 1);
    CHECK(told.watch.frames()[0].frame == 1);
    CHECK(told.watch.frames()[0].dropped);
    told.shows(3);
    told.lights(60);
    CHECK(told.timing().presented == 2);
    CHECK(told.timing().dropped == 1);
}

TEST_CASE("a refused frame is counted, a repeated packet is not") {
    Told told;
    told.begins(1, 1);
    told.begins(1, 2);
    told.refused(1, 3);
    told.refused(1, 4);
    told.begins(1, 5);
    CHECK(told.timing().begun == 1);
    CHECK(told.timing().refused == 1);
    CHECK(told.timing().accepted == 0);
    std::vector<std::byte> damaged = Told::packet(9, wire::FrameBegin{.frame = 2});
    damaged.back() ^= std::byte{1};
    told.watch.received(damaged, 6);
    CHECK(told.timing().begun == 1);
}

TEST_CASE("a cycle in which slices of two frames are lit is torn, once") {
    Told told;
    told.shows(1);
    told.lights(10);
    told.lights(15);
    told.shows(2);
    told.lights(17);
    told.shows(3);
    told.lights(18);
    told.lights(20);
    told.shows(4);
    told.lights(30);
    CHECK(told.timing().cycles == 3);
    CHECK(told.timing().torn == 1);
}

TEST_CASE("dark time is told by its reason, and faults and locks are counted as they come") {
    Told told;
    told.is_dark(Dark::NotLocked, 0);
    told.is_dark(Dark::NoPicture, 30);
    told.lights(40);
    told.state.faults = wire::fault_bit(wire::Fault::Stall);
    told.state.locked = false;
    told.state.dark = Dark::Fault;
    told.watch.look(told.state, 100 * kMs);
    told.watch.look(told.state, 150 * kMs);
    told.state.faults = 0;
    told.is_dark(Dark::NotLocked, 160);
    told.state.faults = wire::fault_bit(wire::Fault::Stall);
    told.is_dark(Dark::Fault, 170);
    const Timing& timing = told.timing();
    CHECK(timing.until_ns == 170 * kMs);
    CHECK(timing.lit_ns == 60 * kMs);
    CHECK(timing.dark_ns[static_cast<int>(Dark::NotLocked)] == 40 * kMs);
    CHECK(timing.dark_ns[static_cast<int>(Dark::NoPicture)] == 10 * kMs);
    CHECK(timing.dark_ns[static_cast<int>(Dark::Fault)] == 60 * kMs);
    CHECK(timing.locked == 2);
    CHECK(timing.lost == 1);
    CHECK(timing.faults[static_cast<int>(wire::Fault::Stall)] == 2);
}

TEST_CASE("only so many frames are kept") {
    Told told;
    for (std::uint32_t frame = 1; frame <= 1500; ++frame) {
        told.begins(frame, 10 * frame - 1);
        told.accepted(frame, 10 * frame - 1);
        told.shows(frame);
        told.lights(10 * frame);
    }
    CHECK(told.watch.frames().size() == TimingWatch::kFramesKept);
    CHECK(told.watch.frames().back().frame == 1500);
    CHECK(told.timing().presented == 1500);
}

TEST_CASE("the account is one line of JSON, its keys in order") {
    CHECK(sim::to_json(Timing{}) ==
          R"({"until_ns": 0, "frames": {"begun": 0, "accepted": 0, "refused": 0, "presented": 0, "late": 0, )"
          R"("dropped": 0}, "latency_ns": null, "cycles": 0, "torn": 0, "lit_ns": 0, "dark_ns": {"no_picture": 0, )"
          R"("dead_zone": 0, "not_locked": 0, "fault": 0}, "locked": 0, "lost": 0, "faults": {"silent_host": 0, )"
          R"("late_scan": 0, "lost_index": 0, "stall": 0, "overspeed": 0, "reversed": 0, "interlock": 0}})");
    Timing timing;
    timing.latency = {.frames = 2, .least_ns = 5, .mean_ns = 7.5, .most_ns = 10};
    timing.dark_ns[4] = 3;
    timing.faults[4] = 1;
    CHECK_THAT(sim::to_json(timing), Catch::Contains(R"("latency_ns": {"least": 5, "mean": 7.5, "most": 10})") &&
                                         Catch::Contains(R"("fault": 3})") && Catch::Contains(R"("stall": 1)"));
}

/// 20 cycles a second.
SimRig built(const sim::MakeSim& sim) {
    auto rig = sim.build();
    REQUIRE(rig.has_value());
    return std::move(*rig);
}

TEST_CASE("of a simulated display the account is exact") {
    SimRig rig = built(make_sim().rotating(36).panel(12, 6).rotor());
    const std::vector<std::byte> page(frame_bytes(rig.display()), std::byte{0xff});
    rig.run_for(500 * kMs);
    rig.show(page);
    rig.run_for(60 * kMs);
    rig.show(page);
    rig.show(page);
    rig.run_for(140 * kMs);
    rig.show(page, 900 * kMs);
    rig.run_for(300 * kMs);

    const TimingWatch& watch = rig.simulator().timing();
    CHECK(watch.timing().until_ns == 1000 * kMs);
    CHECK(watch.timing().begun == 4);
    CHECK(watch.timing().accepted == 4);
    CHECK(watch.timing().presented == 3);
    CHECK(watch.timing().dropped == 1);
    CHECK(watch.timing().late == 0);
    CHECK(watch.timing().torn == 0);
    CHECK(watch.timing().locked == 1);
    CHECK(watch.timing().dark_ns[static_cast<int>(Dark::NotLocked)] == 250 * kMs);  // The sixth pulse.
    CHECK(watch.timing().dark_ns[static_cast<int>(Dark::NoPicture)] == 300 * kMs);
    CHECK(watch.timing().lit_ns == 450 * kMs);
    CHECK(watch.timing().cycles == 10);  // One begins at the end.
    REQUIRE(watch.frames().size() == 4);
    CHECK(watch.frames()[0].first_packet_ns == 500 * kMs);
    CHECK(watch.frames()[0].first_light_ns == 550 * kMs);
    CHECK(watch.frames()[1].dropped);
    CHECK(watch.frames()[2].first_light_ns == 600 * kMs);
    CHECK(watch.frames()[3].asked_ns == 900 * kMs);
    CHECK(watch.frames()[3].presented_ns == 900 * kMs);
}

TEST_CASE("a display that loses its packets has frames refused, and no account where none is asked for") {
    SimRig rig = built(make_sim()
                           .stacked(64)
                           .panel(64, 64)
                           .format(PixelFormat::Rgb888)
                           .fault({.kind = sim::FaultKind::LostPackets, .amount = 0.1}));
    const std::vector<std::byte> page(frame_bytes(rig.display()), std::byte{0xff});
    for (int frame = 0; frame < 20; ++frame) {
        rig.show(page);
        rig.run_for(20 * kMs);
    }
    const Timing& timing = rig.simulator().timing().timing();
    CHECK(timing.refused > 0);
    CHECK(timing.accepted > 0);
    CHECK(timing.begun < 20);

    auto plain = sim::Simulator::make(rig.display(), Link{});
    REQUIRE(plain.has_value());
    (void)plain->poll(kMs);
    CHECK(plain->timing().timing().until_ns == 0);
}

}  // namespace
}  // namespace xorvox
