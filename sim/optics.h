// Optics: where light is, and when, from the panels' poses. Its arithmetic is its own: it shares nothing with the
// driver's lattice and slice map, so that a mistake there shows as light in the wrong place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "driver/display/description.h"
#include "sim/faults.h"
#include "sim/pixel_light.h"

namespace xorvox::sim {

/// One pixel that was lit, at one place, for one slice.
struct Flash {
    glm::dvec3 place_mm;
    std::uint32_t code = 0;  ///< The pixel's bits as they came on the wire.
    std::uint32_t time = 0;  ///< Number of the slice on the wire: when in the cycle it was lit.
};

/// Everything that was lit in one cycle.
struct LightField {
    PixelLight pixels;              ///< What the codes mean.
    std::uint8_t brightness = 255;  ///< By which all light is dimmed, of 255.
    std::vector<Flash> flashes;
    /// Of each flash, in their order, the light that was really given (sim/exposure.h), which then counts instead of
    /// its code; or empty.
    std::vector<glm::vec3> measured;

    /// Of one of `flashes`. Linear, 0 … 1 per channel, brightness applied; measured light can be more.
    glm::vec3 light(const Flash& flash) const {
        if (!measured.empty()) return measured[static_cast<std::size_t>(&flash - flashes.data())];
        return pixels.of(flash.code) * (static_cast<float>(brightness) / 255.0f);
    }
};

/// Lights every pixel of `page` (frame_bytes(display) in scan-out order, or empty: dark) of whose code a bit that is
/// shown is set, at the place that driver/display/description.h gives it, to about 1e-12 of the display's size. A plane
/// that is lit both ways flashes once a slice, as its two flashes are one place. Dark pixels cost next to nothing.
/// `display` must be valid (validate_display), and `faults` possible on it (check_faults). Throws std::bad_alloc.
LightField expose(const DisplayDescription& display, std::span<const std::byte> page, std::uint8_t brightness,
                  const Faults& faults = {});

/// How many flashes that gives.
std::size_t count_lit(const DisplayDescription& display, std::span<const std::byte> page, const Faults& faults = {});

/// Height of the plane of a stack or of a swept plane in the middle of slice `slice`, or as long before and after it as
/// a broken number says: slice − ½ is where a swept plane's slice begins. Between the planes of a stack that are
/// uneven, as far as between their neighbours. −½ … slices − ½.
double plane_height_mm(const DisplayDescription& display, double slice);

}  // namespace xorvox::sim
