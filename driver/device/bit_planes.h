// Bit planes: rows of pixels taken apart for binary code modulation, where bit b of every pixel is shown together, for
// 2^b times the shortest light.
//
// The planes of a row follow each other, then come those of the next row: channel by channel (red, green, blue; one for
// mono formats), of a channel the most significant first. A channel has as many planes as it has bits, at most `shown`:
// its most significant ones. Two rows of 10 pixels of rgb332 with shown = 2:
//
//   byte 0   2   4   6   8   10  12  14  …  24
//        ┌───┬───┬───┬───┬───┬───┬───┬───   ┐
//        │R2 │R1 │G2 │G1 │B1 │B0 │R2 │R1  … │      B has 2 bits in all, R and G have 3
//        └───┴───┴───┴───┴───┴───┴───┴───   ┘
//         row 0                   row 1
//
// A plane is a row of bits, column k is bit k % 8 of byte k / 8, and what is left of the last byte is zero:
//
//   byte       0                        1
//        bit   0  1  2  3  4  5  6  7   0  1  2  3  4  5  6  7
//   column     0  1  2  3  4  5  6  7   8  9  0  0  0  0  0  0
//
// A scanner that shifts two rows at once reads the same plane of both: R1 is at offset(row, 0, i), R2 at
// offset(row + rows / 2, 0, i).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "driver/display/description.h"
#include "voxelizer/status.h"

namespace xorvox::device {

/// Bits of each channel of a pixel: red, green, blue; of mono formats the first alone.
constexpr std::array<std::uint8_t, 3> channel_bits(PixelFormat format) {
    switch (format) {
        case PixelFormat::Mono1: return {1, 0, 0};
        case PixelFormat::Mono2: return {2, 0, 0};
        case PixelFormat::Mono4: return {4, 0, 0};
        case PixelFormat::Rgb111: return {1, 1, 1};
        case PixelFormat::Rgb332: return {3, 3, 2};
        case PixelFormat::Rgb555: return {5, 5, 5};
        case PixelFormat::Rgb565: return {5, 6, 5};
        case PixelFormat::Rgb888: return {8, 8, 8};
    }
    return {};
}

/// What is taken apart, and where the planes are; the drawing at the head of this file.
struct BitPlaneLayout {
    static constexpr std::uint32_t kMostColumns = 0xffff;  ///< Of a panel.

    PixelFormat format = PixelFormat::Mono1;
    std::uint32_t columns = 0;  ///< Of a row; 1 … kMostColumns.
    std::uint32_t rows = 1;     ///< One after the other, each beginning at a byte: one row, a panel's, a slice.
    std::uint32_t shown = 8;    ///< Bits a channel, 1 … 8: shown_bit_planes(display).

    constexpr std::uint32_t channel_planes(std::uint32_t channel) const {
        return std::min<std::uint32_t>(channel_bits(format)[channel], shown);
    }
    constexpr std::uint32_t row_planes() const { return channel_planes(0) + channel_planes(1) + channel_planes(2); }
    constexpr std::size_t plane_bytes() const { return (std::size_t{columns} + 7) / 8; }
    /// Of all planes of all rows; SIZE_MAX for more than that, and for more columns than may be.
    constexpr std::size_t bytes() const { return of_all_rows(std::uint64_t{row_planes()} * plane_bytes()); }
    /// Of the pixels: as on the wire. All of them as bytes().
    constexpr std::size_t pixel_row_bytes() const { return (std::size_t{columns} * bits_per_pixel(format) + 7) / 8; }
    constexpr std::size_t pixel_bytes() const { return of_all_rows(pixel_row_bytes()); }

    /// Where plane `plane` of a channel begins: 0 is the most significant, below channel_planes(channel).
    constexpr std::size_t offset(std::uint32_t row, std::uint32_t channel, std::uint32_t plane) const {
        std::size_t before = std::size_t{row} * row_planes() + plane;
        for (std::uint32_t c = 0; c < channel; ++c) before += channel_planes(c);
        return before * plane_bytes();
    }

private:
    constexpr std::size_t of_all_rows(std::uint64_t row_bytes) const {
        const std::uint64_t all = columns <= kMostColumns ? row_bytes * rows : SIZE_MAX;
        return static_cast<std::size_t>(std::min<std::uint64_t>(all, SIZE_MAX));
    }
};

/// Writes the planes of `pixels` (layout.pixel_bytes(), in scan-out order: driver/display/description.h) to `planes`
/// (layout.bytes()), all bits of them. What is behind the last pixel of a row is not looked at. The two must not
/// overlap. Ok; InvalidArgument for spans that are shorter, and for a layout that is none, with nothing written. No
/// state: from any thread or interrupt. A block of 8 pixels, or of 32 or 64 on x86 processors that have AVX2 or AVX-512
/// (found out at run time), takes a few instructions a plane.
[[nodiscard]] Status split_bit_planes(const BitPlaneLayout& layout, std::span<const std::byte> pixels,
                                      std::span<std::byte> planes);

}  // namespace xorvox::device
