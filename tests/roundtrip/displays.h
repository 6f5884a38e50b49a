// Displays of the round trip: every preset, and odd ones that have what no preset has.
#pragma once

#include <string>
#include <vector>

#include "driver/display/toml.h"

namespace xorvox::test {

/// Above so many samples a display takes part in its own pixel format only, over loopback, without faults.
inline constexpr std::size_t kLarge = 10'000'000;
/// Above so many, it meets the faults of links in its own format only.
inline constexpr std::size_t kMiddling = 50'000;

/// Small displays, each with another name: rows that end within a byte, no symmetry, and every pose, motion and
/// mounting in use.
std::vector<DisplayFile> odd_displays();

/// All presets of at most kLarge samples, or all that are larger.
std::vector<DisplayFile> small_presets();
std::vector<DisplayFile> large_presets();

/// The display in another pixel format. Its scan is made for its own: for another one nothing is said of it.
DisplayFile in_format(DisplayFile display, PixelFormat format);

}  // namespace xorvox::test
