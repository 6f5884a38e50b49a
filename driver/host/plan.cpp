#include "driver/host/plan.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>

#include <fmt/format.h>

#include "driver/display/lattice.h"
#include "driver/display/timing.h"
#include "driver/wire/packet.h"

namespace xorvox::host {
namespace {

// Payload at best. USB 2.0 specification, 5.7.4 and 5.8.4: at full speed one interrupt transfer of 64 bytes a
// millisecond, or 19 of 64 bytes in bulk; at high speed three of 1024 bytes in 125 µs, or 13 of 512 bytes in bulk.
// Gigabit Ethernet with packets of 1500 bytes carries 1448 bytes of TCP's payload in 1538 on the cable.
constexpr std::array kLinks{
    LinkCeiling{"usb-hs", "USB high speed, bulk", 53e6},    LinkCeiling{"usb-fs", "USB full speed, bulk", 1.2e6},
    LinkCeiling{"hid-hs", "HID at USB high speed", 24e6},   LinkCeiling{"hid-fs", "HID at USB full speed", 64e3},
    LinkCeiling{"tcp", "TCP over gigabit Ethernet", 118e6}, LinkCeiling{"gpio", "8 clocked GPIO lines", 0.0},
};

// RAM on the chip or, of boards, soldered beside it; from the makers' data sheets.
constexpr std::array kControllers{
    Controller{"ATmega328P (Arduino Uno)", 2u << 10},       Controller{"STM32F407", 192u << 10},
    Controller{"RP2040 (Raspberry Pi Pico)", 264u << 10},   Controller{"ESP32-S3", 512u << 10},
    Controller{"RP2350 (Raspberry Pi Pico 2)", 520u << 10}, Controller{"i.MX RT1062 (Teensy 4)", 1u << 20},
    Controller{"ESP32-S3 with 8 MB PSRAM", 8u << 20},       Controller{"Raspberry Pi Zero 2 W", 512u << 20},
    Controller{"Raspberry Pi 4 or 5, 2 GB", 2048ull << 20},
};

constexpr double kSlowestGpioHz = 1.0;
constexpr double kFastestGpioHz = 1e10;

/// What a device half is lent for packets: no more than a frame needs, no more than makes chunks efficient.
constexpr std::uint64_t kPacketBytes = 4096;

bool turns(const DisplayDescription& display) {
    return display.kind == DisplayKind::RotatingPanel || display.kind == DisplayKind::Helix;
}

/// As many of the display's slices as there is room for.
std::uint32_t whole_slices(const DisplayDescription& display, double room) {
    return static_cast<std::uint32_t>(std::clamp(room, 0.0, double{1} * display.slices));
}

double larger_moving(const ExampleFrames& example) {
    return std::max(example.constant.moving, example.gradient.moving);
}

LinkPlan plan_link(const DisplayDescription& display, const LinkCeiling& link, const ExampleFrames& example) {
    LinkPlan plan;
    const double rate = display.cycles_per_second;
    plan.frame_wire_bytes = static_cast<double>(raw_wire_bytes(frame_bytes(display)));
    plan.compressed_frame_bytes = larger_moving(example);
    plan.rate_raw = plan.frame_wire_bytes * rate;
    plan.rate_compressed = plan.compressed_frame_bytes * rate;
    plan.frames_per_second_raw = link.bytes_per_second / plan.frame_wire_bytes;
    plan.frames_per_second_compressed = link.bytes_per_second / plan.compressed_frame_bytes;
    if (plan.rate_raw <= link.bytes_per_second) {
        plan.fit = Fit::Raw;
    } else if (plan.rate_compressed <= link.bytes_per_second) {
        plan.fit = Fit::Compressed;
    }
    const double bytes_a_frame = link.bytes_per_second / rate;
    plan.slices_raw = whole_slices(display, bytes_a_frame / static_cast<double>(slice_bytes(display)));
    while (plan.slices_raw > 0 &&
           static_cast<double>(raw_wire_bytes(slice_bytes(display) * plan.slices_raw)) > bytes_a_frame) {
        --plan.slices_raw;
    }
    plan.slices_compressed = whole_slices(display, display.slices * bytes_a_frame / plan.compressed_frame_bytes);
    for (const PixelFormat format : kPixelFormats) {
        if (bits_per_pixel(format) > bits_per_pixel(display.format)) continue;
        DisplayDescription other = display;
        other.format = format;
        if (static_cast<double>(raw_wire_bytes(frame_bytes(other))) <= bytes_a_frame)
            plan.formats_raw.push_back(format);
    }
    return plan;
}

ScanPlan plan_scan(const DisplayDescription& display) {
    ScanPlan plan;
    plan.slice_ns = slice_time_ns(display);
    plan.planes_shown = shown_bit_planes(display);
    plan.planes_fit = fitting_bit_planes(display);
    plan.scan_ns = scan_time_ns(display, plan.planes_shown);
    if (plan.scan_ns > 0.0 && !keeps_light(display)) {
        plan.slices_fit = std::floor(display.slices * plan.slice_ns / plan.scan_ns);
    }
    if (display.scan.driver == DriverChip::Dlp) {
        // Slices are spread evenly over the part of the cycle in which they are lit; the projector runs at one rate.
        plan.projector_hz = 1e9 / (plan.slice_ns * display.scan.planes_per_frame);
    }
    return plan;
}

CurrentPlan plan_current(const DisplayDescription& display) {
    CurrentPlan plan;
    plan.lit_leds = leds_at_a_time(display);
    plan.all_white_ma = static_cast<double>(plan.lit_leds) * display.power.led_ma;
    plan.limit_ma = display.power.limit_ma;
    if (plan.limit_ma > 0.0 && plan.all_white_ma > plan.limit_ma) plan.white_part = plan.limit_ma / plan.all_white_ma;
    return plan;
}

MemoryPlan plan_memory(const DisplayDescription& display, std::uint64_t state_bytes) {
    MemoryPlan plan;
    plan.page_bytes = frame_bytes(display);
    plan.packet_bytes = std::clamp<std::uint64_t>(raw_wire_bytes(plan.page_bytes), wire::kMinPacketBytes, kPacketBytes);
    plan.state_bytes = state_bytes;
    plan.two_pages_bytes = 2 * plan.page_bytes + plan.packet_bytes + plan.state_bytes;
    plan.three_pages_bytes = plan.two_pages_bytes + plan.page_bytes;
    return plan;
}

/// The steepest part of an upward sweep, in strokes a sweep.
double steepest(const Motion& motion) {
    if (motion.profile == MotionProfile::Sine) return std::numbers::pi / 2.0;
    if (motion.profile == MotionProfile::Constant) return 1.0;
    double step = 0.0;
    for (std::uint32_t i = 1; i < motion.table_size; ++i) step = std::max(step, motion.table[i] - motion.table[i - 1]);
    return step * (motion.table_size - 1);
}

MotionPlan plan_motion(const DisplayDescription& display, const DisplayExtent& room) {
    MotionPlan plan;
    if (turns(display)) {
        plan.turns_per_second = turns_per_second(display);
        // The corners of a helix's image lie on its screen; a rotor's box is as wide as its rim.
        plan.rim_mm = display.kind == DisplayKind::RotatingPanel
                          ? room.upper.x
                          : std::sqrt(room.upper.x * room.upper.x + room.upper.y * room.upper.y);
        plan.fastest_m_per_s = 2.0 * std::numbers::pi * plan.rim_mm * plan.turns_per_second / 1e3;
    } else if (display.kind == DisplayKind::SweptPlane) {
        plan.fastest_m_per_s =
            2.0 * display.cycles_per_second * display.motion.stroke_mm * steepest(display.motion) / 1e3;
    }
    return plan;
}

}  // namespace

std::span<const LinkCeiling> link_ceilings() {
    return kLinks;
}

std::span<const Controller> common_controllers() {
    return kControllers;
}

Expected<LinkCeiling> find_link(std::string_view name, std::optional<double> gpio_rate_hz) {
    std::string names;
    for (LinkCeiling link : kLinks) {
        names += names.empty() ? "" : ", ";
        names += link.name;
        if (link.name != name) continue;
        if (name != "gpio") {
            if (gpio_rate_hz) return fail(fmt::format("--gpio-rate is the rate of --link gpio; {} has its own", name));
            return link;
        }
        if (!gpio_rate_hz) {
            return fail("--link gpio needs --gpio-rate HZ, how often a second its 8 lines change, one byte each time");
        }
        if (!(*gpio_rate_hz >= kSlowestGpioHz && *gpio_rate_hz <= kFastestGpioHz)) {
            return fail(
                fmt::format("--gpio-rate is {}; it takes how often a second the 8 lines change, one byte each "
                            "time: 1 to 1e10",
                            *gpio_rate_hz));
        }
        link.bytes_per_second = *gpio_rate_hz;
        return link;
    }
    return fail(fmt::format("--link: there is no '{}'; there are {}", name, names));
}

Expected<std::vector<FormatRate>> compressed_rates(const DisplayDescription& display, const LinkCeiling& link,
                                                   std::uint64_t most_samples) {
    std::vector<FormatRate> rates;
    for (const PixelFormat format : kPixelFormats) {
        if (bits_per_pixel(format) > bits_per_pixel(display.format)) continue;
        DisplayDescription other = display;
        other.format = format;
        const Expected<ExampleFrames> example = measure_example(other, most_samples);
        if (!example) return tl::unexpected(example.error());
        const double possible = link.bytes_per_second / larger_moving(*example);
        rates.push_back({format, std::min(possible, display.cycles_per_second)});
    }
    std::ranges::reverse(rates);
    return rates;
}

Plan make_plan(const DisplayDescription& display, const LinkCeiling& link, const ExampleFrames& example,
               std::uint64_t device_state_bytes) {
    Plan plan;
    plan.samples = frame_pixels(display);
    const DisplayExtent room = extent(display);
    const DisplayLattice lattice(display);
    const SliceMap map(display, lattice);
    plan.cartesian_size = {map.grid().nx, map.grid().ny, map.grid().nz};
    plan.bright = map.coverage(LightMode::Bright);
    plan.uniform = map.coverage(LightMode::Uniform);
    plan.frames_per_second = display.cycles_per_second;
    plan.link = plan_link(display, link, example);
    plan.scan = plan_scan(display);
    plan.current = plan_current(display);
    plan.memory = plan_memory(display, device_state_bytes);
    plan.motion = plan_motion(display, room);
    return plan;
}

}  // namespace xorvox::host
