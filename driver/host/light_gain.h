// Gains: how much of its light each sample gives, so that light is even over the volume and over unlike LEDs.
//
// A sample stands for the space between it and its neighbours. A rotor's slices all last as long, but the arcs that its
// LEDs sweep in that time grow with their distance from the axis; a plane that swings dwells where it turns round. To
// be even in LightMode::Even, a sample's gain is proportional to
//
//   the space that it stands for ÷ how often that space is passed in a cycle
//
//   stacked planes   space: half of the distance between the planes below and above (at the ends: to the one neighbour)
//   swept plane      space: what the plane sweeps while the slice is lit; upward and downward sweeps light the same
//   rotating panel   space: |a| · cos(tilt) · the panel's pitches, where a is the LED's place along its panel from the
//                    foot of the axis: the volume that LED, turning, sweeps on either side of it. Where a pixel reaches
//                    over that foot, the sum of what its two parts sweep. With a panel through the axis, a is the
//                    radius. Passed by: each half of each panel that comes through the LED's circle.
//   helix            every step of height of every pixel is as large, and lit once: 1
//   free points      1
//
// and the largest gain of a display is 1.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "driver/display/description.h"
#include "driver/host/light.h"

namespace xorvox::host {

/// Gain of every pixel of slice `slice` in LightMode::Even, by what its plane stands for; 1 on other kinds.
std::vector<float> even_slice_gains(const DisplayDescription& display);

/// Gain of each pixel of a slice, in the order of the wire, by its place on a rotating panel; empty: all 1.
std::vector<float> even_pixel_gains(const DisplayDescription& display);

/// The gains of a display's samples: those of LightMode::Even, and the LEDs' calibration. Any number of threads may use
/// one.
class SampleGains {
public:
    /// `display` must be valid. Throws std::bad_alloc.
    SampleGains(const DisplayDescription& display, const LightSettings& settings);

    /// Of all pixels of `slice`.
    float of_slice(std::uint32_t slice) const { return slices_.empty() ? 1.0f : slices_[slice]; }

    /// Besides, of each pixel of `slice` in the order of the wire, channel by channel; null: all 1.
    const glm::vec3* of_pixels(std::uint32_t slice) const {
        if (tables_.empty()) return nullptr;
        const auto& table = tables_[tables_.size() == 1 ? 0 : slice];
        return table.empty() ? nullptr : table.data();
    }

private:
    std::vector<float> slices_;
    std::vector<std::vector<glm::vec3>> tables_;  ///< One for all slices, or one a slice.
};

}  // namespace xorvox::host
