// A device without faults, for tests: scans pages out as the display's schedule says, in perfect time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "driver/device/config.h"
#include "driver/device/scan_order.h"
#include "driver/display/description.h"
#include "sim/scan_out.h"

namespace xorvox::test {

/// The time at which the display comes to a phase.
using TimeAt = std::function<std::uint64_t(device::Phase)>;

/// As the display is declared: cycle 0 begins at 0.
inline TimeAt perfect_time(const DisplayDescription& display) {
    return [rate = display.cycles_per_second](device::Phase phase) {
        return static_cast<std::uint64_t>(
            static_cast<double>(phase) / static_cast<double>(device::kCycle) / rate * 1e9 + 0.5);
    };
}

/// Orders the slices of `page` in `cycles` cycles from the first one on, and runs on until the last one is over.
inline void scan_page(const DisplayDescription& display, std::span<const std::byte> page, std::uint32_t cycles,
                      sim::ScanOut& scan, const TimeAt& time_at, std::uint8_t brightness = 255) {
    const device::SliceSchedule schedule = device::slice_schedule(display);
    const std::size_t bytes = frame_bytes(display) / schedule.slices;
    std::uint32_t number = 0;
    const device::Phase end = cycles * device::kCycle;
    device::Phase phase = 0;
    while (phase < end) {
        const device::SliceSchedule::Place place = schedule.at(phase);
        device::ScanOrder order;
        order.number = ++number;
        order.end_ns = time_at(place.end);
        order.begin_ns = time_at(place.begin);
        if (place.lit) {
            order.dark = device::Dark::No;
            order.slice = place.slice;
            order.mirrored = place.mirrored;
            order.brightness = brightness;
            order.bytes = page.subspan(place.slice * bytes, bytes);
        }
        scan.run_until(order.begin_ns);
        scan.begin(order, 1, order.begin_ns);
        phase = place.end;
    }
    const std::uint64_t end_ns = time_at(end);
    scan.run_until(end_ns);
    scan.begin({.dark = device::Dark::Fault}, 1, end_ns);
    scan.run_until(end_ns + 2 * cycle_ns(display));
}

}  // namespace xorvox::test
