// Frames that show whether they are whole: made from a number and a tag, with a checksum over all of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "driver/host/framebuffer.h"
#include "driver/wire/crc32c.h"

namespace xorvox::test {

/// The tag that goes with frame number `sequence`.
inline std::uint64_t tag_of(std::uint32_t sequence) {
    return sequence * 0x9e37'79b9'7f4a'7c15u;
}

/// Fills `bytes`, a multiple of 8 and 16 or more: words that the number determines, the number,
/// CRC-32C of all before.
inline void write_checksummed(std::span<std::byte> bytes, std::uint32_t sequence) {
    std::uint64_t word = tag_of(sequence);
    for (std::size_t at = 0; at + 8 < bytes.size(); at += 8) {
        std::memcpy(bytes.data() + at, &word, 8);
        word = word * 6364136223846793005u + 1442695040888963407u;
    }
    std::memcpy(bytes.data() + bytes.size() - 8, &sequence, 4);
    const std::uint32_t crc = wire::crc32c(bytes.first(bytes.size() - 4));
    std::memcpy(bytes.data() + bytes.size() - 4, &crc, 4);
}

/// Whether `frame` is the one that write_checksummed() made for its number, and its tag the right one.
inline bool is_whole(const host::Frame& frame) {
    std::uint64_t first = 0;
    std::uint32_t sequence = 0;
    std::uint32_t crc = 0;
    std::memcpy(&first, frame.bytes.data(), 8);
    std::memcpy(&sequence, frame.bytes.data() + frame.bytes.size() - 8, 4);
    std::memcpy(&crc, frame.bytes.data() + frame.bytes.size() - 4, 4);
    return sequence == frame.sequence && frame.tag == tag_of(sequence) && first == frame.tag &&
           crc == wire::crc32c(frame.bytes.first(frame.bytes.size() - 4));
}

}  // namespace xorvox::test
