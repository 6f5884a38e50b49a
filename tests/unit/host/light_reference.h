// The light pipeline once more, in double and with the C library: what light a code gives.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

#include "driver/display/description.h"

namespace xorvox::test {

/// The light of v = level ÷ highest level, as driver/display/description.h says.
inline double response(const Light& light, double v) {
    switch (light.response) {
        case Response::Linear: return v;
        case Response::Gamma: return std::pow(v, light.gamma);
        case Response::Srgb: return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
        case Response::Cie1931: return v <= 0.08 ? v * 2700.0 / 24389.0 : std::pow((v + 0.16) / 1.16, 3.0);
    }
    return 0.0;
}

inline const std::array kResponses{Light{Response::Linear, 2.2}, Light{Response::Gamma, 2.2},
                                   Light{Response::Gamma, 4.0}, Light{Response::Srgb, 2.2},
                                   Light{Response::Cie1931, 2.2}};

/// Of channel `index` (mono: 0) of a code: the level among those that are shown, and the highest of them.
struct Level {
    std::uint32_t level;
    std::uint32_t most;
};
inline Level level_of(const DisplayDescription& display, std::uint32_t code, int index) {
    struct Place {
        std::uint32_t shift, bits;
    };
    const auto place = [&]() -> Place {
        const bool red = index == 0;
        const bool green = index == 1;
        switch (display.format) {
            case PixelFormat::Mono1: return {0, 1};
            case PixelFormat::Mono2: return {0, 2};
            case PixelFormat::Mono4: return {0, 4};
            case PixelFormat::Rgb111: return {static_cast<std::uint32_t>(index), 1};
            case PixelFormat::Rgb332: return red ? Place{5, 3} : green ? Place{2, 3} : Place{0, 2};
            case PixelFormat::Rgb555: return red ? Place{10, 5} : green ? Place{5, 5} : Place{0, 5};
            case PixelFormat::Rgb565: return red ? Place{11, 5} : green ? Place{5, 6} : Place{0, 5};
            case PixelFormat::Rgb888: return {static_cast<std::uint32_t>(index) * 8, 8};
        }
        return {0, 1};
    }();
    const std::uint32_t planes = display.scan.bit_planes == 0 ? 8 : display.scan.bit_planes;
    const std::uint32_t shown = place.bits < planes ? place.bits : planes;
    const std::uint32_t level = code >> place.shift & ((1u << place.bits) - 1);
    return {level >> (place.bits - shown), (1u << shown) - 1};
}

/// Light of channel `index` of a code.
inline double light_of(const DisplayDescription& display, std::uint32_t code, int index) {
    const Level at = level_of(display, code, index);
    return response(display.light, static_cast<double>(at.level) / at.most);
}

/// The light that channel `index` should give: of mono formats the luminance.
inline double wanted(const DisplayDescription& display, const glm::dvec3& light, int index) {
    if (is_mono(display.format)) return 0.2126 * light.r + 0.7152 * light.g + 0.0722 * light.b;
    return light[index];
}

/// Bits first … first + count − 1.
inline std::uint32_t bits_at(std::span<const std::byte> bytes, std::size_t first, std::uint32_t count) {
    std::uint32_t value = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::size_t bit = first + i;
        value |= (std::to_integer<std::uint32_t>(bytes[bit / 8]) >> (bit % 8) & 1u) << i;
    }
    return value;
}

/// Calls visit(slice, panel, row, column, code) for every pixel of a frame, in the order of the wire.
template <class Visit>
void for_each_pixel(const DisplayDescription& display, std::span<const std::byte> frame, Visit visit) {
    const std::uint32_t bits = bits_per_pixel(display.format);
    std::size_t offset = 0;
    for (std::uint32_t slice = 0; slice < display.slices; ++slice) {
        for (std::uint32_t p = 0; p < display.panel_count; ++p) {
            for (std::uint32_t row = 0; row < display.panels[p].rows; ++row) {
                for (std::uint32_t column = 0; column < display.panels[p].columns; ++column) {
                    visit(slice, p, row, column, bits_at(frame, 8 * offset + column * bits, bits));
                }
                offset += row_bytes(display.panels[p], display.format);
            }
        }
    }
}

}  // namespace xorvox::test
