// Exposed voxels: what was sent and what was lit, voxel by voxel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include <glm/vec3.hpp>

#include "driver/display/description.h"
#include "sim/exposure.h"

namespace xorvox::sim {

/// A sample of the display that the frame lights, or that was lit.
struct ExposedVoxel {
    std::uint32_t slice = 0;
    std::uint32_t panel = 0;
    std::uint32_t row = 0;
    std::uint32_t column = 0;  ///< On the wire.
    std::uint32_t code = 0;    ///< That was sent: bits that are shown are set, or none.
    glm::vec3 sent{0.0f};      ///< Its steady light, linear, and
    glm::vec3 light{0.0f};     ///< what was lit of it, wherever that was.
    double due = 1.0;          ///< Of `sent`, in this time: Exposure::due() of its slice.
    glm::vec3 outside{0.0f};   ///< What of that was further from its sample than tolerance_mm.
    glm::dvec3 place_mm{0.0};  ///< Of the sample as it is declared.
    glm::dvec3 seen_mm{0.0};   ///< Of its light, where it was lit: of several places the furthest from the sample.
    double tolerance_mm = 0.0;
    double stray_mm = 0.0;  ///< How far its light was from its sample at most,
    double stray_slices =
        0.0;  ///< and how many slices early or late, or away through FaultKind::SwappedSlices and Phase.

    bool is_lost() const { return due > 0.0 && sent != glm::vec3(0.0f) && light == glm::vec3(0.0f); }
    bool is_extra() const { return sent == glm::vec3(0.0f) && light != glm::vec3(0.0f); }
};

/// How far light may be from its sample: as far as the display's pixel is at the beginning or at the end of its slice,
/// whichever is further, since a slice is lit for all of its time; and DisplaySamples::reach_mm.
///
/// Calls visit(voxel) for every sample of `exposure.display()` that `page` (frame_bytes() in scan-out order; empty:
/// dark), shown at `brightness`, lights, or that was lit; in scan-out order. A frame that changed while the shutter was
/// open has light that is not of `page`. Seconds for ten million voxels. Throws std::bad_alloc.
void for_each_voxel(const Exposure& exposure, std::span<const std::byte> page, std::uint8_t brightness,
                    const std::function<void(const ExposedVoxel&)>& visit);

}  // namespace xorvox::sim
