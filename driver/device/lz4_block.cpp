#include "driver/device/lz4_block.h"

#include <algorithm>
#include <cstring>

namespace xorvox::device {
namespace {

constexpr std::size_t kMinMatch = 4;
constexpr std::size_t kLongLength = 15;

struct Input {
    const std::byte* at;
    std::size_t left;

    std::size_t take() {
        --left;
        return std::to_integer<std::size_t>(*at++);
    }
};

// Adds the bytes that continue a length of 15. False when they are cut, or lead beyond `most`, which also keeps the sum
// from overflowing.
bool continue_length(Input& in, std::size_t& length, std::size_t most) {
    if (length != kLongLength) return length <= most;
    std::size_t more = 255;
    while (more == 255) {
        if (in.left == 0) return false;
        more = in.take();
        length += more;
        if (length > most) return false;
    }
    return true;
}

// Copies from `offset` bytes back, source and target overlapping: what is copied becomes source, so each turn can copy
// twice as much.
void copy_match(std::byte* to, std::size_t offset, std::size_t length) {
    const std::byte* const from = to - offset;
    while (length > 0) {
        const std::size_t part = std::min(length, offset);
        std::memcpy(to, from, part);
        to += part;
        offset += part;
        length -= part;
    }
}

}  // namespace

Status decode_lz4_block(std::span<const std::byte> block, std::span<std::byte> out) {
    Input in{block.data(), block.size()};
    std::size_t done = 0;
    while (in.left > 0) {
        const std::size_t token = in.take();

        std::size_t literals = token >> 4;
        if (!continue_length(in, literals, out.size() - done) || literals > in.left) return Status::Corrupt;
        if (literals > 0) std::memcpy(out.data() + done, in.at, literals);
        in.at += literals;
        in.left -= literals;
        done += literals;
        if (in.left == 0) return done == out.size() ? Status::Ok : Status::Corrupt;

        if (in.left < 2) return Status::Corrupt;
        std::size_t offset = in.take();
        offset |= in.take() << 8;
        if (offset == 0 || offset > done) return Status::Corrupt;

        std::size_t match = token & 15;
        const std::size_t room = out.size() - done;
        if (room < kMinMatch || !continue_length(in, match, room - kMinMatch)) return Status::Corrupt;
        match += kMinMatch;
        copy_match(out.data() + done, offset, match);
        done += match;
    }
    return Status::Corrupt;
}

}  // namespace xorvox::device
