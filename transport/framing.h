// Framing: whole packets over a stream of bytes (TCP, a serial line, a file), finding the way back after garbage.
//
//   byte  0     1     2    3         4   5            6 …           6 + length
//        0xE7  0x4C   length − 1     CRC-16           the packet
//                     little-endian  of bytes 0 … 3
//
// The length is 1 … 65536. The CRC is CRC-16/CCITT-FALSE (polynomial 0x1021, initial value 0xFFFF, not reflected). It
// protects the header alone, so that a damaged length cannot swallow what follows; the packet has a CRC of its own. A
// decoder that meets bytes which are no header drops them one by one until a header is right again.
// Freestanding: no allocation, nothing outside the caller's buffers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "voxelizer/status.h"

namespace xorvox::transport {

inline constexpr std::byte kFrameMagic0{0xE7};
inline constexpr std::byte kFrameMagic1{0x4C};
inline constexpr std::size_t kFrameHeaderBytes = 6;
inline constexpr std::size_t kMaxFramedBytes = 65536;  ///< The longest packet that a frame can hold.

/// Writes the header that stands before a packet of `packet_bytes`. Ok; OutOfRange unless 1 … kMaxFramedBytes.
Status encode_frame_header(std::size_t packet_bytes, std::span<std::byte, kFrameHeaderBytes> out);

/// Writes header and packet to the start of `out` and sets `size`. Ok; OutOfRange as above; OutOfMemory when `out` is
/// smaller than packet.size() + kFrameHeaderBytes.
Status encode_frame(std::span<const std::byte> packet, std::span<std::byte> out, std::size_t& size);

/// Finds packets in a stream that comes in arbitrary pieces. One thread.
class FrameDecoder {
public:
    /// `buffer` is borrowed for the decoder's life. Headers that announce a longer packet than it holds count as
    /// garbage.
    explicit FrameDecoder(std::span<std::byte> buffer) : buffer_(buffer) {}

    /// Takes bytes from the front of `input` and sets `consumed` to how many; call again with the rest.
    /// Ok: packet() is whole. WouldBlock: everything was consumed and more is needed. Corrupt: here bytes began that
    /// are no frame; said once for each run of them.
    Status feed(std::span<const std::byte> input, std::size_t& consumed);

    /// The packet that the last feed() completed; valid until the next one.
    std::span<const std::byte> packet() const { return buffer_.first(whole_ ? packet_filled_ : 0); }

    /// True in the middle of a frame: if the stream ends now, a packet is lost.
    bool partial() const { return !whole_ && header_filled_ > 0; }

    /// Forgets everything, for a new stream.
    void reset();

private:
    std::size_t announced_bytes() const;
    bool plausible() const;

    std::span<std::byte> buffer_;
    std::array<std::byte, kFrameHeaderBytes> header_{};
    std::size_t header_filled_ = 0;
    std::size_t packet_filled_ = 0;
    bool whole_ = false;
    bool in_step_ = true;
};

}  // namespace xorvox::transport
