#include "driver/host/one_color.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "driver/host/pixel.h"

namespace xorvox::host {
namespace {

/// For a number of bytes that the compiler knows.
template <std::size_t kBytes, class Table>
void paint_row(const Table& eight, const std::byte* all, std::span<const std::uint64_t> row,
               std::span<std::byte> bytes) {
    std::size_t at = 0;
    for (std::uint64_t word : row) {
        std::byte* to = bytes.data() + at;
        if (at + 8 * kBytes > bytes.size()) {
            for (; at < bytes.size(); word >>= 8, at += kBytes) {
                std::memcpy(bytes.data() + at, eight[word & 0xff].data(), std::min(kBytes, bytes.size() - at));
            }
        } else if (word == 0) {
            std::memset(to, 0, 8 * kBytes);
        } else if (word == ~std::uint64_t{0}) {
            std::memcpy(to, all, 8 * kBytes);
        } else {
            for (int i = 0; i < 8; ++i, word >>= 8, to += kBytes) std::memcpy(to, eight[word & 0xff].data(), kBytes);
        }
        at += 8 * kBytes;
    }
}

/// One bit a pixel: they are the row's.
void copy_row(std::span<const std::uint64_t> row, std::span<std::byte> bytes) {
    // Word by word, as they were just written: a processor has to wait for those that are read together.
    for (const std::uint64_t word : row) {
        if (bytes.size() < sizeof word) return static_cast<void>(std::memcpy(bytes.data(), &word, bytes.size()));
        std::memcpy(bytes.data(), &word, sizeof word);
        bytes = bytes.subspan(sizeof word);
    }
}

}  // namespace

OneColor::OneColor(std::uint32_t code, PixelFormat format) : code_(code), bits_(bits_per_pixel(format)) {
    for (std::uint32_t byte = 1; byte < 256; ++byte) {
        eight_[byte] = eight_[byte & (byte - 1)];
        put_pixel(eight_[byte], static_cast<std::uint32_t>(std::countr_zero(byte)), format, code);
    }
    for (std::uint32_t i = 0; i < 8; ++i) std::copy_n(eight_[255].begin(), bits_, all_.begin() + i * bits_);
}

void OneColor::paint(std::span<const std::uint64_t> row, std::span<std::byte> bytes) const {
    switch (bits_) {
        case 1:
            if (code_ != 0) return copy_row(row, bytes);
            std::ranges::fill(bytes, std::byte{0});
            return;
        case 2: return paint_row<2>(eight_, all_.data(), row, bytes);
        case 3: return paint_row<3>(eight_, all_.data(), row, bytes);
        case 4: return paint_row<4>(eight_, all_.data(), row, bytes);
        case 8: return paint_row<8>(eight_, all_.data(), row, bytes);
        case 15: return paint_row<15>(eight_, all_.data(), row, bytes);
        case 16: return paint_row<16>(eight_, all_.data(), row, bytes);
        default: return paint_row<24>(eight_, all_.data(), row, bytes);
    }
}

}  // namespace xorvox::host
