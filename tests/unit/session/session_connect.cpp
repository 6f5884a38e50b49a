// How a session begins, is refused, falls silent and begins again.

#include <string>
#include <vector>

#include <fmt/format.h>

#include "tests/catch.h"
#include "tests/unit/session/scripted_device.h"

namespace xorvox::host {
namespace {

using namespace wire;

TEST_CASE("hello is repeated until it is answered") {
    Rig rig;
    CHECK(rig.poll() == Status::WouldBlock);
    CHECK(rig.device.receive_one().as<HelloRequest>().host_time_ns == rig.now_ns);
    CHECK(rig.poll_after(499 * kMs) == Status::WouldBlock);
    CHECK(rig.device.receive().empty());
    CHECK(rig.poll_after(kMs) == Status::WouldBlock);
    const auto request = rig.device.receive_one();
    CHECK(rig.session.state() == SessionState::Connecting);
    rig.device.send(rig.device.hello(request.as<HelloRequest>()));
    CHECK(rig.poll() == Status::WouldBlock);
    CHECK(rig.session.state() == SessionState::Ready);
    CHECK(rig.session.device().serial.view() == "S1");
    CHECK(rig.session.idle());
    CHECK(rig.session.statistics().hellos == 1);
}

TEST_CASE("no answer ends in Failed, naming the link") {
    Rig rig;
    Status status = rig.poll();
    int requests = 0;
    for (int i = 0; i < 100 && status == Status::WouldBlock; ++i) {
        requests += static_cast<int>(rig.device.receive().size());
        status = rig.poll_after(100 * kMs);
    }
    CHECK(status == Status::Closed);
    CHECK(requests == 10);
    CHECK(rig.session.state() == SessionState::Failed);
    CHECK(rig.error_says("no answer from a display on the link loopback"));
    CHECK(rig.session.submit(make_frame(rig.display, 1)) == Status::Closed);
    CHECK(rig.session.control(ControlOperation::Status, 0) == Status::Closed);
    CHECK(rig.poll_after(kMs) == Status::Closed);
}

TEST_CASE("a program that was stopped while it connected asks again before it gives up") {
    Rig rig;
    (void)rig.poll();
    CHECK(rig.device.receive().size() == 1);
    (void)rig.poll_after(60'000 * kMs);
    CHECK(rig.session.state() == SessionState::Connecting);
    CHECK(rig.device.receive().size() == 1);
}

TEST_CASE("a peer that sends only garbage ends in Failed, and the message counts it") {
    Rig rig;
    Status status = rig.poll();
    std::uint32_t seed = 1;
    for (int i = 0; i < 100 && status == Status::WouldBlock; ++i) {
        (void)rig.device.receive();
        Bytes garbage(1 + seed % 60);
        for (std::byte& byte : garbage) byte = static_cast<std::byte>((seed = seed * 1664525u + 1013904223u) >> 24);
        rig.device.send_bytes(garbage);
        status = rig.poll_after(100 * kMs);
    }
    CHECK(status == Status::Closed);
    CHECK(rig.error_says("no answer"));
    CHECK(rig.error_says("packets came that are not of this session"));
    CHECK(rig.session.statistics().packets_ignored > 30);
}

TEST_CASE("another geometry is refused with both names and both digests") {
    Rig rig;
    Hello hello = rig.asked();
    hello.display = DisplayName("other \x1b[31m");
    hello.geometry_digest = 0x1234;
    rig.device.send(hello);
    CHECK(rig.poll() == Status::Refused);
    CHECK(rig.session.state() == SessionState::Failed);
    CHECK(rig.error_says("\"other ?[31m\""));
    CHECK(rig.error_says("\"small\""));
    CHECK(rig.error_says("0000000000001234"));
    CHECK(rig.error_says(fmt::format("{:016x}", geometry_digest(rig.display)).c_str()));
    CHECK(rig.error_says("--display"));
}

TEST_CASE("sizes and formats of a hello that do not fit the display are refused") {
    Rig rig;
    Hello hello = rig.asked();
    switch (GENERATE(0, 1, 2, 3)) {
        case 0: hello.frame_bytes -= 1; break;
        case 1: hello.frame_bytes = 0xffffffff; break;
        case 2: hello.planes = 7; break;
        case 3: hello.format = static_cast<PixelFormat>(200); break;
    }
    rig.device.send(hello);
    CHECK(rig.poll() == Status::Refused);
    CHECK(rig.error_says("firmware"));
}

/// A hello of the next major version of the protocol.
Bytes later_hello(std::uint16_t session, std::uint32_t sequence) {
    Bytes packet(200);
    std::size_t size = 0;
    REQUIRE(encode_packet(session, sequence, Hello{}, packet, size) == Status::Ok);
    packet.resize(size);
    packet[2] = std::byte{kMajor + 1};
    const std::uint32_t crc = crc32c(std::span(packet).first(size - 4));
    for (std::size_t i = 0; i < 4; ++i) packet[size - 4 + i] = static_cast<std::byte>(crc >> (8 * i));
    return packet;
}

TEST_CASE("another major version is refused, by either side, at any time") {
    Rig rig;
    if (GENERATE(false, true)) rig.connect();
    (void)rig.poll();
    (void)rig.device.receive();
    const bool by_device = GENERATE(true, false);
    if (by_device) {
        rig.device.send(Nack{.reason = NackReason::BadVersion});
    } else {
        rig.device.send_bytes(later_hello(1, rig.device.next_sequence));
    }
    CHECK(rig.poll() == Status::Refused);
    CHECK(rig.error_says("update the older one"));
}

TEST_CASE("another major version in another session is none of ours") {
    Rig rig;
    rig.connect();
    rig.device.send_bytes(later_hello(2, 0));
    CHECK(rig.poll() == Status::WouldBlock);
    CHECK(rig.session.state() == SessionState::Ready);
    CHECK(rig.session.statistics().packets_ignored == 1);
}

TEST_CASE("numbers of packets wrap") {
    STATIC_REQUIRE(is_newer(1, 0));
    STATIC_REQUIRE(is_newer(0, 0xffffffff));
    STATIC_REQUIRE(is_newer(0x7fffffff, 0));
    STATIC_REQUIRE_FALSE(is_newer(5, 5));
    STATIC_REQUIRE_FALSE(is_newer(0xffffffff, 0));
    STATIC_REQUIRE_FALSE(is_newer(0x80000000, 0));
    STATIC_REQUIRE_FALSE(is_newer(0, 0x80000000));
    Rig rig;
    rig.device.next_sequence = 0xfffffffe;
    rig.connect();
    rig.device.send(DeviceStatus{.brightness = 7, .free_pages = 2});
    (void)rig.poll();
    CHECK(rig.session.device_status().brightness == 7);
    rig.device.send_numbered(DeviceStatus{.brightness = 8, .free_pages = 2}, 0xffffffff);
    (void)rig.poll();
    CHECK(rig.session.device_status().brightness == 7);
}

TEST_CASE("a closed link is Failed with a clear message") {
    Rig rig;
    if (GENERATE(false, true)) rig.connect();
    rig.device.close();
    CHECK(rig.poll() == Status::Closed);
    CHECK(rig.error_says("the peer closed the connection"));
    CHECK(rig.error_says("loopback"));
}

TEST_CASE("a link whose packets are too short for the protocol is refused") {
    transport::LoopbackOptions link;
    link.max_packet_bytes = 255;
    Rig rig({}, link);
    CHECK(rig.poll() == Status::Refused);
    CHECK(rig.error_says("256 are needed"));
}

TEST_CASE("hellos of another session or to an earlier request are ignored") {
    Rig rig;
    (void)rig.poll();
    const auto request = rig.device.receive_one().as<HelloRequest>();
    rig.device.session = 2;
    rig.device.send(rig.device.hello(request));
    rig.device.session = 1;
    Hello early = rig.device.hello(request);
    early.host_time_ns -= 1;
    rig.device.send(early);
    (void)rig.poll();
    CHECK(rig.session.state() == SessionState::Connecting);
    CHECK(rig.session.statistics().packets_ignored == 2);
}

TEST_CASE("an idle session pings, and asks anew when nothing comes back") {
    Rig rig;
    rig.connect();
    (void)rig.poll_after(499 * kMs);
    CHECK(rig.device.receive().empty());
    for (int i = 0; i < 20; ++i) {
        (void)rig.poll_after(i == 0 ? kMs : 500 * kMs);
        rig.device.send(Pong{.host_time_ns = rig.device.receive_one().as<Ping>().host_time_ns});
        (void)rig.poll();
    }
    CHECK(rig.session.state() == SessionState::Ready);
    // Silence from here on.
    std::vector<Received> packets;
    for (int i = 0; i < 30 && rig.session.state() == SessionState::Ready; ++i) {
        (void)rig.poll_after(100 * kMs);
        for (Received& packet : rig.device.receive()) packets.push_back(std::move(packet));
    }
    CHECK(rig.session.state() == SessionState::Connecting);
    REQUIRE(packets.back().is(PacketType::HelloRequest));
    rig.device.send(rig.device.hello(packets.back().as<HelloRequest>()));
    (void)rig.poll();
    CHECK(rig.session.state() == SessionState::Ready);
    CHECK(rig.session.statistics().hellos == 2);
}

TEST_CASE("a device that answers nothing but hellos ends in Failed") {
    Rig rig;
    Status status = rig.poll();
    int polls = 0;
    for (; polls < 10'000 && status == Status::WouldBlock; ++polls) {
        for (const Received& packet : rig.device.receive()) {
            if (packet.is(PacketType::HelloRequest)) rig.device.send(rig.device.hello(packet.as<HelloRequest>()));
        }
        status = rig.poll_after(50 * kMs);
    }
    CHECK(status == Status::Closed);
    CHECK(polls < 10'000);
}

TEST_CASE("a device that was reset gets the frame again, as a keyframe") {
    Rig rig;
    rig.connect();
    const Bytes first = make_frame(rig.display, 1), second = make_frame(rig.display, 2);
    rig.device.accept(rig.sent_frame(first).back().as<FrameEnd>());
    (void)rig.poll();
    CHECK(rig.sent_frame(second).front().as<FrameBegin>().flags == kFrameDelta);
    // The new device knows of no session: it does not answer.
    std::vector<Received> packets;
    for (int i = 0; i < 40 && rig.session.state() == SessionState::Ready; ++i) {
        (void)rig.poll_after(100 * kMs);
        packets = rig.device.receive();
    }
    REQUIRE_FALSE(packets.empty());
    rig.device.boot_nonce = 78;
    rig.device.next_sequence = 0;
    rig.device.greet(rig.device.hello(packets.back().as<HelloRequest>()));
    const auto frame = rig.sent_frame();
    CHECK(frame.front().as<FrameBegin>().flags == 0);
    CHECK(decode_frame(frame) == second);
    rig.device.accept(frame.back().as<FrameEnd>());
    (void)rig.poll();
    CHECK(rig.session.idle());
    CHECK(rig.session.device().boot_nonce == 78);
    CHECK(rig.session.statistics().frames_accepted == 2);
}

TEST_CASE("a new boot nonce in a later hello starts again; a repeated hello does not") {
    Rig rig;
    (void)rig.poll();
    const auto request = rig.device.receive_one().as<HelloRequest>();
    rig.device.greet(rig.device.hello(request));
    (void)rig.poll();
    const auto first_id = rig.sent_frame(1).front().as<FrameBegin>().frame;

    rig.device.send(rig.device.hello(request));
    (void)rig.poll();
    CHECK(rig.device.receive().empty());
    CHECK(rig.session.statistics().hellos == 1);

    rig.device.boot_nonce = 78;
    rig.device.greet(rig.device.hello(request));
    const auto again = rig.sent_frame();
    CHECK(again.front().as<FrameBegin>().frame == first_id + 1);
    CHECK(rig.session.statistics().hellos == 2);
}

}  // namespace
}  // namespace xorvox::host
