// Light times: how a display's light is cut into strobes, by what drives it. strobe_scan makes strobes by this, and an
// exposure knows by it how much light is full light.
//
//   LEDs in rows      HUB75, 74HC595, and LEDs on lines of their own in row groups, with a linear response: a strobe
//   (planes)          for each group of rows and bit plane, at the times of driver/device/scan/modulation.h.
//
//   levels            What makes levels by itself: projectors, drivers that are not known, and controllers whose
//                     response is not linear. The time of the slice is shared evenly by the row groups. Of its share a
//                     group is dark for scan.latch_ns, and then lit to the end:
//
//                       │◄──── share ────►│◄──── share ────►│
//                       latch ┌───────────┐latch ┌──────────┐
//                     ────────┘  group 0  └──────┘ group 1  └──
//                       begin                                end of the slice
//
//   strings           WS2812, APA102. A frame (of a display that moves: a slice) is sent, which takes the time that
//                     scan_time_ns() tells (driver/display/timing.h: chain_pixels × bits ÷ clock, and the pause). Then
//                     all LEDs change at once and keep their colours until the next one was sent; so going dark takes
//                     as long as a frame. An order that comes before everything was sent begins anew, and what was cut
//                     short is never seen.
//
//   sub-frames        A projector with planes_per_frame = N > 1 is triggered once for N slices, and then shows one
//   after
//                     the other by its own clock, each for slice_time_ns() (dark for latch_ns at first), however the
//                     display moves meanwhile. A slice that does not follow the one before, upwards or downwards, and
//                     the one after N of them trigger anew; a trigger ends what is still shown. Going dark switches the
//                     light source off.
#pragma once

#include <algorithm>
#include <cstdint>

#include "driver/device/scan/modulation.h"
#include "driver/display/description.h"
#include "driver/display/timing.h"
#include "sim/strobe.h"

namespace xorvox::sim {

/// For how long an LED that is fully on gives full light in one cycle of a valid `display` at its declared speed and
/// brightness 255, in nanoseconds: in the strobes of its slice, or of all of them.
constexpr double full_light_ns(const DisplayDescription& display) {
    const double slice_ns = slice_time_ns(display);
    const bool twice = display.kind == DisplayKind::SweptPlane && display.motion.both_ways;
    double light_ns = slice_ns;
    if (lit_by_planes(display)) {
        const auto available_ns = static_cast<std::uint64_t>(slice_ns);
        const device::Modulation slots = device::modulate(device::modulation_config(display), available_ns);
        light_ns = 0.0;
        for (std::uint32_t plane = 0; plane < slots.planes; ++plane) {
            light_ns += emitted_ns(display.scan, slots.on_ns(plane));
        }
    } else if (!has_strings(display)) {
        light_ns = std::max(slice_ns / display.scan.row_groups - display.scan.latch_ns, 0.0);
    }
    return twice ? 2.0 * light_ns : light_ns;
}

}  // namespace xorvox::sim
