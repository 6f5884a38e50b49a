#include "driver/host/pixel.h"

#include <algorithm>

namespace xorvox::host {
namespace {

/// Written so that a NaN is dark.
std::uint32_t level(float value, const ChannelBits& channel) {
    const auto most = static_cast<float>((1u << channel.bits) - 1);
    const float clipped = value > 0.0f ? std::min(value, 1.0f) : 0.0f;
    return static_cast<std::uint32_t>(clipped * most + 0.5f) << channel.shift;
}

bool is_black(const glm::vec3& color) {
    return !(color.r > 0.0f || color.g > 0.0f || color.b > 0.0f);
}

}  // namespace

std::array<ChannelBits, 3> channel_bits(PixelFormat format) {
    switch (format) {
        case PixelFormat::Mono1:
        case PixelFormat::Mono2:
        case PixelFormat::Mono4: break;
        case PixelFormat::Rgb111: return {{{0, 1}, {1, 1}, {2, 1}}};
        case PixelFormat::Rgb332: return {{{5, 3}, {2, 3}, {0, 2}}};
        case PixelFormat::Rgb555: return {{{10, 5}, {5, 5}, {0, 5}}};
        case PixelFormat::Rgb565: return {{{11, 5}, {5, 6}, {0, 5}}};
        case PixelFormat::Rgb888: return {{{0, 8}, {8, 8}, {16, 8}}};
    }
    const ChannelBits gray{0, bits_per_pixel(format)};
    return {gray, gray, gray};
}

float luminance(const glm::vec3& linear) {
    return 0.2126f * linear.r + 0.7152f * linear.g + 0.0722f * linear.b;
}

std::uint32_t quantize(glm::vec3 linear, PixelFormat format) {
    if (format == PixelFormat::Mono1) return is_black(linear) ? 0 : 1;
    const auto [red, green, blue] = channel_bits(format);
    if (is_mono(format)) return level(luminance(clipped(linear)), red);
    return level(linear.r, red) | level(linear.g, green) | level(linear.b, blue);
}

std::uint32_t visible_code(glm::vec3 linear, PixelFormat format) {
    const std::uint32_t code = quantize(linear, format);
    if (code != 0 || is_black(linear)) return code;
    if (is_mono(format)) return 1;
    const auto [red, green, blue] = channel_bits(format);
    // A NaN is dark here, too: it compares false.
    float strongest = 0.0f;
    for (int i = 0; i < 3; ++i) strongest = linear[i] > strongest ? linear[i] : strongest;
    const auto lit = [&](float value, const ChannelBits& channel) {
        return value >= 0.5f * strongest ? 1u << channel.shift : 0u;
    };
    return lit(linear.r, red) | lit(linear.g, green) | lit(linear.b, blue);
}

void put_pixel(std::span<std::byte> row, std::uint32_t column, PixelFormat format, std::uint32_t code) {
    const std::size_t bit = std::size_t{column} * bits_per_pixel(format);
    std::size_t byte = bit / 8;
    for (std::uint32_t rest = code << (bit % 8); rest != 0; rest >>= 8) {
        row[byte++] |= static_cast<std::byte>(rest & 0xff);
    }
}

}  // namespace xorvox::host
