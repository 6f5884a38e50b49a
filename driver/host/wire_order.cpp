#include "driver/host/wire_order.h"

#include <algorithm>
#include <array>

namespace xorvox::host {
namespace {

/// The 64 bits of `from` that begin at bit `first`; zero beyond its end.
std::uint64_t bits_at(std::span<const std::uint64_t> from, std::size_t first) {
    const std::size_t word = first / 64;
    const std::size_t shift = first % 64;
    std::uint64_t bits = from[word] >> shift;
    if (shift != 0 && word + 1 < from.size()) bits |= from[word + 1] << (64 - shift);
    return bits;
}

/// Bits that are no pixels, at the end of a row, are cleared.
void clear_padding(std::span<std::uint64_t> row, std::uint32_t count) {
    if (count % 64 != 0) row.back() &= (std::uint64_t{1} << (count % 64)) - 1;
}

/// `count` bits of `from`, beginning at bit `first`, to `to`, which they fill.
void copy_bits(std::span<const std::uint64_t> from, std::uint32_t first, std::uint32_t count,
               std::span<std::uint64_t> to) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = bits_at(from, first + i * 64);
    clear_padding(to, count);
}

std::uint64_t reversed(std::uint64_t word) {
    constexpr std::uint64_t kOdd = 0x5555555555555555, kPairs = 0x3333333333333333, kNibbles = 0x0f0f0f0f0f0f0f0f;
    word = ((word >> 1) & kOdd) | ((word & kOdd) << 1);
    word = ((word >> 2) & kPairs) | ((word & kPairs) << 2);
    word = ((word >> 4) & kNibbles) | ((word & kNibbles) << 4);
    return __builtin_bswap64(word);
}

/// The order of the first `count` bits of `row`, which are all that it has, is turned round.
void reverse_bits(std::span<std::uint64_t> row, std::uint32_t count) {
    std::ranges::reverse(row);
    for (std::uint64_t& word : row) word = reversed(word);
    if (count % 64 == 0) return;
    const std::uint32_t padding = 64 - count % 64;
    for (std::size_t i = 0; i < row.size(); ++i) {
        row[i] = row[i] >> padding | (i + 1 < row.size() ? row[i + 1] << (64 - padding) : 0);
    }
}

/// Bit j of word i goes to bit i of word j.
void transpose(std::array<std::uint64_t, 64>& block) {
    std::uint64_t mask = 0x00000000ffffffff;
    for (std::uint32_t half = 32; half != 0; half /= 2, mask ^= mask << half) {
        for (std::uint32_t i = 0; i < 64; i = (i + half + 1) & ~half) {
            const std::uint64_t swapped = (block[i] >> half ^ block[i + half]) & mask;
            block[i] ^= swapped << half;
            block[i + half] ^= swapped;
        }
    }
}

}  // namespace

WireOrder::WireOrder(const DisplayDescription& display, const DisplayLattice& lattice)
    : display_(display), lattice_(lattice), shape_(Shape::Flat) {
    if (display.kind == DisplayKind::Helix) shape_ = Shape::Helix;
    if (display.kind == DisplayKind::FreePoints) shape_ = Shape::Pixels;
    if (display.kind == DisplayKind::RotatingPanel) shape_ = is_upright(display) ? Shape::Upright : Shape::Pixels;
    for (std::uint32_t p = 1; p < display.panel_count; ++p) {
        const Panel& before = display.panels[p - 1];
        first_x_[p] = first_x_[p - 1] + (shape_ == Shape::Upright ? upright_columns(before)
                                                                  : std::uint32_t{before.columns} * before.rows);
    }
}

std::uint32_t WireOrder::helix_k(std::uint32_t slice, std::size_t column) const {
    const std::uint32_t first = lattice_.helix_k()[column];
    const std::uint32_t k = first + (display_.clockwise ? slice : display_.slices - slice);
    return k < display_.slices ? k : k - display_.slices;
}

Sample WireOrder::sample(std::uint32_t slice, std::uint32_t panel, std::uint32_t row, std::uint32_t column) const {
    const Panel& p = display_.panels[panel];
    switch (shape_) {
        case Shape::Flat: return {column, row, slice};
        case Shape::Helix: return {column, row, helix_k(slice, std::size_t{row} * p.columns + column)};
        case Shape::Pixels: return {first_x_[panel] + row * p.columns + column, slice, 0};
        case Shape::Upright: {
            const UprightPixel pixel = upright_pixel(p, column, row);
            return {first_x_[panel] + pixel.column, slice, pixel.row};
        }
    }
    return {};
}

std::span<std::uint64_t> WireOrder::fetch(ConstBitVolumeView volume, std::uint32_t slice, std::uint32_t panel,
                                          std::uint32_t first, std::uint32_t count,
                                          std::span<std::uint64_t, kMostRows * kMostWords> out) const {
    const Panel& p = display_.panels[panel];
    const auto rows = out.first(row_words(p.columns) * count);
    switch (shape_) {
        case Shape::Flat: fetch_flat(volume, slice, first, rows); break;
        case Shape::Helix: fetch_helix(volume, slice, first, rows); break;
        case Shape::Pixels: fetch_pixels(volume, slice, panel, first, rows); break;
        case Shape::Upright:
            if (p.turned % 2 == 0) {
                fetch_standing(volume, slice, panel, first, rows);
            } else {
                fetch_on_its_side(volume, slice, panel, first, rows);
            }
            break;
    }
    return rows;
}

void WireOrder::fetch_flat(ConstBitVolumeView volume, std::uint32_t slice, std::uint32_t first,
                           std::span<std::uint64_t> out) const {
    const std::size_t row = std::size_t{slice} * volume.ny + first;
    std::ranges::copy(volume.words.subspan(row * row_words(volume.nx), out.size()), out.begin());
}

void WireOrder::fetch_helix(ConstBitVolumeView volume, std::uint32_t slice, std::uint32_t first,
                            std::span<std::uint64_t> out) const {
    std::ranges::fill(out, 0);
    const std::size_t words = row_words(volume.nx);
    for (std::size_t row = 0; row * words < out.size(); ++row) {
        const auto y = static_cast<std::uint32_t>(first + row);
        for (std::uint32_t x = 0; x < volume.nx; ++x) {
            const std::uint64_t lit = volume.test(x, y, helix_k(slice, std::size_t{y} * volume.nx + x)) ? 1 : 0;
            out[row * words + x / 64] |= lit << (x % 64);
        }
    }
}

void WireOrder::fetch_pixels(ConstBitVolumeView volume, std::uint32_t slice, std::uint32_t panel, std::uint32_t first,
                             std::span<std::uint64_t> out) const {
    const Panel& p = display_.panels[panel];
    const std::size_t words = row_words(p.columns);
    const std::span<const std::uint64_t> pixels = volume.row(slice, 0);
    for (std::uint32_t row = first; !out.empty(); ++row, out = out.subspan(words)) {
        copy_bits(pixels, first_x_[panel] + row * p.columns, p.columns, out.first(words));
    }
}

// The two below are upright_pixel() for whole rows.

void WireOrder::fetch_standing(ConstBitVolumeView volume, std::uint32_t slice, std::uint32_t panel, std::uint32_t first,
                               std::span<std::uint64_t> out) const {
    const Panel& p = display_.panels[panel];
    const std::size_t words = row_words(p.columns);
    const bool upside_down = p.turned == 2;
    for (std::uint32_t row = first; !out.empty(); ++row, out = out.subspan(words)) {
        const std::uint32_t k = upside_down ? row : p.rows - 1 - row;
        copy_bits(volume.row(slice, k), first_x_[panel], p.columns, out.first(words));
        if (p.mirrored != upside_down) reverse_bits(out.first(words), p.columns);
    }
}

void WireOrder::fetch_on_its_side(ConstBitVolumeView volume, std::uint32_t slice, std::uint32_t panel,
                                  std::uint32_t first, std::span<std::uint64_t> out) const {
    const Panel& p = display_.panels[panel];
    const std::size_t words = row_words(p.columns);
    const auto count = static_cast<std::uint32_t>(out.size() / words);
    // Heights become the columns of the wire, upright columns its rows.
    const bool from_right = p.turned == 3;
    const std::uint32_t leftmost = from_right ? p.rows - first - count : first;
    for (std::uint32_t k = 0; k < p.columns; k += 64) {
        std::array<std::uint64_t, 64> block{};
        const std::uint32_t heights = std::min(64u, p.columns - k);
        for (std::uint32_t i = 0; i < heights; ++i)
            block[i] = bits_at(volume.row(slice, k + i), first_x_[panel] + leftmost);
        transpose(block);
        for (std::uint32_t row = 0; row < count; ++row) {
            out[row * words + k / 64] = block[from_right ? count - 1 - row : row];
        }
    }
    if (p.mirrored == from_right) return;
    for (; !out.empty(); out = out.subspan(words)) reverse_bits(out.first(words), p.columns);
}

}  // namespace xorvox::host
