// Statistics: one cycle of light in numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "driver/device/device.h"
#include "driver/display/description.h"
#include "sim/optics.h"

namespace xorvox::sim {

/// Counts of one cycle, and what the device says of it.
struct Statistics {
    std::string display;            ///< Its name.
    std::size_t samples = 0;        ///< That the display declares: its pixels in one cycle.
    std::size_t places = 0;         ///< Where they stand; fewer than samples where several coincide.
    std::size_t pixels_lit = 0;     ///< Flashes.
    std::size_t voxels_lit = 0;     ///< Places that were lit.
    std::size_t light_outside = 0;  ///< Flashes that are no declared sample's.
    double coverage = 0.0;          ///< The part of the places that was lit.

    /// Flashes of a lit place, those outside not counted; zeros: nothing is lit.
    struct Visits {
        std::uint32_t least = 0;
        double mean = 0.0;
        std::uint32_t most = 0;
    };
    Visits visits;
    /// How evenly light would fill the space that is lit, were all codes equal: the most light per volume ÷ the least,
    /// over the lit places. The light of a place is its number of flashes; its volume is the sum over the samples at
    /// it, lit or not, of the space that a sample stands for (SampleVolumes). 1 is even, as are a stack of even planes,
    /// a swept plane of constant speed and a helix; a rotating panel has about r_max ÷ r_min, and a swept sine is
    /// brighter at its ends. Free points stand for no space: the most flashes ÷ the least. 0: nothing is lit. It says
    /// nothing of a frame whose samples were thinned (host::LightMode::Uniform).
    double brightness_ratio = 0.0;
    bool has_frame = false;
    std::uint32_t frame = 0;  ///< Id of the frame shown, if there is one.
    std::uint8_t brightness = 255;
    bool blank = false;
};

/// Measures `field`, the light of one cycle of a valid `display` whose device is in the state `device`. Takes a second
/// or two for five million flashes. Throws std::bad_alloc.
Statistics measure(const DisplayDescription& display, const LightField& field, const wire::DeviceStatus& device);

/// One JSON object on one line, keys always in the same order. `frame`, `visits` and `brightness_ratio` are null when
/// there is none.
std::string to_json(const Statistics& statistics);

}  // namespace xorvox::sim
