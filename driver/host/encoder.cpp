#include "driver/host/encoder.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <functional>

#include <lz4.h>

namespace xorvox::host {
namespace {

/// LZ4 looks back 64 KiB at most: longer chunks would hardly be shorter, and keep a small device busy for long.
constexpr std::size_t kMaxDecodedBytes = 64 * 1024;

/// Appends what wire::encode() makes of `message`, which takes at most `bytes`.
template <class Encoding, class Message>
void append(Encoding& encoding, wire::PacketType type, const Message& message, std::size_t bytes) {
    const std::size_t offset = encoding.bytes.size();
    encoding.bytes.resize(offset + bytes);
    std::size_t size = 0;
    const Status status = wire::encode(message, std::span(encoding.bytes).subspan(offset), size);
    assert(status == Status::Ok);
    static_cast<void>(status);
    encoding.bytes.resize(offset + size);
    encoding.pieces.push_back({type, offset, size});
}

constexpr std::size_t kFrameMessageBytes = 64;  ///< More than frame-begin or frame-end take.

}  // namespace

void FrameEncoder::encode(const FrameToEncode& frame) {
    assert(!frame.content.empty());
    assert(frame.base.empty() || frame.base.size() == frame.content.size());
    page_crc_ = wire::crc32c(frame.content);
    is_delta_ = false;
    encode_as(key_, frame, frame.content, false);
    // Raw chunks of a difference are as long as those of the frame.
    if (frame.base.empty() || !limits_.lz4) return;
    difference_.resize(frame.content.size());
    std::transform(frame.content.begin(), frame.content.end(), frame.base.begin(), difference_.begin(),
                   std::bit_xor<>());
    encode_as(delta_, frame, difference_, true);
    is_delta_ = delta_.bytes.size() < key_.bytes.size();
}

Payload FrameEncoder::payload(std::size_t index) const {
    const Encoding::Piece& piece = chosen().pieces[index];
    return {piece.type, std::span(chosen().bytes).subspan(piece.offset, piece.size)};
}

void FrameEncoder::encode_as(Encoding& encoding, const FrameToEncode& frame, std::span<const std::byte> content,
                             bool delta) {
    encoding.bytes.clear();
    encoding.pieces.clear();
    const wire::FrameBegin begin{
        .frame = frame.id,
        .flags = static_cast<std::uint8_t>(delta ? wire::kFrameDelta : 0),
        .base = delta ? frame.base_id : 0,
        .frame_bytes = static_cast<std::uint32_t>(content.size()),
        .present_at_ns = frame.present_at_ns,
    };
    append(encoding, wire::PacketType::FrameBegin, begin, kFrameMessageBytes);
    for (std::size_t offset = 0; offset < content.size();) {
        std::size_t taken = 0;
        append_chunk(encoding, frame.id, offset, content.subspan(offset), taken);
        offset += taken;
    }
    append(encoding, wire::PacketType::FrameEnd, wire::FrameEnd{.frame = frame.id, .page_crc = page_crc_},
           kFrameMessageBytes);
}

/// Appends a chunk with the first bytes of `content`, which stand at `offset` of the frame; `taken` is how many.
void FrameEncoder::append_chunk(Encoding& encoding, std::uint32_t frame, std::size_t offset,
                                std::span<const std::byte> content, std::size_t& taken) {
    const std::size_t capacity = limits_.max_packet_bytes - wire::kPacketOverhead - wire::kChunkHeaderBytes;
    wire::Chunk chunk{.frame = frame, .offset = static_cast<std::uint32_t>(offset)};

    std::array<std::byte, wire::kMaxPacketBytes> compressed;
    if (limits_.lz4) {
        int decoded = static_cast<int>(std::min(content.size(), kMaxDecodedBytes));
        const int bytes =
            LZ4_compress_destSize(reinterpret_cast<const char*>(content.data()),
                                  reinterpret_cast<char*>(compressed.data()), &decoded, static_cast<int>(capacity));
        if (bytes > 0 && bytes < decoded) {
            chunk.codec = wire::Codec::Lz4;
            chunk.decoded_length = static_cast<std::uint32_t>(decoded);
            chunk.data = std::span(compressed).first(static_cast<std::size_t>(bytes));
        }
    }
    if (chunk.codec == wire::Codec::Raw) {
        chunk.data = content.first(std::min(content.size(), capacity));
        chunk.decoded_length = static_cast<std::uint32_t>(chunk.data.size());
    }
    taken = chunk.decoded_length;
    append(encoding, wire::PacketType::Chunk, chunk, wire::kChunkHeaderBytes + chunk.data.size());
}

}  // namespace xorvox::host
