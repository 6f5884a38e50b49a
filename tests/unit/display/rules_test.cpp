#include <cmath>
#include <limits>
#include <string>

#include "driver/display/toml.h"
#include "tests/catch.h"

using namespace xorvox;
using Catch::Matchers::Contains;

namespace {

DisplayDescription stack() {
    DisplayDescription display;
    display.name = DisplayName("mine");
    display.slices = 4;
    display.cycles_per_second = 60;
    display.panels[0].columns = 5;
    display.panels[0].rows = 3;
    return display;
}

DisplayDescription rotor() {
    DisplayDescription display = stack();
    display.kind = DisplayKind::RotatingPanel;
    display.panel_count = 2;
    display.panels[0].offset_mm = 2;
    display.panels[1] = display.panels[0];
    display.panels[1].angle_deg = 180;
    return display;
}

std::string message(const DisplayDescription& display) {
    const auto valid = validate_display(display);
    REQUIRE_FALSE(valid);
    return valid.error().message;
}

}  // namespace

TEST_CASE("descriptions made in code are validated") {
    CHECK(validate_display(stack()));
    CHECK(validate_display(rotor()));
    CHECK_THAT(message({}), Contains("slices: found 0"));
}

TEST_CASE("each field of a description is checked") {
    auto display = stack();
    display.slices = 4097;
    CHECK(message(display) == "display \"mine\": slices: found 4097; allowed: a whole number from 1 to 4096");
    display = stack();
    display.kind = DisplayKind{7};
    CHECK_THAT(message(display), Contains("kind: found number 7"));
    display = stack();
    display.format = PixelFormat{0};
    CHECK_THAT(message(display), Contains("format: found number 0"));
    display = stack();
    display.panel_count = 2;
    CHECK_THAT(message(display), Contains("panel: found 2 panels; allowed on stacked-planes: exactly one"));
    display = stack();
    display.clockwise = true;
    CHECK_THAT(message(display), Contains("clockwise"));
    display = stack();
    display.plane_pitch_mm = -1;
    CHECK_THAT(message(display), Contains("plane_pitch_mm: found -1"));
    display = stack();
    display.cycles_per_second = std::numeric_limits<double>::quiet_NaN();
    CHECK_THAT(message(display), Contains("cycles_per_second: found nan"));
    display = stack();
    display.panels[0].offset_mm = 2;
    CHECK_THAT(message(display), Contains("panel 0, offset_mm: found 2; allowed: 0"));

    display = rotor();
    display.panel_count = 9;
    CHECK_THAT(message(display), Contains("panel: found 9 panels"));
    display.panel_count = 4'000'000'000;
    CHECK_THAT(message(display), Contains("panel: found 4000000000 panels"));
    display.panel_count = 0;
    CHECK_THAT(message(display), Contains("panel: found 0 panels"));
    display = rotor();
    display.panels[1].columns = 5000;
    CHECK_THAT(message(display), Contains("panel 1, columns: found 5000"));
    display = rotor();
    display.panels[1].turned = 4;
    CHECK_THAT(message(display), Contains("panel 1, turned: found 4; allowed: a whole number from 0 to 3"));
    display = rotor();
    display.panels[0].tilt_deg = 90;
    CHECK_THAT(message(display), Contains("panel 0, tilt_deg: found 90"));
    display = rotor();
    display.panels[0].chain_position = 8;
    CHECK_THAT(message(display), Contains("panel 0, chain_position: found 8"));
    display = rotor();
    display.sweep_deg = 90;
    CHECK_THAT(message(display), Contains("sweep_deg: found 90; allowed: 360 or 180"));
}

TEST_CASE("each field of how a display is driven is checked") {
    const auto refused = [](auto change) {
        auto display = stack();
        change(display);
        return message(display);
    };
    using D = DisplayDescription;
    CHECK_THAT(refused([](D& d) { d.sync.index = IndexSource{9}; }), Contains("sync.index: found number 9"));
    CHECK_THAT(refused([](D& d) { d.sync.index_pulses = 0; }), Contains("sync.index_pulses: found 0"));
    CHECK_THAT(refused([](D& d) { d.sync.index_phase = 1.0; }),
               Contains("sync.index_phase: found 1; allowed: a number"));
    CHECK_THAT(refused([](D& d) { d.sync.slowest_cycles_per_second = -1; }), Contains("slowest_cycles_per_second"));
    CHECK_THAT(refused([](D& d) { d.sync.fastest_cycles_per_second = 1e9; }), Contains("fastest_cycles_per_second"));
    CHECK_THAT(refused([](D& d) { d.scan.driver = DriverChip{9}; }), Contains("scan.driver: found number 9"));
    CHECK_THAT(refused([](D& d) { d.scan.latch_ns = 2'000'000'000; }), Contains("scan.latch_ns: found 2000000000"));
    CHECK_THAT(refused([](D& d) { d.scan.row_groups = 0; }), Contains("scan.row_groups: found 0"));
    CHECK_THAT(refused([](D& d) { d.scan.bit_planes = 9; }), Contains("scan.bit_planes: found 9"));
    CHECK_THAT(refused([](D& d) { d.scan.strings = 0; }), Contains("scan.strings: found 0"));
    CHECK_THAT(refused([](D& d) { d.scan.planes_per_frame = 25; }), Contains("scan.planes_per_frame: found 25"));
    CHECK_THAT(refused([](D& d) {
                   d.scan.color_order = {'r', 'g', 'g'};
               }),
               Contains("scan.color_order: found \"rgg\""));
    CHECK_THAT(refused([](D& d) { d.scan.color_order = {'r', '\n', 'b'}; }), Contains("found \"r?b\""));
    CHECK_THAT(refused([](D& d) { d.light.response = Response{4}; }),
               Contains("light.response: found number 4; allowed: 0 (linear) to 3 (cie1931)"));
    CHECK_THAT(refused([](D& d) {
                   d.light = {Response::Gamma, 0.5};
               }),
               Contains("light.gamma: found 0.5; allowed: a number from 1 to 4"));
    CHECK_THAT(refused([](D& d) { d.light = {Response::Gamma, std::nan("")}; }), Contains("light.gamma: found nan"));
    CHECK_THAT(refused([](D& d) {
                   d.light = {Response::Srgb, 1.8};
               }),
               Contains("light.gamma: found 1.8; allowed with response \"srgb\": 2.2"));
    CHECK_THAT(refused([](D& d) { d.power.led_ma = -1; }), Contains("power.led_ma: found -1"));
    CHECK_THAT(refused([](D& d) { d.power.max_duty = 0; }), Contains("power.max_duty: found 0"));
    CHECK_THAT(refused([](D& d) { d.power.limit_ma = std::nan(""); }), Contains("power.limit_ma: found nan"));
    // What the device would take for 0 microamperes, and with that for unknown; and what it has no room for.
    CHECK_THAT(refused([](D& d) { d.power.led_ma = 4e-4; }), Contains("power.led_ma: found 0.0004; allowed: a number"
                                                                      " from 0.001 to 10000, or 0"));
    CHECK_THAT(refused([](D& d) { d.power.led_ma = 1e6; }), Contains("power.led_ma: found 1000000"));
    CHECK_THAT(refused([](D& d) {
                   d.power.led_ma = 1;
                   d.power.limit_ma = 4e-4;
               }),
               Contains("power.limit_ma: found 0.0004"));
}

TEST_CASE("what belongs to another kind of display is refused") {
    const auto refused = [](auto change) {
        auto display = stack();
        change(display);
        return message(display);
    };
    using D = DisplayDescription;
    CHECK_THAT(refused([](D& d) { d.sweep_deg = 180; }), Contains("sweep_deg: found 180; allowed: 360"));
    CHECK_THAT(refused([](D& d) { d.blades = 2; }), Contains("blades: found 2; allowed: 1"));
    CHECK_THAT(refused([](D& d) { d.motion.stroke_mm = 5; }), Contains("motion.stroke_mm: found 5; allowed: 0"));
    CHECK_THAT(refused([](D& d) { d.motion.both_ways = true; }), Contains("motion.both_ways"));
    CHECK_THAT(refused([](D& d) { d.motion.profile = MotionProfile::Sine; }), Contains("motion.profile"));
    CHECK_THAT(refused([](D& d) { d.panels[0].turned = 1; }), Contains("panel 0, turned: found 1; allowed: 0"));
    CHECK_THAT(refused([](D& d) { d.panels[0].mirrored = true; }), Contains("panel 0, mirrored: found true"));
    static constexpr PointMm place[1] = {};
    CHECK_THAT(refused([](D& d) { d.points = place; }), Contains("points: does not apply to stacked-planes"));
    static constexpr double height[1] = {};
    auto display = rotor();
    display.plane_heights_mm = height;
    CHECK_THAT(message(display), Contains("plane_heights_mm: does not apply to rotating-panel"));
}

TEST_CASE("the digest ignores name and speed and nothing else") {
    const auto digest = geometry_digest(rotor());
    auto display = rotor();
    display.name = DisplayName("other");
    display.cycles_per_second = 1;
    CHECK(geometry_digest(display) == digest);
    display.clockwise = true;
    CHECK(geometry_digest(display) != digest);
    display = rotor();
    display.panels[1].angle_deg = 90;
    CHECK(geometry_digest(display) != digest);
    display = rotor();
    display.format = PixelFormat::Rgb888;
    CHECK(geometry_digest(display) != digest);
}
