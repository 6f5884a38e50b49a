#include "sim/recording/assembler.h"

#include <algorithm>
#include <utility>

#include "driver/device/lz4_block.h"
#include "driver/wire/crc32c.h"

namespace xorvox::sim {

bool FrameAssembler::take(std::span<const std::byte> packet, std::uint64_t place) {
    wire::Header header;
    std::span<const std::byte> payload;
    if (wire::decode_packet(packet, header, payload) != Status::Ok) return false;
    if (header.type == wire::PacketType::HelloRequest) return take_hello(header, payload, place);
    const bool another = !in_session_ || header.session != session_;
    if (adopts_ && another && header.type == wire::PacketType::FrameBegin) {
        begin_session(header, place);
        hello_time_ns_ = 0;
        sequence_ = header.sequence - 1;
    }
    if (!in_session_ || header.session != session_ || !wire::is_newer(header.sequence, sequence_)) return false;
    sequence_ = header.sequence;
    switch (header.type) {
        case wire::PacketType::FrameBegin: take_begin(payload, place); return false;
        case wire::PacketType::Chunk: take_chunk(payload); return false;
        case wire::PacketType::FrameEnd: return take_end(payload);
        default: return false;
    }
}

bool FrameAssembler::take_hello(const wire::Header& header, std::span<const std::byte> payload, std::uint64_t place) {
    wire::HelloRequest hello;
    if (wire::decode(payload, hello) != Status::Ok || hello.major != wire::kMajor) return false;
    const bool repeat = in_session_ && header.session == session_ && !wire::is_newer(header.sequence, sequence_) &&
                        hello.host_time_ns <= hello_time_ns_;
    if (repeat) return false;
    begin_session(header, place);
    hello_time_ns_ = hello.host_time_ns;
    return false;
}

void FrameAssembler::begin_session(const wire::Header& header, std::uint64_t place) {
    adopts_ = false;
    receiving_ = false;
    in_session_ = true;
    session_ = header.session;
    sequence_ = header.sequence;
    hello_place_ = place;
    has_base_ = false;
}

void FrameAssembler::take_begin(std::span<const std::byte> payload, std::uint64_t place) {
    wire::FrameBegin begin;
    if (wire::decode(payload, begin) != Status::Ok) return;
    receiving_ = true;
    begin_ = begin;
    begin_place_ = place;
    covered_ = 0;
    const bool delta = (begin.flags & wire::kFrameDelta) != 0;
    const bool known = begin.frame_bytes == current_.size() && (begin.flags & ~wire::kFrameDelta) == 0;
    if (!known || (delta && (!has_base_ || begin.base != base_id_))) receiving_ = false;
}

void FrameAssembler::take_chunk(std::span<const std::byte> payload) {
    wire::Chunk chunk;
    if (!receiving_) return;
    const bool is_next = wire::decode(payload, chunk) == Status::Ok && chunk.frame == begin_.frame &&
                         chunk.offset == covered_ && chunk.decoded_length > 0 &&
                         chunk.decoded_length <= current_.size() - covered_;
    receiving_ = is_next;
    if (!is_next) return;
    const std::span<std::byte> piece = std::span(current_).subspan(covered_, chunk.decoded_length);
    if (chunk.codec == wire::Codec::Raw && chunk.data.size() == piece.size()) {
        std::ranges::copy(chunk.data, piece.begin());
    } else if (chunk.codec != wire::Codec::Lz4 || device::decode_lz4_block(chunk.data, piece) != Status::Ok) {
        receiving_ = false;
        return;
    }
    if ((begin_.flags & wire::kFrameDelta) != 0) {
        for (std::size_t i = 0; i < piece.size(); ++i) piece[i] ^= base_[covered_ + i];
    }
    covered_ += piece.size();
}

bool FrameAssembler::take_end(std::span<const std::byte> payload) {
    wire::FrameEnd end;
    if (!receiving_) return false;
    const bool whole = wire::decode(payload, end) == Status::Ok && end.frame == begin_.frame &&
                       covered_ == current_.size() && wire::crc32c(current_) == end.page_crc;
    receiving_ = false;
    if (!whole) return false;
    std::swap(base_, current_);
    has_base_ = true;
    base_id_ = begin_.frame;
    frame_ = {.id = begin_.frame,
              .keyframe = (begin_.flags & wire::kFrameDelta) == 0,
              .present_at_ns = begin_.present_at_ns,
              .hello = hello_place_,
              .begin = begin_place_,
              .bytes = base_};
    return true;
}

}  // namespace xorvox::sim
