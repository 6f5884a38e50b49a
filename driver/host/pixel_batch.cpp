#include "driver/host/pixel_batch.h"

#include <algorithm>
#include <cstring>

#include "driver/host/dither.h"
#include "driver/host/pixel.h"
#include "driver/host/set_bits.h"

namespace xorvox::host {
namespace {

/// Codes of whole bytes, at byte column · kBytes of their row.
template <std::size_t kBytes>
void write_bytes(std::span<const std::uint32_t> codes, std::byte* const* rows, const std::uint32_t* columns) {
    for (std::size_t i = 0; i < codes.size(); ++i) {
        std::byte* const at = rows[i] + std::size_t{columns[i]} * kBytes;
        for (std::size_t byte = 0; byte < kBytes; ++byte) at[byte] = static_cast<std::byte>(codes[i] >> (8 * byte));
    }
}

}  // namespace

PixelBatch::PixelBatch(const ColorField& color, const SamplePoints& points, const PixelEncoder& encoder,
                       PixelFormat format)
    : color_(color), constant_(color.constant()), sample_points_(points), encoder_(encoder), format_(format) {}

void PixelBatch::add(const PixelRow& row, std::span<const std::uint64_t> bits) {
    std::array<std::uint32_t, 64> columns;
    for (std::size_t word = 0; word < bits.size(); ++word) {
        if (bits[word] == 0) continue;
        const std::size_t count = set_bits(bits[word], static_cast<std::uint32_t>(word * 64), columns);
        if (size_ + count > kMost) flush();
        add(row, std::span(columns).first(count));
    }
}

void PixelBatch::add(const PixelRow& row, std::span<const std::uint32_t> columns) {
    if (!constant_) sample_points_.of_row(row.slice, row.panel, row.number, columns, points_.data() + size_);
    std::copy(columns.begin(), columns.end(), columns_.begin() + static_cast<std::ptrdiff_t>(size_));
    std::fill_n(rows_.begin() + static_cast<std::ptrdiff_t>(size_), columns.size(), row.bytes.data());
    if (row.gains == nullptr) {
        std::fill_n(gains_.begin() + static_cast<std::ptrdiff_t>(size_), columns.size(), row.gain);
    } else {
        for (std::size_t i = 0; i < columns.size(); ++i) gains_[size_ + i] = row.gain * row.gains[columns[i]];
    }
    is_dithered_ = row.threshold.has_value();
    if (is_dithered_) {
        for (std::size_t i = 0; i < columns.size(); ++i) {
            thresholds_[size_ + i] = dither_threshold(*row.threshold + kDitherColumnStep * columns[i]);
        }
    }
    size_ += columns.size();
}

void PixelBatch::flush() {
    const auto colors = std::span(colors_).first(size_);
    const auto codes = std::span(codes_).first(size_);
    if (constant_) {
        std::ranges::fill(colors, *constant_);
    } else {
        color_.evaluate(std::span(points_).first(size_), colors);
    }
    for (std::size_t i = 0; i < size_; ++i) colors[i] = clipped(colors[i]) * gains_[i];
    if (is_dithered_) {
        encoder_.dithered(colors, std::span(thresholds_).first(size_), codes);
    } else {
        encoder_.nearest(colors, codes);
    }
    write();
    size_ = 0;
}

void PixelBatch::write() {
    const auto codes = std::span<const std::uint32_t>(codes_).first(size_);
    switch (bits_per_pixel(format_)) {
        case 8: return write_bytes<1>(codes, rows_.data(), columns_.data());
        case 16: return write_bytes<2>(codes, rows_.data(), columns_.data());
        case 24: return write_bytes<3>(codes, rows_.data(), columns_.data());
        default: break;
    }
    const std::uint32_t bits = bits_per_pixel(format_);
    for (std::size_t i = 0; i < size_; ++i) {
        // A code of at most 15 bits reaches into three bytes at most, and only into those that it has bits in.
        const std::size_t bit = std::size_t{columns_[i]} * bits;
        std::byte* at = rows_[i] + bit / 8;
        for (std::uint32_t rest = codes[i] << (bit % 8); rest != 0; rest >>= 8) *at++ |= static_cast<std::byte>(rest);
    }
}

}  // namespace xorvox::host
