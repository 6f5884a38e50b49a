// What liblz4 makes of a block, for comparison with decode_lz4_block.
#pragma once

#include <lz4.h>

#include <cstddef>
#include <span>
#include <vector>

#include "driver/device/lz4_block.h"

namespace xorvox::test {

/// True when a sequence of a well-formed `block` has the offset zero: liblz4 takes it, the format forbids it.
inline bool has_zero_offset(std::span<const std::byte> block) {
    std::size_t at = 0;
    const auto take = [&] { return at < block.size() ? std::to_integer<std::size_t>(block[at++]) : std::size_t{0}; };
    const auto length = [&](std::size_t start) {
        for (std::size_t more = start == 15 ? 255 : 0; more == 255;) start += more = take();
        return start;
    };
    while (at < block.size()) {
        const std::size_t token = take();
        at += length(token >> 4);
        if (at >= block.size()) return false;
        if (const std::size_t low = take(); (low | take()) == 0) return true;
        (void)length(token & 15);
    }
    return false;
}

/// False when the two decoders disagree: liblz4 takes `block` as exactly `length` bytes and ours does not, or gives
/// other bytes; or ours writes outside.
inline bool agrees_with_liblz4(std::span<const std::byte> block, std::size_t length) {
    constexpr std::size_t kGuard = 32;
    constexpr std::byte kMark{0xA5};
    std::vector<std::byte> theirs(length);
    const int size =
        LZ4_decompress_safe(reinterpret_cast<const char*>(block.data()), reinterpret_cast<char*>(theirs.data()),
                            static_cast<int>(block.size()), static_cast<int>(length));
    std::vector<std::byte> ours(length + 2 * kGuard, kMark);
    const std::span<std::byte> place = std::span(ours).subspan(kGuard, length);
    const Status status = device::decode_lz4_block(block, place);
    for (std::size_t i = 0; i < kGuard; ++i) {
        if (ours[i] != kMark || ours[kGuard + length + i] != kMark) return false;
    }
    if (size < 0 || static_cast<std::size_t>(size) != length) return true;
    if (status != Status::Ok) return has_zero_offset(block);
    return std::equal(place.begin(), place.end(), theirs.begin());
}

}  // namespace xorvox::test
