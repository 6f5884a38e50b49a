// What the device half must know of a display, in integers, computed from its description. All of it is constexpr: in
// firmware, keep the result in a constexpr variable, and no floating point is left at run time.
//
//   constexpr auto kControl = scan_control_config(kDisplay, {.reports_scans = true, .has_interlock = true});
#pragma once

#include <algorithm>
#include <cstdint>

#include "driver/device/scan_control.h"
#include "driver/display/description.h"

namespace xorvox::device {

/// What the description does not tell: how this device is built.
struct Wiring {
    bool reports_scans = false;  ///< The scanner calls scan_done().
    bool has_interlock = false;
};

namespace detail {

constexpr std::uint64_t rounded(double value) {
    return static_cast<std::uint64_t>(value + 0.5);
}

/// 0 stays unknown, and nothing else becomes it.
constexpr std::uint64_t known_ua(double ma) {
    return ma > 0.0 ? std::max<std::uint64_t>(rounded(ma * 1e3), 1) : 0;
}

}  // namespace detail

constexpr RotationConfig rotation_config(const DisplayDescription& display) {
    RotationConfig config;
    config.source = display.sync.index;
    config.pulses_per_turn = display.sync.index_pulses;
    switch (display.kind) {
        case DisplayKind::RotatingPanel: config.cycles_per_turn = display.sweep_deg < 270.0 ? 2 : 1; break;
        case DisplayKind::Helix: config.cycles_per_turn = display.blades; break;
        default: break;
    }
    config.cycle_ns = cycle_ns(display);
    const double slowest = display.sync.slowest_cycles_per_second > 0.0 ? display.sync.slowest_cycles_per_second
                                                                        : display.cycles_per_second / 2.0;
    const double fastest = display.sync.fastest_cycles_per_second > 0.0 ? display.sync.fastest_cycles_per_second
                                                                        : display.cycles_per_second * 1.25;
    config.longest_turn_ns = detail::rounded(1e9 / slowest * config.cycles_per_turn);
    config.shortest_turn_ns = detail::rounded(1e9 / fastest * config.cycles_per_turn);
    config.mark_phase = static_cast<std::uint32_t>(
        std::min(display.sync.index_phase * static_cast<double>(kCycle), static_cast<double>(kCycle - 1)));
    return config;
}

constexpr SliceSchedule slice_schedule(const DisplayDescription& display) {
    SliceSchedule schedule;
    if (keeps_light(display)) return schedule;
    schedule.slices = display.slices;
    schedule.mirrors_odd_cycles = display.kind == DisplayKind::RotatingPanel && display.sweep_deg < 270.0;
    if (display.kind == DisplayKind::SweptPlane) {
        constexpr std::uint64_t kSweep = kCycle / 2;
        const std::uint64_t dead = detail::rounded(display.motion.dead_zone * static_cast<double>(kSweep));
        schedule.strokes[0] = {dead, kSweep - 2 * dead, false};
        schedule.strokes[1] = {kSweep + dead, kSweep - 2 * dead, true};
        schedule.stroke_count = display.motion.both_ways ? 2 : 1;
    }
    return schedule;
}

constexpr CurrentConfig current_config(const DisplayDescription& display) {
    CurrentConfig config;
    const bool at_once = keeps_light(display);
    config.format = display.format;
    config.bit_planes = shown_bit_planes(display);
    config.row_groups = display.scan.row_groups;
    config.led_ua = static_cast<std::uint32_t>(detail::known_ua(display.power.led_ma));
    config.limit_ua = config.led_ua == 0 ? 0 : detail::known_ua(display.power.limit_ma);
    config.slices = at_once ? display.slices : 1;
    config.panel_count = display.panel_count;
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        config.panels[p] = {display.panels[p].columns, display.panels[p].rows};
    }
    config.most_light = most_brightness(display);
    return config;
}

/// For a valid description.
constexpr ScanControlConfig scan_control_config(const DisplayDescription& display, const Wiring& wiring = {}) {
    ScanControlConfig config;
    config.rotation = rotation_config(display);
    config.schedule = slice_schedule(display);
    config.current = current_config(display);
    config.slice_bytes = static_cast<std::uint32_t>(frame_bytes(display) / config.schedule.slices);
    // A slice may be late by as much as its time; after that the next one's light stands in the wrong place.
    const std::uint64_t nth = config.schedule.strokes[0].length / config.schedule.slices;
    const double slice_ns =
        static_cast<double>(config.rotation.cycle_ns) * static_cast<double>(nth) / static_cast<double>(kCycle);
    config.late_ns = wiring.reports_scans ? std::max<std::uint64_t>(detail::rounded(slice_ns), 1) : 0;
    config.has_interlock = wiring.has_interlock;
    return config;
}

}  // namespace xorvox::device
