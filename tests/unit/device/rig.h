// A device on a desk: the device half behind two queues of packets, with a host that sends whatever a test wants.
#pragma once

#include <deque>
#include <limits>
#include <vector>

#include "driver/device/device.h"
#include "tests/catch.h"

namespace xorvox::test {

using namespace xorvox::wire;
using Bytes = std::vector<std::byte>;

/// The device's end of a link, with both queues open to the test.
struct DeskLink {
    std::deque<Bytes> to_device;
    std::deque<Bytes> from_device;
    std::size_t room = std::numeric_limits<std::size_t>::max();  ///< Packets that from_device holds.
    std::uint32_t max_packet_bytes = kMaxPacketBytes;
    bool closed = false;
    bool damaged = false;  ///< The next receive() says Corrupt.

    Link link() {
        static constexpr LinkOperations kOperations{
            .info =
                [](const void* self) {
                    return LinkInfo{"desk", static_cast<const DeskLink*>(self)->max_packet_bytes, true};
                },
            .send =
                [](void* self, std::span<const std::byte> packet) {
                    auto& desk = *static_cast<DeskLink*>(self);
                    if (desk.from_device.size() >= desk.room) return Status::WouldBlock;
                    desk.from_device.emplace_back(packet.begin(), packet.end());
                    return Status::Ok;
                },
            .receive =
                [](void* self, std::span<std::byte> buffer, std::size_t& size) {
                    auto& desk = *static_cast<DeskLink*>(self);
                    if (std::exchange(desk.damaged, false)) return Status::Corrupt;
                    if (desk.to_device.empty()) return desk.closed ? Status::Closed : Status::WouldBlock;
                    const Bytes& packet = desk.to_device.front();
                    if (packet.size() > buffer.size()) return Status::OutOfMemory;
                    std::copy(packet.begin(), packet.end(), buffer.begin());
                    size = packet.size();
                    desk.to_device.pop_front();
                    return Status::Ok;
                },
            .flush = nullptr,
            .wait = nullptr,
            .close = [](void*) {},
        };
        return {&kOperations, this};
    }
};

/// 8 × 8 × 8 voxels of mono1: 64 bytes a frame. The display of tests/golden/conversation.hex.
inline constexpr DisplayDescription kCube8 = [] {
    DisplayDescription display;
    display.name = DisplayName("cube8");
    display.slices = 8;
    display.plane_pitch_mm = 10.0;
    display.cycles_per_second = 60.0;
    display.panels[0] = {.columns = 8, .rows = 8, .column_pitch_mm = 10.0, .row_pitch_mm = 10.0};
    return display;
}();

template <class Message>
Bytes packet_of(std::uint16_t session, std::uint32_t sequence, const Message& message) {
    Bytes packet(kMaxPacketBytes);
    std::size_t size = 0;
    REQUIRE(encode_packet(session, sequence, message, packet, size) == Status::Ok);
    packet.resize(size);
    return packet;
}

/// A frame whose bytes all differ from those of other seeds.
inline Bytes frame_of(std::uint8_t seed) {
    Bytes frame(frame_bytes(kCube8));
    for (std::size_t i = 0; i < frame.size(); ++i) frame[i] = static_cast<std::byte>(seed + 3 * i);
    return frame;
}

struct Desk {
    DeskLink link;
    Bytes memory;
    Bytes buffer;
    device::Device device;
    std::uint64_t now_ns = 1'000'000;
    std::uint16_t session = 7;
    std::uint32_t sequence = 0;

    explicit Desk(std::uint32_t pages = 2, std::size_t packet_bytes = kMinPacketBytes)
        : memory(pages * frame_bytes(kCube8)), buffer(packet_bytes) {
        REQUIRE(device.init({.display = &kCube8,
                             .serial = DisplayName("XV-0001"),
                             .boot_nonce = 7,
                             .link = link.link(),
                             .pages = memory,
                             .page_count = pages,
                             .packet = buffer},
                            now_ns) == Status::Ok);
    }

    template <class Message>
    Bytes next_packet(const Message& message) {
        return packet_of(session, sequence++, message);
    }
    void put(Bytes packet) { link.to_device.push_back(std::move(packet)); }
    template <class Message>
    void send(const Message& message) {
        put(next_packet(message));
    }

    /// Lets the device work until it has nothing to do.
    void work() {
        while (device.poll(now_ns) == Status::Ok) {
        }
    }

    template <class Message>
    bool is_next() const {
        return !link.from_device.empty() && link.from_device.front()[3] == static_cast<std::byte>(Message::kType);
    }
    /// The next answer, which must be a Message of this session.
    template <class Message>
    Message answer() {
        work();
        REQUIRE(!link.from_device.empty());
        const Bytes packet = link.from_device.front();
        link.from_device.pop_front();
        Header header;
        std::span<const std::byte> payload;
        REQUIRE(decode_packet(packet, header, payload) == Status::Ok);
        REQUIRE(static_cast<int>(header.type) == static_cast<int>(Message::kType));
        REQUIRE(header.session == session);
        Message message;
        REQUIRE(decode(payload, message) == Status::Ok);
        return message;
    }
    bool silent() {
        work();
        return link.from_device.empty();
    }

    Hello hello() {
        send(HelloRequest{.host_time_ns = now_ns});
        return answer<Hello>();
    }

    /// The packets of a frame, in raw chunks of `chunk` bytes. With a base, of its difference to `base_frame`.
    std::vector<Bytes> frame_packets(std::uint32_t id, const Bytes& frame, std::uint64_t present_at_ns = 0,
                                     std::size_t chunk = 21) {
        return packets(
            {.frame = id, .frame_bytes = static_cast<std::uint32_t>(frame.size()), .present_at_ns = present_at_ns},
            frame, crc32c(frame), chunk);
    }
    std::vector<Bytes> delta_packets(std::uint32_t id, const Bytes& frame, std::uint32_t base,
                                     const Bytes& base_frame) {
        Bytes difference = frame;
        for (std::size_t i = 0; i < frame.size(); ++i) difference[i] ^= base_frame[i];
        return packets(
            {.frame = id, .flags = kFrameDelta, .base = base, .frame_bytes = static_cast<std::uint32_t>(frame.size())},
            difference, crc32c(frame), 21);
    }
    void send_frame(std::uint32_t id, const Bytes& frame, std::uint64_t present_at_ns = 0) {
        for (Bytes& packet : frame_packets(id, frame, present_at_ns)) put(std::move(packet));
    }
    void send_delta(std::uint32_t id, const Bytes& frame, std::uint32_t base, const Bytes& base_frame) {
        for (Bytes& packet : delta_packets(id, frame, base, base_frame)) put(std::move(packet));
    }
    /// Sends a keyframe, which must be accepted.
    Acknowledge accept(std::uint32_t id, const Bytes& frame, std::uint64_t present_at_ns = 0) {
        send_frame(id, frame, present_at_ns);
        const Acknowledge accepted = answer<Acknowledge>();
        REQUIRE(accepted.stage == AckStage::Accepted);
        REQUIRE(accepted.frame == id);
        return accepted;
    }
    Acknowledge present() {
        now_ns += 1'000'000;
        device.boundary(now_ns);
        const Acknowledge presented = answer<Acknowledge>();
        REQUIRE(presented.stage == AckStage::Presented);
        return presented;
    }
    NackReason refusal(std::uint32_t id) {
        const Nack nack = answer<Nack>();
        REQUIRE(nack.frame == id);
        return nack.reason;
    }
    Bytes shown() const {
        const auto page = device.shown().page;
        return {page.begin(), page.end()};
    }

private:
    std::vector<Bytes> packets(const FrameBegin& begin, const Bytes& content, std::uint32_t page_crc,
                               std::size_t chunk) {
        std::vector<Bytes> packets{next_packet(begin)};
        for (std::size_t at = 0; at < content.size(); at += chunk) {
            const auto part = std::span(content).subspan(at, std::min(chunk, content.size() - at));
            packets.push_back(next_packet(Chunk{.frame = begin.frame,
                                                .offset = static_cast<std::uint32_t>(at),
                                                .decoded_length = static_cast<std::uint32_t>(part.size()),
                                                .codec = Codec::Raw,
                                                .data = part}));
        }
        packets.push_back(next_packet(FrameEnd{.frame = begin.frame, .page_crc = page_crc}));
        return packets;
    }
};

}  // namespace xorvox::test
