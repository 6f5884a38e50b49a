// PixelLight: what light the code of a pixel gives.
#pragma once

#include <array>
#include <cstdint>

#include <glm/vec3.hpp>

#include "driver/display/description.h"
#include "driver/display/timing.h"

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
    /// Of displays that are lit by planes: so many are lit, and a channel that has fewer repeats its own from the most
    /// significant on. Of rgb332's three planes the two bits of blue light 4 + 1 and 2 sevenths, not 2 and 1 thirds.
    /// 0: levels are made at once.
    std::uint32_t lit_planes = 0;

    PixelLight() = default;
    explicit PixelLight(const DisplayDescription& display)
        : format(display.format),
          bit_planes(shown_bit_planes(display)),
          light(display.light),
          lit_planes(lit_by_planes(display) ? bit_planes : 0) {}

    /// Linear, 0 … 1 per channel; those of a mono format are equal. Bits above bits_per_pixel(format) do not count.
    glm::vec3 of(std::uint32_t code) const;

    /// The bits of a code that are shown: without one of them set it gives no light.
    std::uint32_t shown_bits() const;

private:
    double repeated(std::uint32_t level, std::uint32_t shown) const;
};

}  // namespace xorvox::sim
