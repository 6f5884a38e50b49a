#include "sim/pixel_light.h"

#include <algorithm>
#include <cmath>

namespace xorvox::sim {

std::array<Channel, 3> channels(PixelFormat format) {
    switch (format) {
        case PixelFormat::Mono1: return {{{0, 1}, {0, 1}, {0, 1}}};
        case PixelFormat::Mono2: return {{{0, 2}, {0, 2}, {0, 2}}};
        case PixelFormat::Mono4: return {{{0, 4}, {0, 4}, {0, 4}}};
        case PixelFormat::Rgb111: return {{{0, 1}, {1, 1}, {2, 1}}};
        case PixelFormat::Rgb332: return {{{5, 3}, {2, 3}, {0, 2}}};
        case PixelFormat::Rgb555: return {{{10, 5}, {5, 5}, {0, 5}}};
        case PixelFormat::Rgb565: return {{{11, 5}, {5, 6}, {0, 5}}};
        case PixelFormat::Rgb888: return {{{0, 8}, {8, 8}, {16, 8}}};
    }
    return {};
}

namespace {

double respond(const Light& light, double level) {
    switch (light.response) {
        case Response::Linear: return level;
        case Response::Gamma: return std::pow(level, light.gamma);
        case Response::Srgb: return level <= 0.04045 ? level / 12.92 : std::pow((level + 0.055) / 1.055, 2.4);
        case Response::Cie1931: {
            // CIE 15, section 8.2.1, solved for the luminance: it is a cube above the lightness 8 of 100.
            const double lightness = 100.0 * level;
            return lightness > 8.0 ? std::pow((lightness + 16.0) / 116.0, 3.0) : lightness * 27.0 / 24389.0;
        }
    }
    return 0.0;
}

}  // namespace

/// The part of the lit planes in which a channel of `shown` planes is lit: plane p is its plane p mod shown.
double PixelLight::repeated(std::uint32_t level, std::uint32_t shown) const {
    std::uint32_t lit = 0;
    for (std::uint32_t plane = 0; plane < lit_planes; ++plane) {
        lit = 2 * lit + (level >> (shown - 1 - plane % shown) & 1u);
    }
    return static_cast<double>(lit) / ((1u << lit_planes) - 1u);
}

glm::vec3 PixelLight::of(std::uint32_t code) const {
    glm::vec3 color(0.0f);
    const std::array<Channel, 3> all = channels(format);
    for (int i = 0; i < 3; ++i) {
        const auto [low, bits] = all[static_cast<std::size_t>(i)];
        const unsigned shown = std::min(bits, bit_planes);
        const std::uint32_t most = (1u << shown) - 1u;
        const std::uint32_t level = (code >> (low + bits - shown)) & most;
        const double part = lit_planes > shown ? repeated(level, shown) : static_cast<double>(level) / most;
        color[i] = static_cast<float>(respond(light, part));
    }
    return color;
}

std::uint32_t PixelLight::shown_bits() const {
    std::uint32_t shown = 0;
    for (const auto [low, bits] : channels(format)) {
        const unsigned count = std::min(bits, bit_planes);
        shown |= ((1u << count) - 1u) << (low + bits - count);
    }
    return shown;
}

}  // namespace xorvox::sim
