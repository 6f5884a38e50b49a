// Pixels: colours to codes, and codes to the bits of a row, as driver/display/description.h draws them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

#include "driver/display/description.h"

namespace xorvox::host {

/// Where a channel's bits are in a pixel.
struct ChannelBits {
    std::uint32_t shift = 0;
    std::uint32_t bits = 0;
};
/// Of red, green and blue; of mono formats all three are the one channel.
std::array<ChannelBits, 3> channel_bits(PixelFormat format);

/// The light of one LED that stands for a colour: its luminance, by the weights of sRGB's primaries (IEC 61966-2-1).
float luminance(const glm::vec3& linear);

/// The colour with every channel clipped to 0 … 1; what is no number is 0.
inline glm::vec3 clipped(const glm::vec3& color) {
    const auto clip = [](float value) { return value > 0.0f ? std::min(value, 1.0f) : 0.0f; };
    return {clip(color.r), clip(color.g), clip(color.b)};
}

/// The code of a linear colour in `format`, in the low bits: each channel clipped to 0 … 1 and rounded to nearest.
/// Mono1 has no levels: it is lit unless the colour is black. Mono2 and Mono4 show the colour's luminance.
std::uint32_t quantize(glm::vec3 linear, PixelFormat format);

/// As quantize, but never 0 unless the colour is black: of a colour that is too faint for the format, the strongest
/// channel and those at least half as strong become their faintest codes, so that no set voxel is lost and grey stays
/// grey. A channel that is not above zero counts as dark.
std::uint32_t visible_code(glm::vec3 linear, PixelFormat format);

/// Writes the pixel at `column` of `row`, whose bits are zero there. row.size() is at least row_bytes of the panel;
/// `code` has no bits above bits_per_pixel(format).
void put_pixel(std::span<std::byte> row, std::uint32_t column, PixelFormat format, std::uint32_t code);

}  // namespace xorvox::host
