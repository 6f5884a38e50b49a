// The device's clock, as the host tells it.

#include <algorithm>
#include <cstdint>
#include <limits>

#include "driver/host/clock_offset.h"
#include "tests/catch.h"
#include "tests/unit/session/scripted_device.h"

namespace xorvox::host {
namespace {

using namespace wire;

constexpr std::uint64_t kUs = 1000;

struct Random {
    std::uint32_t state;
    std::uint64_t between(std::uint64_t low, std::uint64_t high) {
        state = state * 1664525u + 1013904223u;
        return low + (state >> 8) % (high - low + 1);
    }
};

std::uint64_t distance(std::uint64_t a, std::uint64_t b) {
    return a > b ? a - b : b - a;
}

TEST_CASE("the estimate is never further off than it says, and converges to the quickest ways") {
    // Of the host's clock, the device's runs `ppm` fast.
    const double ppm = GENERATE(-200.0, -50.0, 0.0, 50.0, 200.0);
    const std::uint64_t device_start_ns = GENERATE(std::uint64_t{0}, 900'000'000'000u);
    const auto device_at = [&](std::uint64_t host_ns) {
        const auto drift_ns = static_cast<std::int64_t>(static_cast<double>(host_ns) * ppm / 1e6);
        return device_start_ns + host_ns + static_cast<std::uint64_t>(drift_ns);
    };
    ClockOffset clock;
    CHECK_FALSE(clock.valid());
    Random random{11};
    std::uint64_t now_ns = 50'000'000'000;
    std::uint64_t quickest_ns = std::numeric_limits<std::uint64_t>::max();
    for (int i = 0; i < 500; ++i) {
        // Uneven: 0.2 to 9 ms there, 0.1 to 1 ms back.
        const std::uint64_t there_ns = random.between(200 * kUs, 9000 * kUs);
        const std::uint64_t back_ns = random.between(100 * kUs, 1000 * kUs);
        clock.observe(now_ns, now_ns + there_ns + back_ns, device_at(now_ns + there_ns));
        REQUIRE(clock.valid());
        now_ns += there_ns + back_ns;
        for (const std::uint64_t later_ns : {now_ns, now_ns + 70 * kMs, now_ns + 5000 * kMs}) {
            REQUIRE(distance(clock.device_time_at(later_ns), device_at(later_ns)) <= clock.error_ns_at(later_ns));
        }
        quickest_ns = std::min(quickest_ns, there_ns + back_ns);
        REQUIRE(clock.error_ns_at(now_ns) <= (there_ns + back_ns) / 2 + 1);
        now_ns += 100 * kMs;
        // No window: the quickest answer counts until the drift since has eaten it up.
        if (i > 20) REQUIRE(clock.error_ns_at(now_ns) < 1500 * kUs);
    }
    CHECK(quickest_ns < 1000 * kUs);
}

TEST_CASE("an answer that contradicts those before begins anew") {
    ClockOffset clock;
    clock.observe(1000 * kMs, 1001 * kMs, 5000 * kMs);
    clock.observe(2000 * kMs, 2001 * kMs, 100 * kMs);
    CHECK(distance(clock.device_time_at(2001 * kMs), 100 * kMs) <= 500 * kUs + 1);
    CHECK(clock.error_ns_at(2001 * kMs) <= 500 * kUs + 1);
    // Before the device was switched on.
    CHECK(clock.device_time_at(1000 * kMs) == 0);
}

TEST_CASE("times that cannot be change nothing") {
    ClockOffset clock;
    clock.observe(20, 10, 5);
    CHECK_FALSE(clock.valid());
    clock.observe(0, 10, std::uint64_t{1} << 62);
    CHECK_FALSE(clock.valid());
    clock.observe(std::uint64_t{1} << 63, std::uint64_t{1} << 63, 0);
    CHECK_FALSE(clock.valid());
    clock.observe(0, std::numeric_limits<std::uint64_t>::max(), 7);
    CHECK_FALSE(clock.valid());
    clock.observe(10, 20, 115);
    REQUIRE(clock.valid());
    clock.observe(0, 10, std::numeric_limits<std::uint64_t>::max() / 2);
    CHECK(clock.device_time_at(20) == 120);
    CHECK(clock.error_ns_at(20) == 5);
}

TEST_CASE("hello gives the clock, pongs make it better, and it is asked for as often as wanted") {
    Rig rig;
    const auto device_ns = [&] { return rig.now_ns + 77'000 * kMs; };
    rig.session.follow_clock(40 * kMs);
    Hello hello = rig.asked();
    CHECK_FALSE(rig.session.clock().valid());
    rig.now_ns += 30 * kMs;
    hello.device_time_ns = device_ns();
    rig.now_ns += 10 * kMs;
    rig.connect_as(hello);
    REQUIRE(rig.session.clock().valid());
    CHECK(rig.session.clock().error_ns_at(rig.now_ns) == Approx(20e6).epsilon(0.001));
    std::uint64_t pings = 0;
    for (int i = 0; i < 1000; ++i) {
        for (const Received& packet : rig.device.receive()) {
            if (!packet.is(PacketType::Ping)) continue;
            ++pings;
            rig.device.send(Pong{.host_time_ns = packet.as<Ping>().host_time_ns, .device_time_ns = device_ns()});
        }
        (void)rig.poll_after(kMs);
        const ClockOffset& clock = rig.session.clock();
        REQUIRE(distance(clock.device_time_at(rig.now_ns), device_ns()) <= clock.error_ns_at(rig.now_ns));
    }
    CHECK(pings == 25);
    CHECK(rig.session.clock().error_ns_at(rig.now_ns) < kMs);
}

TEST_CASE("the clock is asked for between the packets of a frame too") {
    transport::LoopbackOptions narrow;
    narrow.max_packet_bytes = 300;
    narrow.queue_bytes = 304;
    SessionOptions options;
    options.compress = false;
    Rig rig(options, narrow);
    rig.session.follow_clock(10 * kMs);
    rig.connect();
    REQUIRE(rig.session.submit(make_frame(rig.display, 1)) == Status::Ok);
    int pings = 0, chunks = 0;
    for (bool whole = false; !whole;) {
        (void)rig.poll_after(kMs);
        for (const Received& packet : rig.device.receive()) {
            pings += packet.is(PacketType::Ping) ? 1 : 0;
            chunks += packet.is(PacketType::Chunk) ? 1 : 0;
            whole = packet.is(PacketType::FrameEnd);
        }
    }
    CHECK(chunks > 30);
    CHECK(pings >= 3);
}

TEST_CASE("after a reset the clock is the new one's, and a frame for a time of the old one is due at once") {
    Rig rig;
    rig.session.follow_clock(100 * kMs);
    Hello hello = rig.asked();
    hello.device_time_ns = 500'000 * kMs;
    rig.connect_as(hello);
    REQUIRE(rig.session.submit(make_frame(rig.display, 1), 500'050 * kMs) == Status::Ok);
    (void)rig.poll();
    // Silence, until the host asks anew.
    std::vector<Received> packets;
    for (int i = 0; i < 40 && rig.session.state() == SessionState::Ready; ++i) {
        (void)rig.poll_after(100 * kMs);
        packets = rig.device.receive();
    }
    REQUIRE(rig.session.state() == SessionState::Connecting);
    rig.device.boot_nonce = GENERATE(77u, 78u);
    const bool reset = rig.device.boot_nonce == 78;
    hello = rig.device.hello(packets.back().as<HelloRequest>());
    hello.device_time_ns = reset ? 2 * kMs : 502'000 * kMs;
    rig.device.greet(hello);
    (void)rig.poll();
    CHECK(distance(rig.session.clock().device_time_at(rig.now_ns), hello.device_time_ns) <= 1);
    packets = rig.device.receive();
    const auto begin = std::find_if(packets.begin(), packets.end(),
                                    [](const Received& packet) { return packet.is(PacketType::FrameBegin); });
    REQUIRE(begin != packets.end());
    CHECK(begin->as<FrameBegin>().present_at_ns == (reset ? 0 : 500'050 * kMs));
}

TEST_CASE("what was known of a clock before the reset does not narrow what is known of the one after") {
    Rig rig;
    (void)rig.poll();
    const auto request = rig.device.receive_one().as<HelloRequest>();
    Hello hello = rig.device.hello(request);
    hello.device_time_ns = rig.now_ns;
    rig.connect_as(hello);
    CHECK(rig.session.clock().error_ns_at(rig.now_ns) <= 2);
    rig.now_ns += 80 * kMs;
    rig.device.boot_nonce = 78;
    hello = rig.device.hello(request);
    hello.device_time_ns = rig.now_ns - 30 * kMs;
    rig.connect_as(hello);
    const ClockOffset& clock = rig.session.clock();
    CHECK(distance(clock.device_time_at(rig.now_ns), hello.device_time_ns) <= clock.error_ns_at(rig.now_ns));
}

TEST_CASE("a fate that nobody asked for before a reset keeps no time of the old clock") {
    Rig rig;
    (void)rig.poll();
    const auto request = rig.device.receive_one().as<HelloRequest>();
    rig.connect_as(rig.device.hello(request));
    const auto end = rig.sent_frame(1).back().as<FrameEnd>();
    rig.device.send(Acknowledge{.stage = AckStage::Presented,
                                .frame = end.frame,
                                .page_crc = end.page_crc,
                                .free_pages = 1,
                                .device_time_ns = 12'345});
    if (GENERATE(false, true)) {
        rig.device.boot_nonce = 78;
        rig.device.greet(rig.device.hello(request));
    }
    (void)rig.poll();
    FrameFate fate;
    REQUIRE(rig.session.next_fate(fate));
    CHECK(fate.frame == 1);
    CHECK(fate.presented);
    CHECK(fate.device_time_ns == (rig.device.boot_nonce == 78 ? 0 : 12'345));
    CHECK_FALSE(rig.session.next_fate(fate));
}

}  // namespace
}  // namespace xorvox::host
