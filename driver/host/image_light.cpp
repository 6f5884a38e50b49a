#include "driver/host/image_light.h"

#include <array>
#include <cmath>
#include <cstddef>

#include "driver/host/color_space.h"

namespace xorvox::host {
namespace {

glm::vec3 light_of(const std::array<std::uint8_t, 4>& code) {
    const std::array<float, 256>& light = srgb_light();
    return {light[code[0]], light[code[1]], light[code[2]]};
}

glm::vec3 mix(const glm::vec3& a, const glm::vec3& b, float share) {
    return (1.0f - share) * a + share * b;
}

/// Into 0 … 1, or a little less.
double wrapped(double u, TextureWrap wrap) {
    constexpr double kFar = 0x1p52;  // from here on all numbers are whole
    if (!(u > -kFar && u < kFar)) return 0.0;
    switch (wrap) {
        case TextureWrap::Repeat: return u - std::floor(u);
        case TextureWrap::Mirror: return 1.0 - std::abs(u - 2.0 * std::floor(u / 2.0) - 1.0);
        case TextureWrap::Clamp: break;
    }
    return u > 0.0 ? (u < 1.0 ? u : 1.0) : 0.0;
}

}  // namespace

PixelPair pixels_at(double u, std::uint32_t count, TextureWrap wrap) {
    // From the middle of the first pixel.
    const double place = wrapped(u, wrap) * count - 0.5;
    const std::uint32_t last = count - 1;
    const bool repeats = wrap == TextureWrap::Repeat;
    if (place < 0.0) return {repeats ? last : 0, 0, static_cast<float>(place + 1.0)};
    const auto first = static_cast<std::uint32_t>(place);
    if (first >= last) return {last, repeats ? 0 : last, static_cast<float>(place - last)};
    return {first, first + 1, static_cast<float>(place - first)};
}

glm::vec3 mix_pixels(const Image& image, const PixelPair& columns, const PixelPair& rows) {
    const auto pixel = [&](std::uint32_t x, std::uint32_t y) {
        return light_of(image.pixels[x + std::size_t{image.width} * y]);
    };
    const glm::vec3 upper = mix(pixel(columns.first, rows.first), pixel(columns.second, rows.first), columns.share);
    const glm::vec3 lower = mix(pixel(columns.first, rows.second), pixel(columns.second, rows.second), columns.share);
    return mix(upper, lower, rows.share);
}

}  // namespace xorvox::host
