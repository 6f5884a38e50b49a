// Plan: numbers against those worked out by hand.
#include "driver/host/plan.h"

#include <algorithm>
#include <cmath>

#include "tests/catch.h"
#include "tests/unit/plan/displays.h"

using namespace xorvox;
using namespace xorvox::host;
using namespace xorvox::test;

namespace {

/// Two panels of 128 × 64 back to back, 360 slices, 20 turns a second.
DisplayDescription large_rotor() {
    DisplayDescription display = rotor(PixelFormat::Rgb332);
    display.slices = 360;
    display.panels[0] = {.columns = 128, .rows = 64, .column_pitch_mm = 2.5, .row_pitch_mm = 2.5, .offset_mm = 5.0};
    display.panels[1] = display.panels[0];
    display.panels[1].angle_deg = 180.0;
    display.panels[1].connector = 1;
    display.scan.driver = DriverChip::Hub75;
    display.scan.pixel_clock_hz = 40'000'000;
    display.scan.min_on_ns = 100;
    display.scan.row_groups = 32;
    display.power.led_ma = 5.0;
    return display;
}

constexpr ExampleFrames kExample{{100'000.0, 40'000.0}, {200'000.0, 60'000.0}, 0.3, 360};

Plan planned(const DisplayDescription& display, std::string_view link, const ExampleFrames& example = kExample) {
    const auto ceiling = find_link(link, std::nullopt);
    REQUIRE(ceiling.has_value());
    return make_plan(display, *ceiling, example, 1000);
}

}  // namespace

TEST_CASE("a frame is planned with its voxels and its bytes", "[plan]") {
    const Plan plan = planned(large_rotor(), "usb-hs");
    CHECK(plan.samples == 5'898'240);
    CHECK(plan.cartesian_size == std::array<std::uint32_t, 3>{128, 128, 64});
    CHECK(plan.bright.voxels == 1'048'576);
    CHECK(plan.bright.visits > 2 * plan.uniform.visits);
    CHECK(plan.uniform.most_visits == 2);  // Once a panel.
    CHECK(plan.frames_per_second == 20.0);
    // 5,898,240 bytes in chunks of 65,536 − 20 − 13: 91 of them, and frame-begin and frame-end.
    CHECK(plan.link.frame_wire_bytes == 5'898'240 + 91 * 33 + (21 + 20) + (8 + 20));
}

TEST_CASE("what fits a link raw, what with compression, and what not", "[plan]") {
    const DisplayDescription display = large_rotor();
    const LinkPlan fast = planned(display, "usb-hs").link;
    CHECK(fast.fit == Fit::Compressed);
    CHECK(fast.rate_raw == Approx(20.0 * 5'901'312));
    CHECK(fast.rate_compressed == 20.0 * 60'000.0);
    CHECK(fast.frames_per_second_raw == Approx(53e6 / 5'901'312));
    CHECK(fast.frames_per_second_compressed == Approx(53e6 / 60'000.0));
    // 2,650,000 bytes a frame: 161 slices of 16,384 are 2,637,824, and 41 chunks.
    CHECK(fast.slices_raw == 161);
    // 737,280 bytes a frame for each bit of a pixel: 1, 2 and 3 bits a pixel are 14.7, 29.5 and 44.2 MB/s; 4 are 59.
    CHECK(fast.formats_raw == std::vector<PixelFormat>{PixelFormat::Mono1, PixelFormat::Mono2, PixelFormat::Rgb111});

    CHECK(fast.slices_compressed == 360);  // There are no more.
    CHECK(planned(stack(PixelFormat::Mono1), "tcp").link.slices_raw == 5);

    const LinkPlan slow = planned(display, "usb-fs").link;
    CHECK(slow.fit == Fit::Compressed);  // 1.2 MB/s are just enough
    const LinkPlan slower = planned(display, "hid-fs").link;
    CHECK(slower.fit == Fit::No);
    CHECK(slower.slices_raw == 0);  // 3200 bytes a frame
    CHECK(slower.slices_compressed == 19);
    CHECK(slower.formats_raw.empty());
    CHECK(planned(display, "tcp").link.fit == Fit::Compressed);  // 118 MB/s of data, but the headers do not fit as well
    DisplayDescription slow_display = display;
    slow_display.cycles_per_second = 19.0;
    CHECK(planned(slow_display, "tcp").link.fit == Fit::Raw);
    slow_display.cycles_per_second = 1.0;
    CHECK(planned(slow_display, "tcp").link.formats_raw ==
          std::vector<PixelFormat>{PixelFormat::Mono1, PixelFormat::Mono2, PixelFormat::Rgb111, PixelFormat::Mono4,
                                   PixelFormat::Rgb332});
}

TEST_CASE("small frames are planned with their packet headers", "[plan]") {
    DisplayDescription display = stack(PixelFormat::Mono1, 8, 8, 8);
    // 64 bytes, a chunk's 33, and 69 for begin and end.
    const LinkPlan link = planned(display, "hid-fs").link;
    CHECK(link.frame_wire_bytes == 166.0);
    CHECK(link.frames_per_second_raw == Approx(385.5).epsilon(0.001));
    CHECK(link.fit == Fit::Raw);
    display.cycles_per_second = 386.0;
    const LinkPlan faster = planned(display, "hid-fs", {{166, 166}, {166, 166}, 0.3, 8}).link;
    CHECK(faster.fit == Fit::No);
    CHECK(faster.slices_raw == 7);  // of 165.8 bytes, 102 are headers
}

TEST_CASE("a link that is too slow is planned with the formats and rates that it would carry", "[plan]") {
    const DisplayDescription display = large_rotor();
    const auto rates = compressed_rates(display, *find_link("hid-fs", std::nullopt), 1'000'000);
    REQUIRE(rates.has_value());
    REQUIRE(rates->size() == 5);
    CHECK(rates->front().format == PixelFormat::Rgb332);
    CHECK(rates->back().format == PixelFormat::Mono1);
    const ExampleFrames example = *measure_example(display, 1'000'000);
    CHECK(rates->front().frames_per_second ==
          Approx(64e3 / std::max(example.constant.moving, example.gradient.moving)));
    CHECK(rates->back().frames_per_second > rates->front().frames_per_second);
    const auto fast = compressed_rates(display, *find_link("tcp", std::nullopt), 1'000'000);
    REQUIRE(fast.has_value());
    for (const FormatRate& rate : *fast) CHECK(rate.frames_per_second == 20.0);
}

TEST_CASE("scan-out is planned for panels, cubes, strings and projectors", "[plan]") {
    DisplayDescription panels = large_rotor();
    // 128 × 64 ÷ 2 halves ÷ 32 groups = 128 shifts of 25 ns, longer than 100, 200 and 400 ns of light.
    ScanPlan scan = planned(panels, "tcp").scan;
    CHECK(scan.slice_ns == Approx(138'888.9));
    CHECK(scan.planes_shown == 3);
    CHECK(scan.scan_ns == Approx(3200.0 + 3 * 3200.0 * 32));  // The first shift lights nothing yet.
    CHECK(scan.planes_fit == 1);
    CHECK(scan.slices_fit == 161.0);  // 50,000,000 ÷ 310,400
    CHECK(scan.projector_hz == 0.0);
    panels.scan.bit_planes = 1;
    CHECK(planned(panels, "tcp").scan.slices_fit == 473.0);
    panels.scan = {};
    CHECK(planned(panels, "tcp").scan.scan_ns == 0.0);

    DisplayDescription cube = stack(PixelFormat::Mono1, 8, 8, 8);
    cube.scan.driver = DriverChip::ShiftRegister595;
    cube.scan.pixel_clock_hz = 1'000'000;
    cube.scan.latch_ns = 1000;
    scan = planned(cube, "tcp").scan;
    CHECK(scan.slice_ns == Approx(2.5e6));
    CHECK(scan.scan_ns == Approx(2 * 73'000.0));  // 64 pixels, 8 layers, a latch; and the light after it
    CHECK(scan.slices_fit == 136.0);

    DisplayDescription strings = stack(PixelFormat::Rgb888, 16, 16, 16);
    strings.scan.driver = DriverChip::Ws2812;
    strings.scan.pixel_clock_hz = 800'000;
    strings.scan.latch_ns = 300'000;
    strings.scan.strings = 8;
    scan = planned(strings, "tcp").scan;
    CHECK(scan.slice_ns == Approx(20e6));
    CHECK(scan.scan_ns == Approx(512 * 24 * 1250.0 + 300'000));
    CHECK(scan.planes_fit == 8);
    CHECK(scan.slices_fit == 0.0);

    DisplayDescription projector = swept(PixelFormat::Mono1);
    projector.slices = 192;
    projector.scan.driver = DriverChip::Dlp;
    projector.scan.planes_per_frame = 24;
    // 192 planes up and 192 down, 15 times a second, 24 in a frame.
    CHECK(planned(projector, "tcp").scan.projector_hz == Approx(240.0));
    projector.motion.dead_zone = 0.1;
    CHECK(planned(projector, "tcp").scan.projector_hz == Approx(300.0));
}

TEST_CASE("current is that of all LEDs that are lit at the same time", "[plan]") {
    DisplayDescription panels = large_rotor();
    // 2 × 128 × 64 pixels, a 32nd of them at a time, 3 colours of 5 mA.
    CurrentPlan current = planned(panels, "tcp").current;
    CHECK(current.lit_leds == 1536);
    CHECK(current.all_white_ma == 7680.0);
    CHECK(current.white_part == 1.0);
    panels.power.limit_ma = 4000.0;
    CHECK(planned(panels, "tcp").current.white_part == Approx(0.5208).epsilon(0.001));
    panels.power.limit_ma = 8000.0;
    CHECK(planned(panels, "tcp").current.white_part == 1.0);

    DisplayDescription strings = stack(PixelFormat::Rgb888, 16, 16, 16);
    strings.scan.driver = DriverChip::Ws2812;
    strings.power.led_ma = 12.0;
    CHECK(planned(strings, "tcp").current.all_white_ma == 16 * 16 * 16 * 3 * 12.0);
    DisplayDescription cube = stack(PixelFormat::Mono4, 8, 8, 8);
    cube.power.led_ma = 10.0;
    CHECK(planned(cube, "tcp").current.all_white_ma == 640.0);
}

TEST_CASE("memory is pages, a packet and the state, held against common controllers", "[plan]") {
    const MemoryPlan memory = planned(large_rotor(), "tcp").memory;
    CHECK(memory.page_bytes == 5'898'240);
    CHECK(memory.packet_bytes == 4096);
    CHECK(memory.two_pages_bytes == 2 * 5'898'240 + 4096 + 1000);
    CHECK(memory.three_pages_bytes == 3 * 5'898'240 + 4096 + 1000);
    // A frame of 64 bytes needs no packet longer than the shortest one allowed.
    CHECK(planned(stack(PixelFormat::Mono1, 8, 8, 8), "tcp").memory.two_pages_bytes == 2 * 64 + 256 + 1000);

    std::uint64_t before = 0;
    for (const Controller& controller : common_controllers()) {
        CHECK(controller.ram_bytes >= before);
        before = controller.ram_bytes;
    }
    CHECK(fits({"", 264 << 10}, 198 << 10));
    CHECK_FALSE(fits({"", 264 << 10}, (198 << 10) + 1));
}

TEST_CASE("motion is turns and the speed of the rim, or of the screen", "[plan]") {
    MotionPlan motion = planned(large_rotor(), "tcp").motion;
    CHECK(motion.turns_per_second == 20.0);
    CHECK(motion.rim_mm == Approx(std::sqrt(160.0 * 160.0 + 25.0)));
    CHECK(motion.fastest_m_per_s == Approx(20.116).epsilon(1e-4));
    CHECK(planned(rotor(PixelFormat::Mono1, false, 180.0), "tcp").motion.turns_per_second == 10.0);
    motion = planned(helix(PixelFormat::Mono1), "tcp").motion;
    CHECK(motion.turns_per_second == 25.0);
    CHECK(motion.rim_mm == Approx(16.0 * std::sqrt(2.0)));
    // 80 mm, 15 times a second: 2.4 m/s on average, π/2 of that where a sine is steepest.
    CHECK(planned(swept(PixelFormat::Mono1), "tcp").motion.fastest_m_per_s == Approx(3.77).epsilon(0.001));
    DisplayDescription constant = swept(PixelFormat::Mono1, MotionProfile::Constant);
    CHECK(planned(constant, "tcp").motion.fastest_m_per_s == Approx(2.4));
    constant.motion.profile = MotionProfile::Table;
    constant.motion.table_size = 3;
    constant.motion.table = {0.0, 0.75, 1.0};
    CHECK(planned(constant, "tcp").motion.fastest_m_per_s == Approx(3.6));
    CHECK(planned(stack(PixelFormat::Mono1), "tcp").motion.fastest_m_per_s == 0.0);
}

TEST_CASE("links are found by name, and gpio by its rate", "[plan]") {
    CHECK(find_link("hid-hs", std::nullopt)->bytes_per_second == 24e6);
    CHECK(find_link("gpio", 2e6)->bytes_per_second == 2e6);
    const auto refusal = [](std::string_view name, std::optional<double> rate) {
        const auto found = find_link(name, rate);
        return found ? std::string() : found.error().message;
    };
    const std::string unknown = refusal("usb3", std::nullopt);
    CHECK_THAT(unknown, Catch::Contains("usb3"));
    for (const LinkCeiling& link : link_ceilings()) CHECK_THAT(unknown, Catch::Contains(std::string(link.name)));
    CHECK_THAT(refusal("gpio", std::nullopt), Catch::Contains("--gpio-rate"));
    CHECK_THAT(refusal("gpio", std::nullopt), Catch::Contains("8 lines"));
    for (const double rate : {0.0, -5.0, 1e-9, 0.999, 1.001e10, 1e30, HUGE_VAL, std::nan("")}) {
        CAPTURE(rate);
        CHECK_THAT(refusal("gpio", rate), Catch::Contains("8 lines") && Catch::Contains("1 to 1e10"));
    }
    CHECK(find_link("gpio", 1.0)->bytes_per_second == 1.0);
    CHECK(find_link("gpio", 1e10)->bytes_per_second == 1e10);
    CHECK_THAT(refusal("tcp", 1e6), Catch::Contains("--link gpio"));
}
