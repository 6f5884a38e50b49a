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

/// One bit a pixel: they are those of the rows.
void copy_rows(std::span<const std::uint64_t> bits, std::uint32_t rows, std::span<std::byte> bytes) {
    const std::size_t words = bits.size() / rows;
    const std::size_t length = bytes.size() / rows;
    for (std::uint32_t i = 0; i < rows; ++i) {
        const std::uint64_t* const row = bits.data() + i * words;
        std::byte* const to = bytes.data() + i * length;
        // Word by word, as they were just written: a processor has to wait for those that are read together.
        for (std::size_t w = 0; w < length / 8; ++w) std::memcpy(to + 8 * w, row + w, 8);
        if (length % 8 != 0) std::memcpy(to + length / 8 * 8, row + length / 8, length % 8);
    }
}

template <std::size_t kBytes, class Table>
void paint_rows(const Table& eight, const std::byte* all, std::span<const std::uint64_t> bits, std::uint32_t rows,
                std::span<std::byte> bytes) {
    const std::size_t words = bits.size() / rows;
    const std::size_t length = bytes.size() / rows;
    for (std::uint32_t i = 0; i < rows; ++i) {
        paint_row<kBytes>(eight, all, bits.subspan(i * words, words), bytes.subspan(i * length, length));
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

void OneColor::paint(std::span<const std::uint64_t> bits, std::uint32_t rows, std::span<std::byte> bytes) const {
    switch (bits_) {
        case 1:
            if (code_ != 0) return copy_rows(bits, rows, bytes);
            std::ranges::fill(bytes, std::byte{0});
            return;
        case 2: return paint_rows<2>(eight_, all_.data(), bits, rows, bytes);
        case 3: return paint_rows<3>(eight_, all_.data(), bits, rows, bytes);
        case 4: return paint_rows<4>(eight_, all_.data(), bits, rows, bytes);
        case 8: return paint_rows<8>(eight_, all_.data(), bits, rows, bytes);
        case 15: return paint_rows<15>(eight_, all_.data(), bits, rows, bytes);
        case 16: return paint_rows<16>(eight_, all_.data(), bits, rows, bytes);
        default: return paint_rows<24>(eight_, all_.data(), bits, rows, bytes);
    }
}

}  // namespace xorvox::host
