// What a stream asks for and reports, with a device that does what the test says; and the estimates that it rests on.

#include <cstdint>
#include <vector>

#include "driver/host/boundary_estimate.h"
#include "driver/host/recent_values.h"
#include "driver/host/stream.h"
#include "tests/catch.h"
#include "tests/unit/session/scripted_device.h"

namespace xorvox::host {
namespace {

using namespace wire;

TEST_CASE("quantiles are the smallest value that is not below so many") {
    RecentValues values(100);
    CHECK(values.quantile(0.5) == 0);
    for (std::uint64_t i = 100; i > 0; --i) values.add(i);
    CHECK(values.quantile(0.50) == 50);
    CHECK(values.quantile(0.99) == 99);
    CHECK(values.quantile(1.0) == 100);
    CHECK(values.quantile(0.0) == 1);
    // The oldest leave first.
    for (std::uint64_t i = 0; i < 50; ++i) values.add(1000);
    CHECK(values.quantile(0.50) == 50);
    CHECK(values.quantile(0.51) == 1000);
    RecentValues one(1);
    one.add(3);
    one.add(4);
    CHECK(one.quantile(0.5) == 4);
}

TEST_CASE("the cycle of a display that is 10 percent off is found, also from every third boundary") {
    for (const double real_ns : {9e6, 11e6}) {
        BoundaryEstimate estimate(10e6);
        CHECK_FALSE(estimate.known());
        for (int i = 0; i <= 40; ++i) {
            estimate.observe(static_cast<std::uint64_t>(5e9 + 3.0 * i * real_ns));
        }
        CHECK(estimate.known());
        CHECK(estimate.cycle_ns() == Approx(real_ns).epsilon(1e-4));
        const auto last_ns = static_cast<std::uint64_t>(5e9 + 120.0 * real_ns);
        CHECK(estimate.nearest(last_ns + 4'000'000) == last_ns);
        CHECK(static_cast<double>(estimate.nearest(last_ns - 19'000'000) - last_ns + 1'000'000'000) ==
              Approx(1e9 - 2 * real_ns).epsilon(1e-4));
        estimate.forget();
        CHECK_FALSE(estimate.known());
        CHECK(estimate.cycle_ns() == Approx(real_ns).epsilon(1e-4));
    }
}

/// A stream on a scripted device with two pages, whose clock is 3 s behind the host's, and whose boundaries are at
/// whole multiples of 10 ms.
struct Script : Rig {
    explicit Script(const StreamOptions& options, std::uint32_t features = kFeaturePresentAt)
        : stream(session, display, options) {
        now_ns = 4'000'000'000;
        Hello hello = asked();
        hello.features = features;
        hello.device_time_ns = device_ns();
        connect_as(hello);
        run_to(device_ns());
    }
    std::uint64_t device_ns() const { return now_ns - 3'000'000'000; }

    /// Lets the stream work until this time of the device's clock; the frame that was begun, if any.
    void run_to(std::uint64_t at_device_ns) {
        while (true) {
            while (stream.poll(now_ns) == Status::Ok) {
            }
            for (const Received& packet : device.receive()) take(packet);
            while (stream.poll(now_ns) == Status::Ok) {
            }
            if (device_ns() >= at_device_ns) return;
            now_ns += kMs / 2;
        }
    }
    void take(const Received& packet) {
        if (packet.is(PacketType::Ping)) {
            device.send(Pong{.host_time_ns = packet.as<Ping>().host_time_ns, .device_time_ns = device_ns()});
        } else if (packet.is(PacketType::Control)) {
            DeviceStatus status = faulty(Fault::None);
            status.free_pages = 0;
            device.send(status);
        } else if (packet.is(PacketType::FrameBegin)) {
            begun.push_back(packet.as<FrameBegin>());
        } else if (packet.is(PacketType::FrameEnd)) {
            end = packet.as<FrameEnd>();
            acknowledge(AckStage::Accepted, device_ns(), 0);
        }
    }
    void acknowledge(AckStage stage, std::uint64_t at_device_ns, std::uint8_t free_pages) {
        device.send(Acknowledge{.stage = stage,
                                .frame = end.frame,
                                .page_crc = end.page_crc,
                                .free_pages = free_pages,
                                .device_time_ns = at_device_ns});
    }
    /// The frame accepted last is shown at this boundary.
    void present(std::uint64_t boundary_ns) {
        run_to(boundary_ns);
        acknowledge(AckStage::Presented, boundary_ns, 1);
        run_to(boundary_ns);
    }

    FrameStream stream;
    std::vector<FrameBegin> begun;
    FrameEnd end;
};

TEST_CASE("the first frame is asked for no time; the ones after it for half a cycle before their boundary") {
    Script script({.period_ns = 30 * kMs});
    REQUIRE(script.stream.offer(make_frame(script.display, 1)) == Status::Ok);
    REQUIRE(script.stream.offer(make_frame(script.display, 2)) == Status::Ok);
    script.run_to(1'010'000'000);
    REQUIRE(script.begun.size() == 1);
    CHECK(script.begun[0].present_at_ns == 0);
    CHECK(script.stream.in_flight() == 1);
    script.present(1'010'000'000);
    REQUIRE(script.begun.size() == 2);
    CHECK(script.begun[1].present_at_ns == 1'035'000'000);
    script.present(1'040'000'000);
    // A frame that comes too late for its slot gets the next one.
    script.run_to(1'071'000'000);
    REQUIRE(script.stream.offer(make_frame(script.display, 3)) == Status::Ok);
    script.run_to(1'072'000'000);
    REQUIRE(script.begun.size() == 3);
    CHECK(script.begun[2].present_at_ns == 1'095'000'000);
    CHECK(script.stream.statistics().slots_missed == 1);
    CHECK(script.stream.next_slot() == 4);
}

TEST_CASE("lateness of a known sequence is reported exactly") {
    Script script({.period_ns = 50 * kMs});
    REQUIRE(script.stream.offer(make_frame(script.display, 0)) == Status::Ok);
    script.present(1'010'000'000);
    // Cycles after the boundary asked for: of 100 frames 60 none, 30 one, 9 two, and one four.
    std::uint64_t worst_ns = 0, last_ns = 1'010'000'000;
    for (std::uint32_t i = 0; i < 100; ++i) {
        REQUIRE(script.stream.offer(make_frame(script.display, i + 1)) == Status::Ok);
        script.run_to(script.device_ns());
        REQUIRE(script.begun.size() == i + 2);
        const std::uint64_t late_cycles = i == 50 ? 4 : i % 11 == 3 ? 2 : i % 10 < 3 || i > 96 ? 1 : 0;
        const std::uint64_t at_ns = script.begun.back().present_at_ns + 5 * kMs + late_cycles * 10 * kMs;
        script.present(at_ns);
        worst_ns = std::max(worst_ns, at_ns - last_ns);
        last_ns = at_ns;
    }
    const StreamStatistics statistics = script.stream.statistics();
    CHECK(statistics.presented == 101);
    CHECK(statistics.late == 40);
    CHECK(statistics.lateness_p50_ns == 0);
    CHECK(statistics.lateness_p99_ns == 20 * kMs);
    CHECK(statistics.lateness_max_ns == 40 * kMs);
    CHECK(statistics.worst_interval_ns == worst_ns);
    CHECK(statistics.rate_hz == Approx(100e9 / static_cast<double>(last_ns - 1'010'000'000)));
    CHECK(script.stream.idle());
}

TEST_CASE("for a device that does not keep present_at, the host does") {
    Script script({.period_ns = 50 * kMs}, 0);
    REQUIRE(script.stream.offer(make_frame(script.display, 1)) == Status::Ok);
    REQUIRE(script.stream.offer(make_frame(script.display, 2)) == Status::Ok);
    script.present(1'010'000'000);
    script.run_to(1'054'500'000);
    CHECK(script.begun.size() == 1);
    script.run_to(1'055'000'000);
    CHECK(script.begun.size() == 2);
}

TEST_CASE("a device that says to have shown a frame in the future is not believed") {
    Script script({.period_ns = 30 * kMs});
    const std::uint64_t said_ns =
        GENERATE(std::uint64_t{3'000'000'000}, std::uint64_t{1} << 62, std::uint64_t{1} << 63, ~0ull);
    for (std::uint32_t i = 1; i <= 5; ++i) {
        REQUIRE(script.stream.offer(make_frame(script.display, i)) == Status::Ok);
        script.run_to(script.device_ns() + 20 * kMs);
        REQUIRE(script.begun.size() == i);
        CHECK(script.begun.back().present_at_ns == 0);
        script.acknowledge(AckStage::Presented, said_ns, 1);
        script.run_to(script.device_ns() + kMs);
    }
    CHECK(script.stream.statistics().presented == 5);
    CHECK(script.stream.statistics().rate_hz == 0.0);
}

TEST_CASE("a frame whose presentation is known without its time is counted, and its lateness is not") {
    Script script({.period_ns = 30 * kMs});
    REQUIRE(script.stream.offer(make_frame(script.display, 1)) == Status::Ok);
    script.present(1'010'000'000);
    REQUIRE(script.stream.offer(make_frame(script.display, 2)) == Status::Ok);
    script.run_to(1'100'000'000);
    DeviceStatus status = faulty(Fault::None);
    status.has_frame = 1;
    status.shown_frame = script.end.frame;
    status.shown_crc = script.end.page_crc;
    script.device.send(status);
    script.run_to(1'100'000'000);
    CHECK(script.stream.idle());
    CHECK(script.stream.statistics().presented == 2);
    CHECK(script.stream.statistics().worst_interval_ns == 0);
    CHECK(script.stream.statistics().rate_hz == 0.0);
}

}  // namespace
}  // namespace xorvox::host
