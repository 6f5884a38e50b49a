#include "driver/device/current.h"

#include <algorithm>
#include <bit>

namespace xorvox::device {
namespace {

constexpr std::uint32_t kMostBits = 8;  ///< Of a channel.

/// What bit `index` of a pixel is: bit `bit` of a channel of `bits` bits.
struct PixelBit {
    std::uint32_t bits;
    std::uint32_t bit;
};

PixelBit pixel_bit(PixelFormat format, std::uint32_t index) {
    switch (format) {
        case PixelFormat::Mono1:
        case PixelFormat::Mono2:
        case PixelFormat::Mono4:
        case PixelFormat::Rgb888:
        case PixelFormat::Rgb555:
        case PixelFormat::Rgb111: break;
        case PixelFormat::Rgb332:
            if (index < 2) return {2, index};
            return {3, (index - 2) % 3};
        case PixelFormat::Rgb565:
            if (index >= 5 && index < 11) return {6, index - 5};
            return {5, index < 5 ? index : index - 11};
    }
    const std::uint32_t bits = bits_per_channel(format);
    return {bits, index % bits};
}

/// The bits of word `word` of a row that are bit `bit` of a channel of `bits` bits.
std::uint32_t plane_mask(PixelFormat format, PixelBit plane, std::uint32_t word) {
    const std::uint32_t pixel_bits = bits_per_pixel(format);
    std::uint32_t mask = 0;
    for (std::uint32_t i = 0; i < 32; ++i) {
        const PixelBit at = pixel_bit(format, (word * 32 + i) % pixel_bits);
        if (at.bits == plane.bits && at.bit == plane.bit) mask |= std::uint32_t{1} << i;
    }
    return mask;
}

std::uint32_t load(const std::byte* at, std::size_t bytes) {
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < bytes; ++i) word |= std::to_integer<std::uint32_t>(at[i]) << (8 * i);
    return word;
}

/// Ones under `mask` in words first, first + stride, … of a row of `bits` bits.
std::uint64_t count_row(const std::byte* row, std::uint32_t bits, std::uint32_t first, std::uint32_t stride,
                        std::uint32_t mask) {
    std::uint64_t count = 0;
    std::uint32_t word = first;
    for (; (word + 1) * 32 <= bits; word += stride) {
        count += static_cast<std::uint32_t>(std::popcount(load(row + 4 * word, 4) & mask));
    }
    if (word * 32 < bits) {
        const std::uint32_t left = bits - word * 32;
        const std::uint32_t whole = load(row + 4 * word, (left + 7) / 8) & mask;
        count += static_cast<std::uint32_t>(std::popcount(whole & ((std::uint32_t{1} << left) - 1)));
    }
    return count;
}

std::uint64_t count_plane(const CurrentConfig& config, const std::byte* bytes, PixelBit plane) {
    const std::uint32_t pixel_bits = bits_per_pixel(config.format);
    // After so many words pixels begin where words do again.
    const std::uint32_t period = pixel_bits >> std::min(std::countr_zero(pixel_bits), 5);
    std::uint64_t count = 0;
    for (std::uint32_t first = 0; first < period; ++first) {
        const std::uint32_t mask = plane_mask(config.format, plane, first);
        if (mask == 0) continue;
        const std::byte* row = bytes;
        for (std::uint32_t slice = 0; slice < config.slices; ++slice) {
            for (std::uint32_t p = 0; p < config.panel_count; ++p) {
                const std::uint32_t bits = config.panels[p].columns * pixel_bits;
                for (std::uint32_t r = 0; r < config.panels[p].rows; ++r, row += (bits + 7) / 8) {
                    count += count_row(row, bits, first, period, mask);
                }
            }
        }
    }
    return count;
}

std::size_t whole_bytes(const CurrentConfig& config) {
    std::size_t bytes = 0;
    for (std::uint32_t p = 0; p < config.panel_count; ++p) {
        const CurrentConfig::Rows& panel = config.panels[p];
        bytes += (std::size_t{panel.columns} * bits_per_pixel(config.format) + 7) / 8 * panel.rows;
    }
    return bytes * config.slices;
}

}  // namespace

std::uint64_t current_ua(const CurrentConfig& config, std::span<const std::byte> bytes) {
    if (bytes.size() < whole_bytes(config)) return 0;
    std::uint64_t total_ua = 0;
    for (std::uint32_t bits = 1; bits <= kMostBits; ++bits) {
        const std::uint32_t hidden = bits - std::min(bits, config.bit_planes);
        std::uint64_t levels = 0;
        for (std::uint32_t bit = hidden; bit < bits; ++bit) {
            levels += count_plane(config, bytes.data(), {bits, bit}) << (bit - hidden);
        }
        const std::uint64_t most = (std::uint64_t{1} << (bits - hidden)) - 1;
        total_ua += (levels * config.led_ua + most - 1) / most;
    }
    return (total_ua + config.row_groups - 1) / config.row_groups;
}

std::uint8_t safe_brightness(const CurrentConfig& config, std::span<const std::byte> bytes) {
    if (config.limit_ua == 0) return config.most_light;
    const std::uint64_t current = current_ua(config, bytes);
    if (current <= config.limit_ua) return config.most_light;
    return static_cast<std::uint8_t>(std::min<std::uint64_t>(255 * config.limit_ua / current, config.most_light));
}

}  // namespace xorvox::device
