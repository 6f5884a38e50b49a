// LightSettings: what becomes of a colour before it is a code of a pixel (docs/light.md).
//
//   colour, linear light 0 … 1
//     × gain of the sample      LightMode::Even, and the LED's calibration, channel by channel
//     × brightness
//     × white balance
//     = light wanted            mono formats: its luminance
//     → level                   the nearest in light, or dithered between the two next to it
//     → code                    the level's bits, at the top of the channel's (driver/display/description.h: Light)
#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

namespace xorvox::host {

class Calibration;

/// Which samples are lit, and how brightly, where a display has more of them in one place than in another.
///
///   Bright    Every sample that is inside is lit in full: most light, but more of it near the axis of a rotor, and
///             where planes stand or dwell closer together.
///   Uniform   Of the samples of one panel that stand in the same voxel of cartesian_grid(), only one is lit
///             (driver/host/slice_map.h): even as well as a format without levels can.
///   Even      Every sample that is inside is lit, each with a gain proportional to the space that it stands for ÷ how
///             often that space is passed in a cycle (driver/host/light_gain.h). The largest gain is 1.
enum class LightMode : std::uint8_t { Bright, Uniform, Even };

/// What happens to light between two levels of the display.
///
///   None       The nearest level in light. A set voxel is always lit, in the faintest codes of its strong channels,
///              unless its light is black.
///   Ordered    The upper or the lower level, by a threshold that depends on the sample's place, so that the mean over
///              neighbours is the light wanted (driver/host/dither.h). A set voxel between dark and the faintest level
///              may be dark.
///   Temporal   The threshold depends on the frame's number as well: the mean over kDitherPeriod frames is the light
///              wanted at every sample by itself. A set voxel may be dark in some frames, but not in all of them unless
///              its light is below 1/(2·kDitherPeriod) of the faintest level's.
enum class Dither : std::uint8_t { None, Ordered, Temporal };

struct LightSettings {
    LightMode mode = LightMode::Bright;
    Dither dither = Dither::None;
    float brightness = 1.0f;                   ///< Of all light, in proportion: 0 … 1.
    glm::vec3 white{1.0f};                     ///< Gain of red, green and blue, 0 … 1: what makes white look white.
    const Calibration* calibration = nullptr;  ///< Borrowed while a FramePainter is made; null: all LEDs are alike.
};

}  // namespace xorvox::host
