// PixelLight: what light the code of a pixel gives.
#pragma once

#include <array>
#include <cstdint>

#include <glm/vec3.hpp>

#include "driver/display/description.h"

namespace xorvox::sim {

/// Where a channel is in a code.
struct Channel {
    unsigned low = 0;
    unsigned bits = 0;
};
/// Red, green and blue; of mono formats three times the one that there is.
std::array<Channel, 3> channels(PixelFormat format);

/// How a display's pixels make light of codes. Any number of threads may use one.
struct PixelLight {
    PixelFormat format = PixelFormat::Mono1;
    std::uint32_t bit_planes = 8;  ///< Bits a channel that are shown, the most significant ones; more are all.
    Light light;                   ///< Of a level, which is that of the shown bits ÷ the highest they can have.

    PixelLight() = default;
    explicit PixelLight(const DisplayDescription& display)
        : format(display.format), bit_planes(shown_bit_planes(display)), light(display.light) {}

    /// Linear, 0 … 1 per channel; those of a mono format are equal. Bits above bits_per_pixel(format) do not count.
    glm::vec3 of(std::uint32_t code) const;

    /// The bits of a code that are shown: without one of them set it gives no light.
    std::uint32_t shown_bits() const;
};

}  // namespace xorvox::sim
