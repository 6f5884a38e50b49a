// Timing: how long a slice may take, and how long its driver needs. For planning and for the rules of descriptions; no
// device computes with it. Known figures only: what a description leaves at 0 takes no time here, but light of bit
// planes, of which none is shorter than a nanosecond.
#pragma once

#include <algorithm>
#include <cstdint>

#include "driver/display/description.h"

namespace xorvox {

/// The time that one slice of `display` has, in nanoseconds: its share of a turn, of a refresh, or of the lit part of
/// an upward sweep, which takes half a cycle. Where keeps_light(), and of free points: the whole cycle.
constexpr double slice_time_ns(const DisplayDescription& display) {
    const double cycle = 1e9 / display.cycles_per_second;
    if (keeps_light(display)) return cycle;
    if (display.kind == DisplayKind::SweptPlane) {
        return cycle / 2.0 * (1.0 - 2.0 * display.motion.dead_zone) / display.slices;
    }
    return cycle / display.slices;
}

/// Pixels that one chain, or one string, of `display` is fed with for one slice (keeps_light(): for one frame), one
/// after the other, and of those how many for one group of rows.
constexpr double chain_pixels(const DisplayDescription& display) {
    if (has_strings(display)) {
        const std::size_t pixels = frame_pixels(display) / (keeps_light(display) ? 1 : display.slices);
        return static_cast<double>(pixels) / display.scan.strings;
    }
    double longest = 0.0;
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        double pixels = 0.0;
        for (std::uint32_t q = 0; q < display.panel_count; ++q) {
            if (display.panels[q].connector != display.panels[p].connector) continue;
            pixels += double{1} * display.panels[q].columns * display.panels[q].rows;
        }
        longest = std::max(longest, pixels);
    }
    // HUB75 feeds the upper and the lower half of a panel at the same time.
    return display.scan.driver == DriverChip::Hub75 ? longest / 2.0 : longest;
}

/// Whether its light is of bit planes, lit at the times of driver/device/scan/modulation.h. Else what drives it makes
/// levels: projectors, strings, drivers that are not known, and controllers whose response is not linear.
constexpr bool lit_by_planes(const DisplayDescription& display) {
    if (display.light.response != Response::Linear) return false;
    switch (display.scan.driver) {
        case DriverChip::Hub75:
        case DriverChip::ShiftRegister595: return true;
        case DriverChip::Direct: return display.scan.row_groups > 1;
        case DriverChip::Ws2812:
        case DriverChip::Apa102:
        case DriverChip::Dlp: break;
    }
    return false;
}

/// scan_time_ns() of displays that are lit_by_planes(): Modulation::total_ns() of the shortest light, to the
/// nanosecond.
constexpr double plane_scan_time_ns(const DisplayDescription& display, std::uint32_t planes) {
    const Scan& scan = display.scan;
    std::uint64_t shift_ns = 0;
    if (scan.pixel_clock_hz != 0 && scan.driver != DriverChip::Direct) {
        // The channels of an LED cube and the bits that select its layers are in the same chain.
        const bool one_chain = scan.driver == DriverChip::ShiftRegister595;
        auto shifts = static_cast<std::uint64_t>(chain_pixels(display)) / scan.row_groups;
        if (one_chain) shifts = shifts * channel_count(display.format) + display.slices;
        shift_ns = (shifts * 1'000'000'000 + scan.pixel_clock_hz - 1) / scan.pixel_clock_hz;
    }
    const std::uint64_t gap_ns = std::uint64_t{scan.latch_ns} + scan.fall_ns;
    std::uint64_t light_ns = std::max(std::uint64_t{scan.min_on_ns}, std::uint64_t{scan.rise_ns} + scan.fall_ns);
    light_ns = std::max<std::uint64_t>(light_ns, 1);
    std::uint64_t group_ns = 0;
    for (std::uint32_t plane = 0; plane < planes; ++plane, light_ns *= 2) {
        const std::uint64_t on_ns = light_ns + scan.rise_ns / 2 - scan.fall_ns / 2;
        group_ns += std::max(on_ns, shift_ns) + gap_ns;
    }
    // The first data are shifted in while nothing is lit.
    return static_cast<double>(shift_ns + gap_ns + group_ns * scan.row_groups);
}

/// The time that the driver needs to show one slice (keeps_light(): to send one frame) with `planes` bit planes, in
/// nanoseconds; 0: unknown. A bit plane is shifted in while the one before is lit; plane b is lit for min_on_ns·2^b.
constexpr double scan_time_ns(const DisplayDescription& display, std::uint32_t planes) {
    if (lit_by_planes(display)) return plane_scan_time_ns(display, planes);
    const Scan& scan = display.scan;
    const double shift_ns = scan.pixel_clock_hz == 0 ? 0.0 : 1e9 / scan.pixel_clock_hz;
    const double pixels = chain_pixels(display);
    switch (scan.driver) {
        case DriverChip::Ws2812: return pixels * bits_per_pixel(display.format) * shift_ns + scan.latch_ns;
        case DriverChip::Apa102: return (32.0 + 32.0 * pixels + pixels / 2.0) * shift_ns + scan.latch_ns;
        default: break;
    }
    // Controllers of their own, whose registers are like those of displays that are lit by planes.
    const bool one_chain = scan.driver == DriverChip::ShiftRegister595;
    const double bits = one_chain ? pixels * channel_count(display.format) : pixels;
    const double layer_bits = one_chain ? display.slices : 0.0;
    const double shifted_ns = (bits / scan.row_groups + layer_bits) * shift_ns;
    double total = 0.0;
    double lit_ns = scan.min_on_ns;
    for (std::uint32_t plane = 0; plane < planes; ++plane, lit_ns *= 2.0) {
        total += std::max(shifted_ns, lit_ns) + scan.latch_ns + scan.rise_ns + scan.fall_ns;
    }
    return total * scan.row_groups;
}

/// LEDs, each channel one, that are lit at the same time when all are white.
constexpr std::uint64_t leds_at_a_time(const DisplayDescription& display) {
    std::uint64_t pixels = frame_pixels(display);
    if (!keeps_light(display)) pixels /= std::uint64_t{display.slices} * display.scan.row_groups;
    return pixels * channel_count(display.format);
}

/// The most bit planes a channel that fit into a slice's time, at most those of the format; 0: not even one.
constexpr std::uint32_t fitting_bit_planes(const DisplayDescription& display) {
    std::uint32_t planes = bits_per_channel(display.format);
    while (planes > 0 && scan_time_ns(display, planes) > slice_time_ns(display)) --planes;
    return planes;
}

}  // namespace xorvox
