// Packet: the frame around every message of the wire protocol. driver/PROTOCOL.md is the whole protocol.
//
//   byte  0  1   2        3     4  5   6  7     8 … 11     12 … 15    16 …          16 + length
//        'X''V'  version  type  flags  session  sequence   length     payload       CRC-32C of all before
//
// All numbers are little-endian. Freestanding.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "driver/wire/crc32c.h"
#include "voxelizer/status.h"

namespace xorvox::wire {

inline constexpr std::uint8_t kMagic0 = 'X';
inline constexpr std::uint8_t kMagic1 = 'V';
inline constexpr std::uint8_t kMajor = 1;  ///< Another major version is refused.
inline constexpr std::uint8_t kMinor = 0;  ///< A higher minor appends fields to payloads; readers skip them.
inline constexpr std::size_t kHeaderBytes = 16;
inline constexpr std::size_t kCrcBytes = 4;
inline constexpr std::size_t kPacketOverhead = kHeaderBytes + kCrcBytes;
inline constexpr std::uint32_t kMinPacketBytes = 256;    ///< Smallest max_packet that a device may declare.
inline constexpr std::uint32_t kMaxPacketBytes = 65536;  ///< Largest; header and CRC included.

/// What a packet says. Host to device below 0x80, device to host from 0x80. Never renumber.
enum class PacketType : std::uint8_t {
    HelloRequest = 0x01,
    FrameBegin = 0x02,
    Chunk = 0x03,
    FrameEnd = 0x04,
    Control = 0x05,
    Ping = 0x06,
    Hello = 0x81,
    Acknowledge = 0x82,
    Nack = 0x83,
    DeviceStatus = 0x84,
    Pong = 0x85,
};

struct Header {
    PacketType type{};
    std::uint16_t flags = 0;     ///< 0 in version 1; receivers ignore bits that they do not know.
    std::uint16_t session = 0;   ///< Chosen by the host in HelloRequest; the device answers with it and drops others.
    std::uint32_t sequence = 0;  ///< Counts the packets of a sender in a session, from 0, wrapping.
    std::uint32_t length = 0;    ///< Bytes of payload.
};

/// Whether number `a`, of a sequence or a frame, comes after `b`. Numbers wrap: it does if (a − b) mod 2³² is
/// 1 … 2³¹ − 1. Of two that are 2³¹ apart, neither comes after the other.
constexpr bool is_newer(std::uint32_t a, std::uint32_t b) {
    return static_cast<std::int32_t>(a - b) > 0;
}

/// Writes header, `payload` and CRC to the start of `out` and sets `size`. `payload` may already stand in `out` at
/// kHeaderBytes (the usual way: no copy). Header::length is taken from `payload`.
/// Ok, or OutOfMemory when `out` is smaller than payload.size() + kPacketOverhead.
Status encode_packet(const Header& header, std::span<const std::byte> payload, std::span<std::byte> out,
                     std::size_t& size);

/// Checks one whole packet and points `payload` into it.
/// Ok; Corrupt (short, trailing bytes, magic, length or CRC wrong); Unsupported (another major version: `header` is
/// set, because its layout and the CRC are the same in every version, so that any version can refuse any other).
Status decode_packet(std::span<const std::byte> packet, Header& header, std::span<const std::byte>& payload);

}  // namespace xorvox::wire
