// Optics: where light is, and when, from the panels' poses. Its arithmetic is its own: it shares nothing with the
// driver's lattice and slice map, so that a mistake there shows as light in the wrong place.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "driver/display/description.h"

namespace xorvox::sim {

/// One pixel that was lit, at one place, for one slice.
struct Flash {
    glm::dvec3 place_mm;
    glm::vec3 light;         ///< Linear, 0 … 1 per channel, brightness applied.
    std::uint32_t code = 0;  ///< The pixel's bits as they came on the wire.
    std::uint32_t time = 0;  ///< Number of the slice interval in the cycle.
};

/// Everything that was lit in one cycle.
struct LightField {
    std::vector<Flash> flashes;
};

/// How a display can be put together wrongly; faults for tests. Nothing by default.
struct Misbuild {
    std::int32_t swap_a = -1;  ///< Planes (stacked) or slices (rotating) a and b swapped; both −1: none.
    std::int32_t swap_b = -1;
    std::int32_t mirrored_panel = -1;  ///< Columns of this panel run the other way.
    std::int32_t phase_slices = 0;     ///< The index mark, or the plane counter of a stack, is off by so many slices.
};

/// Lights every pixel of `page` (frame_bytes(display) in scan-out order, or empty: dark) that is not zero.
LightField expose(const DisplayDescription& display, std::span<const std::byte> page, std::uint8_t brightness,
                  const Misbuild& misbuild = {});

}  // namespace xorvox::sim
