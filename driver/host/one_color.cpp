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
        if (word == ~std::uint64_t{0} && at + 8 * kBytes <= bytes.size()) {
            std::memcpy(bytes.data() + at, all, 8 * kBytes);
        } else if (word != 0 && at + 8 * kBytes <= bytes.size()) {
            std::byte* to = bytes.data() + at;
            for (int i = 0; i < 8; ++i, word >>= 8, to += kBytes) std::memcpy(to, eight[word & 0xff].data(), kBytes);
        } else {
            std::size_t rest = at;
            for (; word != 0; word >>= 8, rest += kBytes) {
                std::memcpy(bytes.data() + rest, eight[word & 0xff].data(), std::min(kBytes, bytes.size() - rest));
            }
        }
        at += 8 * kBytes;
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
            if (code_ != 0) std::memcpy(bytes.data(), row.data(), bytes.size());  // padding is dark in both
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
