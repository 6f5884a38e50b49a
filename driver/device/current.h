// CurrentLimiter: how bright a slice may be, by the bits that are lit in it.
//
// Its current is reckoned from the number of ones in each bit plane: an LED at level l of m draws l/m of led_ua while
// its row is lit, and rows are lit 1/row_groups of the time. That is the average over the slice at brightness 255; more
// brightness draws more in proportion.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "driver/display/description.h"

namespace xorvox::device {

/// driver/device/config.h computes it from a description.
struct CurrentConfig {
    PixelFormat format = PixelFormat::Mono1;
    std::uint32_t bit_planes = 1;   ///< Bits a channel that are shown, the most significant ones; 1 … 8.
    std::uint32_t row_groups = 1;   ///< At least 1.
    std::uint32_t led_ua = 0;       ///< Microamperes of one channel of one LED while it is lit; at most 2^24.
    std::uint64_t limit_ua = 0;     ///< Of the supply; 0: not limited. At most 2^48.
    std::uint8_t most_light = 255;  ///< Brightness at which an LED that is fully on reaches its longest duty.
    std::uint32_t slices = 1;       ///< Slices that are lit together: all of them where LEDs keep their colour.
    struct Rows {
        std::uint16_t columns = 0;
        std::uint16_t rows = 0;
    };
    std::uint32_t panel_count = 0;
    std::array<Rows, kMaxPanels> panels{};
};

/// Average current of a slice at brightness 255 in microamperes, rounded up. `bytes` holds config.slices slices in
/// scan-out order; 0 where it is shorter. Bits between rows do not count, nor bit planes that are not shown. Takes a
/// load, an AND and a population count for each 4 bytes and each bit of a channel.
std::uint64_t current_ua(const CurrentConfig& config, std::span<const std::byte> bytes);

/// The highest brightness, 0 … 255, at which these slices keep within limit_ua and most_light. Without a limit `bytes`
/// is not looked at.
std::uint8_t safe_brightness(const CurrentConfig& config, std::span<const std::byte> bytes);

}  // namespace xorvox::device
