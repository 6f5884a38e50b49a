#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "driver/device/scan/modulation.h"
#include "driver/display/timing.h"
#include "sim/light_times.h"
#include "sim/scan_out.h"
#include "tests/catch.h"
#include "tests/unit/sim/displays.h"

namespace xorvox {
namespace {

using namespace test;
using sim::Strobe;

/// A strobe, and of one pixel whether each of its channels is lit in it.
struct Seen {
    Strobe strobe;
    std::array<bool, 3> lit{};
};

/// Records strobes, and looks at one LED as mounted.
struct Watched {
    const DisplayDescription& display;
    Pixel pixel;
    std::vector<Seen> seen;

    void operator()(const Strobe& strobe) {
        Seen& entry = seen.emplace_back(Seen{strobe, {}});
        const sim::StrobeRows& rows = strobe.panels[pixel.panel];
        const bool levels = strobe.plane == Strobe::kLevels;
        const std::uint32_t bits = levels ? bits_per_pixel(display.format) : 1;
        for (std::uint32_t channel = 0; channel < (levels ? 1 : channel_count(display.format)); ++channel) {
            const std::uint32_t bit = pixel.column * bits;
            const std::byte byte = rows.at(pixel.row, channel)[bit / 8];
            entry.lit[channel] = ((std::to_integer<unsigned>(byte) >> bit % 8) & 1) != 0;
        }
    }
};

std::unique_ptr<sim::ScanOut> scan_to(Watched& watched) {
    return sim::make_strobe_scan(watched.display, [&watched](const Strobe& strobe) { watched(strobe); });
}

device::ScanOrder order_of(std::span<const std::byte> bytes, std::uint64_t begin_ns, std::uint64_t end_ns) {
    static std::uint32_t number = 0;
    return {.number = ++number,
            .dark = device::Dark::No,
            .brightness = 255,
            .bytes = bytes,
            .begin_ns = begin_ns,
            .end_ns = end_ns};
}

constexpr device::ScanOrder kGoDark{.number = 0xffff, .dark = device::Dark::Fault};

DisplayDescription hub75_rotor(PixelFormat format = PixelFormat::Rgb332) {
    DisplayDescription display = rotor_of(11, 4, 8, format);
    display.scan.driver = DriverChip::Hub75;
    display.scan.pixel_clock_hz = 10'000'000;
    display.scan.latch_ns = 100;
    display.scan.min_on_ns = 500;
    display.scan.rise_ns = 60;
    display.scan.fall_ns = 30;
    display.scan.row_groups = 2;
    display.panels[1].connector = 1;
    return display;
}

TEST_CASE("plane strobes come at the modulation's times, group by group, the most significant plane first") {
    const DisplayDescription display = hub75_rotor();
    Watched watched{display, {.panel = 1, .row = 3, .column = 10}, {}};
    auto scan = scan_to(watched);
    std::vector<std::byte> slice(slice_bytes(display));
    set_pixel(display, slice, {.panel = 1, .row = 3, .column = 10}, 0b101'001'10);
    auto order = order_of(slice, 900, 2'000'000);
    order.slice = 5;
    scan->begin(order, 77, 1000);
    scan->run_until(2'000'000);

    const device::Modulation slots = device::modulate(device::modulation_config(display), 2'000'000 - 1000);
    REQUIRE(slots.planes == 3);
    REQUIRE(watched.seen.size() == 6);
    std::uint64_t at_ns = 1000 + slots.first_ns();
    for (std::uint32_t i = 0; i < 6; ++i) {
        CAPTURE(i);
        const Strobe& strobe = watched.seen[i].strobe;
        CHECK(strobe.row_group == i / 3);
        CHECK(strobe.plane == i % 3);
        CHECK(strobe.on_ns == at_ns);
        CHECK(strobe.off_ns == at_ns + slots.on_ns(i % 3));
        CHECK(strobe.slice == 5);
        CHECK(strobe.frame == 77);
        CHECK(strobe.brightness == 255);
        at_ns += slots.slot_ns(i % 3);
    }
    using Lit = std::array<bool, 3>;
    CHECK(watched.seen[3].lit == Lit{true, false, true});
    CHECK(watched.seen[4].lit == Lit{false, false, false});
    CHECK(watched.seen[5].lit == Lit{true, true, true});  // Blue has two planes, and repeats its first.
}

TEST_CASE("brightness makes strobes of planes shorter, and strobes of levels dimmer") {
    const DisplayDescription display = hub75_rotor();
    Watched watched{display, {}, {}};
    auto scan = scan_to(watched);
    std::vector<std::byte> slice(slice_bytes(display));
    auto order = order_of(slice, 0, 2'000'000);
    order.brightness = 128;
    scan->begin(order, 1, 0);
    scan->run_until(2'000'000);
    const device::Modulation slots = device::modulate(device::modulation_config(display), 2'000'000);
    REQUIRE(watched.seen.size() == 6);
    CHECK(watched.seen[0].strobe.off_ns - watched.seen[0].strobe.on_ns == slots.on_ns(0, 128));
    CHECK(watched.seen[1].strobe.on_ns - watched.seen[0].strobe.on_ns == slots.slot_ns(0));

    order.brightness = 0;
    scan->begin(order, 1, 2'000'000);
    scan->run_until(9'000'000);
    CHECK(watched.seen.size() == 6);

    const DisplayDescription stack = stack_of(3, 2, 2, PixelFormat::Rgb888);
    Watched levels{stack, {}, {}};
    auto direct = scan_to(levels);
    std::vector<std::byte> plane(slice_bytes(stack));
    order = order_of(plane, 0, 1000);
    order.brightness = 128;
    direct->begin(order, 1, 0);
    direct->run_until(1000);
    REQUIRE(levels.seen.size() == 1);
    CHECK(levels.seen[0].strobe.brightness == 128);
    CHECK(levels.seen[0].strobe.plane == Strobe::kLevels);
    CHECK(levels.seen[0].strobe.row_group == Strobe::kAllRows);
}

TEST_CASE("a new order, or dark, cuts the strobe that is lit, and those to come vanish") {
    const DisplayDescription display = hub75_rotor();
    Watched watched{display, {}, {}};
    auto scan = scan_to(watched);
    std::vector<std::byte> slice(slice_bytes(display));
    const device::Modulation slots = device::modulate(device::modulation_config(display), 2'000'000);
    const std::uint64_t cut_ns = slots.first_ns() + slots.slot_ns(0) + 7;
    scan->begin(order_of(slice, 0, 2'000'000), 1, 0);
    scan->run_until(cut_ns);
    CHECK(watched.seen.size() == 1);
    scan->begin(kGoDark, 1, cut_ns);
    REQUIRE(watched.seen.size() == 2);
    CHECK(watched.seen[1].strobe.off_ns == cut_ns);
    CHECK(watched.seen[1].strobe.off_ns - watched.seen[1].strobe.on_ns == 7);
    scan->run_until(4'000'000);
    CHECK(watched.seen.size() == 2);

    // In the gap between two strobes there is nothing to cut.
    scan->begin(order_of(slice, 4'000'000, 6'000'000), 1, 4'000'000);
    scan->begin(kGoDark, 1, 4'000'000 + slots.first_ns() - 1);
    CHECK(watched.seen.size() == 2);
}

TEST_CASE("a mirrored slice is turned around in planes, and told in levels") {
    for (const std::uint16_t columns : {std::uint16_t{8}, std::uint16_t{11}, std::uint16_t{16}}) {
        CAPTURE(columns);
        DisplayDescription display = hub75_rotor(PixelFormat::Mono1);
        for (Panel& panel : display.panels) panel.columns = columns;
        Watched watched{display, {.row = 2, .column = columns - 4u}, {}};
        auto scan = scan_to(watched);
        std::vector<std::byte> slice(slice_bytes(display));
        set_pixel(display, slice, {.row = 2, .column = 3}, 1);
        auto order = order_of(slice, 0, 1'000'000);
        order.mirrored = true;
        scan->begin(order, 1, 0);
        scan->run_until(1'000'000);
        REQUIRE(watched.seen.size() == 2);
        CHECK(watched.seen[0].lit[0]);
        CHECK_FALSE(watched.seen[0].strobe.mirrored);
    }
    DisplayDescription display = rotor_of(8, 2, 4, PixelFormat::Mono1, 1);
    display.scan.driver = DriverChip::Dlp;
    Watched watched{display, {.row = 1, .column = 3}, {}};
    auto scan = scan_to(watched);
    std::vector<std::byte> slice(slice_bytes(display));
    set_pixel(display, slice, {.row = 1, .column = 3}, 1);
    auto order = order_of(slice, 0, 1000);
    order.mirrored = true;
    scan->begin(order, 1, 0);
    scan->run_until(1000);
    REQUIRE(watched.seen.size() == 1);
    CHECK(watched.seen[0].lit[0]);
    CHECK(watched.seen[0].strobe.mirrored);
}

TEST_CASE("a controller with a response of its own shares the slice's time among its row groups") {
    DisplayDescription display = hub75_rotor();
    display.light.response = Response::Gamma;
    Watched watched{display, {}, {}};
    auto scan = scan_to(watched);
    std::vector<std::byte> slice(slice_bytes(display));
    scan->begin(order_of(slice, 0, 10'001), 1, 0);
    scan->run_until(5000);
    CHECK(watched.seen.size() == 1);
    scan->run_until(10'001);
    REQUIRE(watched.seen.size() == 2);
    CHECK(watched.seen[0].strobe.on_ns == 100);
    CHECK(watched.seen[0].strobe.off_ns == 5000);
    CHECK(watched.seen[0].strobe.row_group == 0);
    CHECK(watched.seen[1].strobe.on_ns == 5100);
    CHECK(watched.seen[1].strobe.off_ns == 10'001);
    CHECK(watched.seen[1].strobe.row_group == 1);
}

TEST_CASE("a cube of strings keeps its light until the next frame is latched") {
    DisplayDescription display = stack_of(4, 3, 2, PixelFormat::Rgb888);
    display.scan.driver = DriverChip::Ws2812;
    display.scan.pixel_clock_hz = 800'000;
    display.scan.latch_ns = 300'000;
    constexpr std::uint64_t kSend = 24 * 24 * 1250 + 300'000;
    Watched watched{display, {.row = 2, .column = 3}, {}};
    auto scan = scan_to(watched);
    std::vector<std::byte> frame(frame_bytes(display));
    set_pixel(display, frame, {.slice = 1, .row = 2, .column = 3}, 1);
    scan->begin(order_of(frame, 0, 10'000'000), 1, 0);
    scan->run_until(10'000'000);
    CHECK(watched.seen.empty());  // Still lit.
    scan->begin(order_of(frame, 10'000'000, 20'000'000), 2, 10'000'000);
    scan->run_until(10'000'000 + kSend - 1);
    CHECK(watched.seen.empty());
    scan->run_until(10'000'000 + kSend);
    REQUIRE(watched.seen.size() == 2);
    for (std::uint32_t slice = 0; slice < 2; ++slice) {
        CHECK(watched.seen[slice].strobe.slice == slice);
        CHECK(watched.seen[slice].strobe.frame == 1);
        CHECK(watched.seen[slice].strobe.on_ns == kSend);
        CHECK(watched.seen[slice].strobe.off_ns == 10'000'000 + kSend);
        CHECK(watched.seen[slice].lit[0] == (slice == 1));
    }
    // What is sent anew before it was latched is never seen, and going dark takes as long as a frame.
    scan->begin(order_of(frame, 20'000'000, 30'000'000), 3, 20'000'000);
    scan->begin(kGoDark, 3, 20'000'100);
    scan->begin(kGoDark, 3, 20'500'000);  // Is on its way already.
    scan->run_until(20'000'100 + kSend);
    REQUIRE(watched.seen.size() == 4);
    CHECK(watched.seen[3].strobe.frame == 2);
    CHECK(watched.seen[3].strobe.off_ns == 20'000'100 + kSend);
    scan->run_until(99'000'000);
    CHECK(watched.seen.size() == 4);
}

DisplayDescription small_vx1() {
    DisplayDescription display = swept_of(8, 2, 8, MotionProfile::Sine);
    display.motion.both_ways = true;
    display.cycles_per_second = 62.5;  // A slice has 1 ms.
    display.scan.driver = DriverChip::Dlp;
    display.scan.latch_ns = 1000;
    display.scan.planes_per_frame = 4;
    return display;
}

TEST_CASE("a projector's sub-frames keep to its own clock from the trigger on") {
    const DisplayDescription display = small_vx1();
    Watched watched{display, {}, {}};
    auto scan = scan_to(watched);
    const std::vector<std::byte> slice(slice_bytes(display));
    constexpr std::uint64_t kMs = 1'000'000;
    std::uint64_t now = 0;
    // Upwards 10% too slowly, then downwards 10% too fast.
    std::vector<std::uint64_t> triggers;
    for (std::uint32_t i = 0; i < 16; ++i) {
        auto order = order_of(slice, now, now + (i < 8 ? kMs * 11 / 10 : kMs * 9 / 10));
        order.slice = i < 8 ? i : 15 - i;
        if (i % 4 == 0) triggers.push_back(now);
        scan->run_until(now);
        scan->begin(order, 1, now);
        now = order.end_ns;
    }
    scan->run_until(now);
    scan->begin(kGoDark, 1, now);
    REQUIRE(watched.seen.size() == 16);
    for (std::uint32_t i = 0; i < 16; ++i) {
        CAPTURE(i);
        const Strobe& strobe = watched.seen[i].strobe;
        const std::uint64_t due = triggers[i / 4] + i % 4 * kMs;
        const std::uint64_t next = i < 12 ? triggers[i / 4 + 1] : now;
        CHECK(strobe.on_ns == due + 1000);
        CHECK(strobe.off_ns == std::min(due + kMs, next));  // The next trigger ends it.
        CHECK(strobe.slice == (i < 8 ? i : 15 - i));
    }
}

TEST_CASE("a projector with planes that is told to be dark is so at once, and starts anew") {
    const DisplayDescription display = small_vx1();
    Watched watched{display, {}, {}};
    auto scan = scan_to(watched);
    const std::vector<std::byte> slice(slice_bytes(display));
    scan->begin(order_of(slice, 0, 1'000'000), 1, 0);
    scan->run_until(400'000);
    scan->begin(kGoDark, 1, 400'000);
    REQUIRE(watched.seen.size() == 1);
    CHECK(watched.seen[0].strobe.off_ns == 400'000);
    auto order = order_of(slice, 700'000, 1'000'000);
    order.slice = 1;
    scan->begin(order, 1, 700'000);
    scan->run_until(1'700'000);
    REQUIRE(watched.seen.size() == 2);
    CHECK(watched.seen[1].strobe.on_ns == 701'000);
}

TEST_CASE("full light is what the strobes of a white slice give") {
    for (DisplayDescription display : {hub75_rotor(), small_vx1(), stack_of(3, 2, 4)}) {
        CAPTURE(display.name.view());
        display.scan.planes_per_frame = 1;
        double light_ns = 0.0;
        auto scan = sim::make_strobe_scan(display, [&](const Strobe& strobe) {
            if (strobe.row_group != 0 && strobe.row_group != Strobe::kAllRows) return;
            const std::uint64_t lit_ns = strobe.off_ns - strobe.on_ns;
            light_ns +=
                strobe.plane == Strobe::kLevels ? static_cast<double>(lit_ns) : sim::emitted_ns(display.scan, lit_ns);
        });
        const std::vector<std::byte> slice(slice_bytes(display));
        const auto slice_ns = static_cast<std::uint64_t>(slice_time_ns(display));
        const std::uint64_t times = display.motion.both_ways ? 2 : 1;
        for (std::uint64_t i = 0; i < times; ++i) {
            scan->begin(order_of(slice, i * slice_ns, (i + 1) * slice_ns), 1, i * slice_ns);
            scan->run_until((i + 1) * slice_ns);
        }
        CHECK(light_ns == Approx(sim::full_light_ns(display)).epsilon(1e-6));
    }
}

}  // namespace
}  // namespace xorvox
