// A device that does what the test says: it reads packets, and answers only when told. And what the tests share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "driver/display/description.h"
#include "driver/host/session.h"
#include "driver/wire/messages.h"
#include "driver/wire/packet.h"
#include "tests/catch.h"
#include "transport/loopback.h"

namespace xorvox::host {

using Bytes = std::vector<std::byte>;

constexpr std::uint64_t kMs = 1'000'000;

/// 64 × 16 × 8 pixels of a byte: frames of 8192 bytes.
inline DisplayDescription small_display() {
    DisplayDescription display;
    display.name = DisplayName("small");
    display.kind = DisplayKind::StackedPlanes;
    display.format = PixelFormat::Rgb332;
    display.slices = 8;
    display.cycles_per_second = 100;
    display.panels[0].columns = 64;
    display.panels[0].rows = 16;
    return display;
}

/// A frame that compresses well, most of it like frame 0.
inline Bytes make_frame(const DisplayDescription& display, std::uint32_t number) {
    Bytes frame(frame_bytes(display));
    for (std::size_t i = 0; i < frame.size(); ++i) frame[i] = static_cast<std::byte>((i / 7) * (i / 7) % 251);
    for (std::size_t i = 0; i < 20; ++i)
        frame[(number * 131 + i * 17) % frame.size()] ^= static_cast<std::byte>(number);
    return frame;
}

/// How a device is that has this fault and no other.
inline wire::DeviceStatus faulty(wire::Fault fault) {
    return {.blank = static_cast<std::uint8_t>(fault == wire::Fault::None ? 0 : 1),
            .watchdog_ms = 2000,
            .fault = fault,
            .free_pages = 2,
            .faults = wire::fault_bit(fault)};
}

struct Received {
    wire::Header header;
    Bytes payload;

    /// The payload as a message; fails the test when it is none.
    template <class Message>
    Message as() const {
        REQUIRE(header.type == Message::kType);
        Message message;
        REQUIRE(wire::decode(payload, message) == Status::Ok);
        return message;
    }
    bool is(wire::PacketType type) const { return header.type == type; }
};

class ScriptedDevice {
public:
    explicit ScriptedDevice(UniqueLink link, const DisplayDescription& display = small_display())
        : link_(std::move(link)), display_(display) {}

    /// All packets that came since the last call.
    std::vector<Received> receive() {
        std::vector<Received> packets;
        Bytes buffer(65536);
        std::size_t size = 0;
        while (link_->receive(buffer, size) == Status::Ok) {
            Received packet;
            std::span<const std::byte> payload;
            REQUIRE(wire::decode_packet(std::span(buffer).first(size), packet.header, payload) == Status::Ok);
            packet.payload.assign(payload.begin(), payload.end());
            packets.push_back(std::move(packet));
        }
        return packets;
    }

    /// The only packet that came since the last call.
    Received receive_one() {
        auto packets = receive();
        REQUIRE(packets.size() == 1);
        return packets.front();
    }

    template <class Message>
    void send(const Message& message) {
        send_numbered(message, next_sequence++);
    }
    template <class Message>
    void send_numbered(const Message& message, std::uint32_t sequence) {
        Bytes packet(1000);
        std::size_t size = 0;
        REQUIRE(wire::encode_packet(session, sequence, message, packet, size) == Status::Ok);
        REQUIRE(link_->send(std::span(packet).first(size)) == Status::Ok);
    }
    void send_bytes(std::span<const std::byte> bytes) { REQUIRE(link_->send(bytes) == Status::Ok); }

    /// What it says of itself in answer to `request`; change it and send() it.
    wire::Hello hello(const wire::HelloRequest& request) const {
        wire::Hello hello;
        hello.features = wire::kFeatureDelta | wire::kFeaturePresentAt;
        hello.boot_nonce = boot_nonce;
        hello.serial = DisplayName("S1");
        hello.display = display_.name;
        hello.geometry_digest = geometry_digest(display_);
        hello.format = display_.format;
        hello.planes = static_cast<std::uint8_t>(bits_per_pixel(display_.format));
        hello.frame_bytes = static_cast<std::uint32_t>(frame_bytes(display_));
        hello.pages = 2;
        hello.max_packet_bytes = 1024;
        hello.codecs = 3;
        hello.free_pages = 2;
        hello.host_time_ns = request.host_time_ns;
        return hello;
    }

    /// Says who it is and, before it is asked, how it is.
    void greet(const wire::Hello& hello) {
        send(hello);
        wire::DeviceStatus status = faulty(hello.fault);
        status.free_pages = hello.free_pages;
        send(status);
    }

    void accept(const wire::FrameEnd& end, std::uint8_t free_pages = 1) {
        send(wire::Acknowledge{
            .stage = wire::AckStage::Accepted, .frame = end.frame, .page_crc = end.page_crc, .free_pages = free_pages});
    }
    void close() { link_.reset(); }

    std::uint16_t session = 1;
    std::uint32_t next_sequence = 0;
    std::uint32_t boot_nonce = 77;

private:
    UniqueLink link_;
    DisplayDescription display_;
};

/// A session and a scripted device at the other end, on a clock that the test moves.
struct Rig {
    explicit Rig(const SessionOptions& options = {}, const transport::LoopbackOptions& link = {})
        : Rig(transport::make_loopback(link), options) {}

    /// Lets the session do all that it can now.
    Status poll() {
        Status status = Status::Ok;
        for (int i = 0; i < 100 && status == Status::Ok; ++i) status = session.poll(now_ns);
        REQUIRE(status != Status::Ok);
        return status;
    }
    Status poll_after(std::uint64_t ns) {
        now_ns += ns;
        return poll();
    }
    /// The session asks who is there: what the device would say.
    wire::Hello asked() {
        (void)poll();
        return device.hello(device.receive_one().as<wire::HelloRequest>());
    }
    /// Hello, answered.
    void connect() { connect_as(asked()); }
    void connect_as(const wire::Hello& hello) {
        device.greet(hello);
        (void)poll();
        REQUIRE(session.state() == SessionState::Ready);
    }
    /// The packets of one frame that the session sends now.
    std::vector<Received> sent_frame() {
        (void)poll();
        auto packets = device.receive();
        REQUIRE(packets.size() >= 3);
        REQUIRE(packets.front().is(wire::PacketType::FrameBegin));
        REQUIRE(packets.back().is(wire::PacketType::FrameEnd));
        return packets;
    }
    /// The packets of a frame that is submitted now.
    std::vector<Received> sent_frame(std::span<const std::byte> frame, std::uint64_t present_at_ns = 0) {
        REQUIRE(session.submit(frame, present_at_ns) == Status::Ok);
        return sent_frame();
    }
    std::vector<Received> sent_frame(std::uint32_t number) { return sent_frame(make_frame(display, number)); }

    bool error_says(const char* words) const { return session.error().message.find(words) != std::string::npos; }

    UniqueLink near;
    DisplayDescription display = small_display();
    Session session;
    ScriptedDevice device;
    std::uint64_t now_ns = 1'000'000'000;

private:
    Rig(std::pair<UniqueLink, UniqueLink> ends, const SessionOptions& options)
        : near(std::move(ends.first)), session(near.get(), display, options), device(std::move(ends.second)) {}
};

/// The page that the packets of a frame make; `base` is the page of the frame that a delta names.
Bytes decode_frame(const std::vector<Received>& packets, const Bytes& base = {});

}  // namespace xorvox::host
