#include "driver/device/receiver.h"

#include <algorithm>
#include <cstring>

#include "driver/device/lz4_block.h"

namespace xorvox::device {
namespace {

using wire::NackReason;

// A word at a time: bytes would take a microcontroller four times as long.
void xor_onto(std::span<std::byte> target, std::span<const std::byte> base) {
    using Word = std::size_t;
    std::size_t i = 0;
    for (; i + sizeof(Word) <= target.size(); i += sizeof(Word)) {
        Word a;
        Word b;
        std::memcpy(&a, target.data() + i, sizeof a);
        std::memcpy(&b, base.data() + i, sizeof b);
        a ^= b;
        std::memcpy(target.data() + i, &a, sizeof a);
    }
    for (; i < target.size(); ++i) target[i] ^= base[i];
}

Status decode_chunk(const wire::Chunk& chunk, std::span<std::byte> place) {
    switch (chunk.codec) {
        case wire::Codec::Raw:
            if (chunk.data.size() != place.size()) return Status::Corrupt;
            std::memcpy(place.data(), chunk.data.data(), place.size());
            return Status::Ok;
        case wire::Codec::Lz4: return decode_lz4_block(chunk.data, place);
    }
    return Status::Unsupported;
}

}  // namespace

NackReason Receiver::begin(const wire::FrameBegin& begin, const Pages& pages) {
    if (begin.frame_bytes != pages.frame_bytes() || (begin.flags & ~wire::kFrameDelta) != 0)
        return NackReason::BadFrame;
    const bool delta = (begin.flags & wire::kFrameDelta) != 0;
    if (delta && (pages.base() == Pages::kNone || pages.page(pages.base()).frame != begin.base)) {
        return NackReason::NeedKeyframe;
    }
    const std::uint32_t page = pages.find_free();
    if (page == Pages::kNone) return NackReason::NoPage;
    state_ = State::Receiving;
    begin_ = begin;
    page_ = page;
    covered_ = 0;
    crc_ = 0;
    return kNoRefusal;
}

NackReason Receiver::chunk(const wire::Chunk& chunk, const Pages& pages) {
    if (!is_receiving(chunk.frame) || chunk.offset != covered_) return NackReason::Gap;
    if (chunk.decoded_length > begin_.frame_bytes - covered_) return NackReason::BadChunk;
    const std::span<std::byte> place = pages.bytes(page_).subspan(chunk.offset, chunk.decoded_length);
    if (decode_chunk(chunk, place) != Status::Ok) return NackReason::BadChunk;
    if ((begin_.flags & wire::kFrameDelta) != 0) {
        xor_onto(place, pages.bytes(pages.base()).subspan(chunk.offset, chunk.decoded_length));
    }
    crc_ = wire::crc32c(place, crc_);
    covered_ += chunk.decoded_length;
    return kNoRefusal;
}

NackReason Receiver::end(const wire::FrameEnd& end, Pages& pages, std::uint64_t now_ns) {
    if (!is_receiving(end.frame) || covered_ != begin_.frame_bytes) return NackReason::Gap;
    if (crc_ != end.page_crc) return NackReason::BadCrc;
    // A frame that comes after its time is as new as one that asks for none.
    pages.accept(page_, end.frame, crc_, std::max(begin_.present_at_ns, now_ns));
    state_ = State::Finished;
    return kNoRefusal;
}

void Receiver::drop(std::uint32_t frame) {
    state_ = State::Finished;
    begin_.frame = frame;
}

}  // namespace xorvox::device
