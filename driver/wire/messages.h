// Messages: the payloads, one struct each, with their encoders and decoders. driver/PROTOCOL.md draws the bytes.
//
// Fields stand in the payload in the order of the struct, little-endian, without padding. Decoders take payloads that
// are longer than they know (a later minor version) and answer Corrupt to shorter ones and to values that cannot be.
// Freestanding: nothing here allocates; spans point into the packet.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "driver/display/description.h"
#include "driver/wire/packet.h"
#include "voxelizer/status.h"

namespace xorvox::wire {

/// Codecs of a chunk, also as bits of Hello::codecs (1 << codec).
enum class Codec : std::uint8_t { Raw = 0, Lz4 = 1 };

/// Bits of Hello::features.
enum Features : std::uint32_t { kFeatureDelta = 1, kFeaturePresentAt = 2 };

/// Why the device blanked itself. Each is latched by itself until a Control ClearFault names it.
enum class Fault : std::uint8_t {
    None = 0,
    SilentHost = 1,  ///< No packet of the host for the watchdog's time.
    LateScan = 2,    ///< The scanner was still at a slice when its place had passed, or did not report it at all.
    LostIndex = 3,   ///< No index pulses, or none that fit the turn.
    Stall = 4,       ///< It turns too slowly, or stands.
    Overspeed = 5,
    Reversed = 6,   ///< It turns backwards.
    Interlock = 7,  ///< The interlock is open, or was.
};
inline constexpr std::uint8_t kHighestFault = 7;

/// The bit of `fault` in a mask of faults; none's is 0.
constexpr std::uint32_t fault_bit(Fault fault) {
    return fault == Fault::None ? 0 : std::uint32_t{1} << static_cast<unsigned>(fault);
}

/// Host to device: who are you? Starts a session; the device forgets the one before.
struct HelloRequest {
    static constexpr PacketType kType = PacketType::HelloRequest;
    std::uint8_t major = 1;
    std::uint8_t minor = 0;
    std::uint64_t host_time_ns = 0;  ///< The host's clock, echoed in Hello.
};

/// Device to host: what I am.
struct Hello {
    static constexpr PacketType kType = PacketType::Hello;
    std::uint8_t major = 1;
    std::uint8_t minor = 0;
    std::uint32_t features = 0;
    std::uint32_t boot_nonce = 0;  ///< Another one than before: the device was reset, start again.
    DisplayName serial;
    DisplayName display;  ///< Name of its display description, for messages.
    std::uint64_t geometry_digest = 0;
    PixelFormat format = PixelFormat::Mono1;
    std::uint8_t planes = 0;  ///< Bits a pixel.
    std::uint32_t frame_bytes = 0;
    std::uint8_t pages = 0;
    std::uint32_t max_packet_bytes = 0;
    std::uint32_t codecs = 1;
    Fault fault = Fault::None;    ///< Of several the one with the highest number.
    std::uint8_t free_pages = 0;  ///< Credits at the start: pages neither shown, pending nor delta base.
    std::uint64_t device_time_ns = 0;
    std::uint64_t host_time_ns = 0;  ///< HelloRequest::host_time_ns.
};

/// Bits of FrameBegin::flags.
enum FrameFlags : std::uint8_t { kFrameDelta = 1 };

/// Host to device: a frame comes. Chunks in ascending order of offset must cover it exactly once.
struct FrameBegin {
    static constexpr PacketType kType = PacketType::FrameBegin;
    std::uint32_t frame = 0;  ///< Frame id; grows by one a frame, wrapping; never that of the delta base.
    std::uint8_t flags = 0;
    std::uint32_t base = 0;  ///< With kFrameDelta: id of the last accepted frame, which the chunks are XORed onto.
    std::uint32_t frame_bytes = 0;
    std::uint64_t present_at_ns = 0;  ///< Device clock; 0: the next boundary of a turn, sweep or refresh.
};

/// Host to device: bytes offset … offset + decoded_length − 1 of the frame. Each chunk decodes alone.
struct Chunk {
    static constexpr PacketType kType = PacketType::Chunk;
    std::uint32_t frame = 0;
    std::uint32_t offset = 0;
    std::uint32_t decoded_length = 0;  ///< At least 1.
    Codec codec = Codec::Raw;
    std::span<const std::byte> data;  ///< The rest of the payload. Raw: decoded_length bytes.
};
inline constexpr std::size_t kChunkHeaderBytes = 13;

/// Host to device: the frame is whole; accept it if it is.
struct FrameEnd {
    static constexpr PacketType kType = PacketType::FrameEnd;
    std::uint32_t frame = 0;
    std::uint32_t page_crc = 0;  ///< CRC-32C of the decoded page, after a delta was applied.
};

enum class ControlOperation : std::uint8_t {
    Brightness = 1,     ///< value: 0 … 255.
    Blank = 2,          ///< value: 1 dark, 0 show again.
    SilencePolicy = 3,  ///< value: SilenceAction when the watchdog runs out.
    Watchdog = 4,       ///< value: milliseconds without a packet until the policy acts; 0 off.
    ClearFault = 5,     ///< value: the fault to clear, 1 … kHighestFault; the others stay.
    Status = 6,         ///< value: 0. The answer is a DeviceStatus.
};
enum class SilenceAction : std::uint8_t { Hold = 0, Blank = 1 };

/// Host to device: one setting or question. The answer is a DeviceStatus, or a Nack BadControl when the device does not
/// know the operation or the value is out of its range.
struct Control {
    static constexpr PacketType kType = PacketType::Control;
    ControlOperation operation{};
    std::uint32_t value = 0;
};

struct Ping {
    static constexpr PacketType kType = PacketType::Ping;
    std::uint64_t host_time_ns = 0;
};
struct Pong {
    static constexpr PacketType kType = PacketType::Pong;
    std::uint64_t host_time_ns = 0;
    std::uint64_t device_time_ns = 0;
};

enum class AckStage : std::uint8_t { Received = 1, Accepted = 2, Presented = 3 };

/// Device to host: how far a frame has come. Received: frame end is in, but the check takes time (driver/device checks
/// as it receives and never says so); Accepted: checked, it will be shown unless a later one is due before a boundary
/// comes; Presented: it is being shown, from device_time_ns on.
struct Acknowledge {
    static constexpr PacketType kType = PacketType::Acknowledge;
    AckStage stage{};
    std::uint32_t frame = 0;
    std::uint32_t page_crc = 0;  ///< Digest of the page as decoded.
    std::uint8_t free_pages = 0;
    std::uint64_t device_time_ns = 0;
};

enum class NackReason : std::uint8_t {
    NeedKeyframe = 1,  ///< The delta base is not here.
    NoPage = 2,        ///< Sent without credit.
    Gap = 3,           ///< A chunk is missing, repeated or out of order.
    BadChunk = 4,      ///< A chunk does not decode to its length, or leaves the page.
    BadCrc = 5,        ///< The page's CRC differs from frame-end's.
    BadFrame = 6,      ///< frame_bytes or flags are not this display's.
    BadControl = 7,    ///< Unknown operation, or a value out of range.
    BadVersion = 8,    ///< HelloRequest of another major version.
};

/// Device to host: frame dropped whole (or the request refused); the next frame must be a keyframe.
struct Nack {
    static constexpr PacketType kType = PacketType::Nack;
    NackReason reason{};
    std::uint32_t frame = 0;  ///< 0 when no frame is meant.
    std::uint8_t free_pages = 0;
    std::uint64_t device_time_ns = 0;
};

struct DeviceStatus {
    static constexpr PacketType kType = PacketType::DeviceStatus;
    std::uint8_t brightness = 255;
    std::uint8_t blank = 0;  ///< 1: dark, by command, policy or fault.
    SilenceAction silence_action = SilenceAction::Blank;
    std::uint32_t watchdog_ms = 0;
    Fault fault = Fault::None;      ///< As in Hello.
    std::uint32_t shown_frame = 0;  ///< Id of the frame being shown; valid if has_frame.
    std::uint8_t has_frame = 0;
    std::uint32_t shown_crc = 0;  ///< Digest of the page being shown.
    std::uint8_t free_pages = 0;
    std::uint32_t frames_accepted = 0;
    std::uint32_t frames_dropped = 0;
    std::uint32_t packets_bad = 0;  ///< Packets that decode_packet refused, and damage that the link reported.
    std::uint64_t device_time_ns = 0;
    std::uint32_t faults = 0;  ///< fault_bit() of every fault that is latched.
};

/// Writes `message` to the start of `out` and sets `size`. Ok, or OutOfMemory when `out` is too small (for Chunk:
/// kChunkHeaderBytes + data.size(); data may already stand in its place).
Status encode(const HelloRequest& message, std::span<std::byte> out, std::size_t& size);
Status encode(const Hello& message, std::span<std::byte> out, std::size_t& size);
Status encode(const FrameBegin& message, std::span<std::byte> out, std::size_t& size);
Status encode(const Chunk& message, std::span<std::byte> out, std::size_t& size);
Status encode(const FrameEnd& message, std::span<std::byte> out, std::size_t& size);
Status encode(const Control& message, std::span<std::byte> out, std::size_t& size);
Status encode(const Ping& message, std::span<std::byte> out, std::size_t& size);
Status encode(const Pong& message, std::span<std::byte> out, std::size_t& size);
Status encode(const Acknowledge& message, std::span<std::byte> out, std::size_t& size);
Status encode(const Nack& message, std::span<std::byte> out, std::size_t& size);
Status encode(const DeviceStatus& message, std::span<std::byte> out, std::size_t& size);

/// Writes `message` as one whole packet to the start of `out` and sets `size`. Ok, or OutOfMemory when `out` is too
/// small.
template <class Message>
Status encode_packet(std::uint16_t session, std::uint32_t sequence, const Message& message, std::span<std::byte> out,
                     std::size_t& size) {
    if (out.size() < kPacketOverhead) return Status::OutOfMemory;
    const std::span<std::byte> place = out.subspan(kHeaderBytes, out.size() - kPacketOverhead);
    std::size_t length = 0;
    if (const Status status = encode(message, place, length); status != Status::Ok) return status;
    const Header header{.type = Message::kType, .session = session, .sequence = sequence};
    return encode_packet(header, place.first(length), out, size);
}

/// Reads a payload. Ok or Corrupt; bytes after the last known field are skipped.
Status decode(std::span<const std::byte> payload, HelloRequest& message);
Status decode(std::span<const std::byte> payload, Hello& message);
Status decode(std::span<const std::byte> payload, FrameBegin& message);
Status decode(std::span<const std::byte> payload, Chunk& message);
Status decode(std::span<const std::byte> payload, FrameEnd& message);
Status decode(std::span<const std::byte> payload, Control& message);
Status decode(std::span<const std::byte> payload, Ping& message);
Status decode(std::span<const std::byte> payload, Pong& message);
Status decode(std::span<const std::byte> payload, Acknowledge& message);
Status decode(std::span<const std::byte> payload, Nack& message);
Status decode(std::span<const std::byte> payload, DeviceStatus& message);

}  // namespace xorvox::wire
