// FrameEncoder: a frame as the payloads of the packets that carry it: frame-begin, chunks, frame-end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "driver/wire/messages.h"
#include "driver/wire/packet.h"

namespace xorvox::host {

/// What the far end takes.
struct EncoderLimits {
    std::uint32_t max_packet_bytes = wire::kMinPacketBytes;  ///< kMinPacketBytes … kMaxPacketBytes.
    bool lz4 = false;
};

/// One frame to be encoded; the spans are borrowed during encode() only.
struct FrameToEncode {
    std::uint32_t id = 0;
    std::span<const std::byte> content;  ///< Not empty.
    std::uint64_t present_at_ns = 0;
    std::uint32_t base_id = 0;        ///< The frame whose content is `base`.
    std::span<const std::byte> base;  ///< As long as `content`, or empty: only a keyframe is allowed.
};

/// A message without its packet header.
struct Payload {
    wire::PacketType type{};
    std::span<const std::byte> bytes;
};

/// Every chunk decodes alone. A chunk is LZ4 where that is shorter than raw, and then holds as much of the frame, up to
/// 64 KiB, as one packet takes. The frame is an XOR onto its base where that makes fewer bytes in all.
/// Buffers are kept: after the first frames, encode() allocates nothing. One thread.
class FrameEncoder {
public:
    explicit FrameEncoder(const EncoderLimits& limits = {}) : limits_(limits) {}

    void encode(const FrameToEncode& frame);

    /// Of the last frame: how many payloads, and each of them, in the order of sending. Valid until the next encode().
    std::size_t payload_count() const { return chosen().pieces.size(); }
    Payload payload(std::size_t index) const;

    bool is_delta() const { return is_delta_; }
    std::uint32_t page_crc() const { return page_crc_; }  ///< CRC-32C of the frame.

private:
    /// Payloads one behind the other.
    struct Encoding {
        struct Piece {
            wire::PacketType type;
            std::size_t offset;
            std::size_t size;
        };
        std::vector<std::byte> bytes;
        std::vector<Piece> pieces;
    };

    void encode_as(Encoding& encoding, const FrameToEncode& frame, std::span<const std::byte> content, bool delta);
    void append_chunk(Encoding& encoding, std::uint32_t frame, std::size_t offset, std::span<const std::byte> content,
                      std::size_t& taken);
    const Encoding& chosen() const { return is_delta_ ? delta_ : key_; }

    EncoderLimits limits_;
    Encoding key_;
    Encoding delta_;
    std::vector<std::byte> difference_;
    std::uint32_t page_crc_ = 0;
    bool is_delta_ = false;
};

}  // namespace xorvox::host
