// Modulation: when the rows and bit planes of a slice are lit. Scanners keep to it, and so does the simulator.
//
// Rows are lit in G groups, one after the other; group g are the rows r of every panel with r mod G = g. Of each group,
// P bit planes are lit, the most significant first, plane p for on_ns(p): binary code modulation. While one is lit, the
// data of the next are shifted in.
//
//        shift    on(0)          on(1)        on(0)
//   OE ┌────────┐      ┌────────┐    ┌──────┐      ┌──     dark is high
//      │        └──────┘        └────┘      └──────┘
//      begin    │◄── slot(0) ──►│◄ slot(1) ►│
//               group 0,        group 0,    group 1,
//               plane 0         plane 1     plane 0
//
// A slot is the longer of on and shift, and then the gap: LEDs fall, rows change, data are latched. LEDs that need time
// to rise and fall give the light of on − rise/2 + fall/2; that is made up for, so that plane p gives half the light of
// plane p − 1, exactly but for a half of a nanosecond. The shortest light, `unit_ns`, is the longest with which the
// slots fill the slice's time, and no shorter than rise and fall together: every LED that is lit is fully lit for a
// while. Brightness makes a strobe shorter, not its slot; a dim one may be shorter than the rise.
//
// The time that the shortest of all modulations takes is told by scan_time_ns() too (driver/display/timing.h), by which
// descriptions are refused that have no time for it.
//
// Integers only; freestanding.
#pragma once

#include <algorithm>
#include <cstdint>

#include "driver/display/description.h"

namespace xorvox::device {

/// What the modulation must know of a display; modulation_config() computes it.
struct ModulationConfig {
    std::uint32_t row_groups = 1;
    std::uint32_t planes = 1;    ///< 1 … 8.
    std::uint64_t shift_ns = 0;  ///< To shift in the data of one group and plane.
    std::uint64_t latch_ns = 0;
    std::uint64_t rise_ns = 0;
    std::uint64_t fall_ns = 0;
    std::uint64_t min_on_ns = 0;
};

/// The slots of one slice.
struct Modulation {
    std::uint32_t row_groups = 1;
    std::uint32_t planes = 1;  ///< That are lit: the most significant ones, fewer where there is no time for all.
    std::uint64_t shift_ns = 0;
    std::uint64_t gap_ns = 0;   ///< From the end of a slot's light, and of the next one's data, to the next light.
    std::uint64_t unit_ns = 0;  ///< Light of the least plane, as if LEDs had neither rise nor fall.
    std::uint64_t rise_ns = 0;
    std::uint64_t fall_ns = 0;

    /// For how long plane `plane` (0: the most significant) has its output enabled, at `brightness` of 255.
    constexpr std::uint64_t on_ns(std::uint32_t plane, std::uint8_t brightness = 255) const {
        const std::uint64_t light = (unit_ns << (planes - 1 - plane)) * brightness / 255;
        if (light == 0) return 0;
        const std::uint64_t longer = light + rise_ns / 2;
        return longer > fall_ns / 2 ? longer - fall_ns / 2 : 1;
    }
    constexpr std::uint64_t slot_ns(std::uint32_t plane) const { return std::max(on_ns(plane), shift_ns) + gap_ns; }
    /// From the beginning of the slice's scan to the first light.
    constexpr std::uint64_t first_ns() const { return shift_ns + gap_ns; }
    /// All of it, from the beginning to the end of the last slot.
    constexpr std::uint64_t total_ns() const {
        std::uint64_t group = 0;
        for (std::uint32_t plane = 0; plane < planes; ++plane) group += slot_ns(plane);
        return first_ns() + group * row_groups;
    }
};

/// The modulation of a slice that has `available_ns`. Where even one plane of the shortest light is too long for it,
/// the scan will be cut. Some hundred steps.
constexpr Modulation modulate(const ModulationConfig& config, std::uint64_t available_ns) {
    Modulation made;
    made.row_groups = config.row_groups;
    made.shift_ns = config.shift_ns;
    made.gap_ns = config.latch_ns + config.fall_ns;
    made.rise_ns = config.rise_ns;
    made.fall_ns = config.fall_ns;
    const std::uint64_t least = std::max({config.min_on_ns, config.rise_ns + config.fall_ns, std::uint64_t{1}});
    for (made.planes = config.planes; made.planes >= 1; --made.planes) {
        made.unit_ns = least;
        if (made.total_ns() <= available_ns) break;
        if (made.planes == 1) return made;
    }
    std::uint64_t too_long = std::max(available_ns, least) + 1;
    while (too_long - made.unit_ns > 1) {
        Modulation tried = made;
        tried.unit_ns = made.unit_ns + (too_long - made.unit_ns) / 2;
        if (tried.total_ns() <= available_ns) {
            made = tried;
        } else {
            too_long = tried.unit_ns;
        }
    }
    return made;
}

/// Of a valid display whose planes are lit one by one: HUB75, 74HC595, or LEDs on lines of their own.
constexpr ModulationConfig modulation_config(const DisplayDescription& display) {
    ModulationConfig config;
    const Scan& scan = display.scan;
    config.row_groups = scan.row_groups;
    config.planes = shown_bit_planes(display);
    config.latch_ns = scan.latch_ns;
    config.rise_ns = scan.rise_ns;
    config.fall_ns = scan.fall_ns;
    config.min_on_ns = scan.min_on_ns;
    if (scan.pixel_clock_hz == 0 || scan.driver == DriverChip::Direct) return config;
    std::uint64_t most = 0;
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        std::uint64_t pixels = 0;
        for (std::uint32_t q = 0; q < display.panel_count; ++q) {
            const Panel& panel = display.panels[q];
            if (panel.connector == display.panels[p].connector) pixels += std::uint64_t{panel.columns} * panel.rows;
        }
        most = std::max(most, pixels);
    }
    // A HUB75 panel takes its upper and its lower half at the same time; the layers of a cube are bits in the same
    // chain.
    std::uint64_t shifts = most / (scan.driver == DriverChip::Hub75 ? 2 : 1) / scan.row_groups;
    if (scan.driver == DriverChip::ShiftRegister595) shifts = shifts * channel_count(display.format) + display.slices;
    config.shift_ns = (shifts * 1'000'000'000 + scan.pixel_clock_hz - 1) / scan.pixel_clock_hz;
    return config;
}

}  // namespace xorvox::device
