// Descriptions whose parts contradict each other are refused, with line and reason.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "driver/display/timing.h"
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
    display.panels[0] = {.columns = 8, .rows = 8};
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

DisplayDescription swept() {
    DisplayDescription display = stack();
    display.kind = DisplayKind::SweptPlane;
    display.motion.stroke_mm = 10;
    return display;
}

/// One of a rotor's two panels that are wired to hub75.
DisplayDescription wired() {
    DisplayDescription display = rotor();
    display.format = PixelFormat::Rgb332;
    display.slices = 360;
    display.cycles_per_second = 10;
    display.scan.driver = DriverChip::Hub75;
    display.scan.pixel_clock_hz = 33'000'000;
    display.scan.row_groups = 32;
    display.scan.bit_planes = 2;
    for (std::uint8_t p = 0; p < 2; ++p) {
        display.panels[p].columns = 128;
        display.panels[p].rows = 64;
        display.panels[p].connector = p;
    }
    return display;
}

std::string message(const DisplayDescription& display) {
    const auto valid = validate_display(display);
    REQUIRE_FALSE(valid);
    return valid.error().message;
}

void check_fine(const DisplayDescription& display) {
    const auto valid = validate_display(display);
    if (!valid) FAIL_CHECK(valid.error().message);
}

}  // namespace

TEST_CASE("panels through each other are refused") {
    auto display = rotor();
    check_fine(display);
    display.panels[1].angle_deg = 0;
    CHECK(message(display) ==
          "display \"mine\": panel 1, its face passes through or covers that of panel 0; move one"
          " of them by shift_mm, offset_mm, lift_mm or angle_deg");
    display.panels[1].angle_deg = 90;
    CHECK_THAT(message(display), Contains("panel 1, its face passes through"));
    display.panels[1].offset_mm = 4;
    check_fine(display);
}

TEST_CASE("the line of a panel in another's way is its table's") {
    const std::string panel = "[[panel]]\ncolumns = 4\nrows = 4\ncolumn_pitch_mm = 1\nrow_pitch_mm = 1\n";
    const std::string head =
        "name = \"x\"\nkind = \"rotating-panel\"\nformat = \"mono1\"\nslices = 4\ncycles_per_second = 1\n";
    const auto display = parse_display(head + panel + panel, "x.toml");
    REQUIRE_FALSE(display);
    CHECK_THAT(display.error().message, Contains("x.toml: line 11: panel 1: its face passes through or covers"));
    CHECK(find_mistakes(head + panel + "shift_mm = -2\n" + panel + "shift_mm = 2\n").empty());
}

TEST_CASE("wiring used twice is refused") {
    auto display = wired();
    check_fine(display);
    display.panels[1].connector = 0;
    CHECK_THAT(message(display), Contains("panel 1, chain_position: found 0 on connector 0, where panel 0 is already"));
    display.panels[1].chain_position = 1;
    display.scan.bit_planes = 1;  // A chain of two takes twice as long.
    check_fine(display);
    display.panels[1].chain_position = 2;
    CHECK_THAT(message(display), Contains("panel 1, chain_position: found 2, but no panel is at 1 on connector 0"));
    check_fine(rotor());  // Nothing is known of its wiring.
}

TEST_CASE("wiring that a file gives twice is refused, whatever drives it") {
    const std::string panel = "[[panel]]\ncolumns = 4\nrows = 4\ncolumn_pitch_mm = 1\nrow_pitch_mm = 1\n";
    const std::string two =
        "name = \"x\"\nkind = \"rotating-panel\"\nformat = \"mono1\"\nslices = 4\ncycles_per_second = 1\n" + panel +
        "shift_mm = -2\n" + panel + "shift_mm = 2\n";
    CHECK(find_mistakes(two).empty());
    const auto mistakes = find_mistakes(two + "connector = 0\nchain_position = 0\n");
    REQUIRE(mistakes.size() == 1);
    CHECK(mistakes[0].line == 19);
    CHECK_THAT(mistakes[0].message, Contains("panel 1: chain_position: found 0 on connector 0, where panel 0 is"));
    CHECK(find_mistakes(two + "connector = 1\n").empty());
}

TEST_CASE("more bit planes than bits are refused") {
    auto display = stack();
    display.format = PixelFormat::Rgb332;
    display.scan.bit_planes = 3;
    check_fine(display);
    display.scan.bit_planes = 4;
    CHECK_THAT(message(display),
               Contains("scan.bit_planes: found 4; allowed: at most 3, for rgb332 has no more bits a channel"));
}

TEST_CASE("a rate that the scan cannot reach is refused with both times and with what fits") {
    auto display = wired();
    display.scan.bit_planes = 3;
    const std::string report = message(display);
    CHECK_THAT(report,
               Contains("cycles_per_second: found 10, at which a slice has 277.8 µs, but its scan needs 376.3 "
                        "µs for 3 bit planes; what fits: 2 bit planes, or 265 slices, or 7.38 cycles a second"));
    auto fits = display;
    fits.scan.bit_planes = 2;
    check_fine(fits);
    fits = display;
    fits.slices = 265;
    check_fine(fits);
    fits.slices = 266;
    CHECK_THAT(message(fits), Contains("cycles_per_second"));
    fits = display;
    fits.cycles_per_second = 7.38;
    check_fine(fits);
    fits.cycles_per_second = 7.39;
    CHECK_THAT(message(fits), Contains("cycles_per_second"));
}

TEST_CASE("strings that are too long for the frame rate are refused") {
    auto display = stack();
    display.format = PixelFormat::Rgb888;
    display.slices = 16;
    display.panels[0] = {.columns = 16, .rows = 16};
    display.scan.driver = DriverChip::Ws2812;
    display.scan.pixel_clock_hz = 800'000;
    display.scan.latch_ns = 300'000;
    display.scan.strings = 8;
    check_fine(display);
    display.scan.strings = 4;
    CHECK_THAT(message(display), Contains("at which a frame has 16.67 ms, but its scan needs 31.02 ms; what"
                                          " fits: 8 slices, or 32.2 cycles a second"));
}

TEST_CASE("what drives the display must know what the scan is told") {
    const auto refused = [](auto change) {
        auto display = stack();
        change(display.scan);
        return message(display);
    };
    CHECK_THAT(refused([](Scan& s) { s.strings = 2; }),
               Contains("scan.strings: found 2; allowed with driver \"direct\""));
    CHECK_THAT(refused([](Scan& s) { s.serpentine = true; }), Contains("scan.serpentine"));
    CHECK_THAT(refused([](Scan& s) { s.layers_first = true; }), Contains("scan.register_order"));
    CHECK_THAT(refused([](Scan& s) { s.planes_per_frame = 24; }), Contains("scan.planes_per_frame: found 24"));
    CHECK_THAT(refused([](Scan& s) { s.row_groups = 9; }),
               Contains("scan.row_groups: found 9; allowed: what divides 8"));
    CHECK_THAT(refused([](Scan& s) { s.row_groups = 3; }),
               Contains("scan.row_groups: found 3; allowed: what divides 8"));
    CHECK_THAT(refused([](Scan& s) { s.driver = DriverChip::Ws2812; }),
               Contains("format: found \"mono1\"; allowed with driver \"ws2812\", whose LEDs have three colours: rgb"));
    auto display = wired();
    display.scan.row_groups = 64;
    CHECK_THAT(message(display), Contains("found 64; allowed: what divides 32, for panel 0 has 64 rows, which hub75"
                                          " lights in two halves"));
    display.scan.row_groups = 1;
    display.panels[1].rows = 63;
    CHECK_THAT(message(display), Contains("panel 1, rows: found 63; allowed with driver \"hub75\", which lights two"));
    display = swept();
    display.scan.driver = DriverChip::Dlp;
    display.scan.planes_per_frame = 24;
    check_fine(display);
    display.format = PixelFormat::Rgb111;
    CHECK_THAT(message(display), Contains("scan.planes_per_frame: found 24; allowed with format \"rgb111\": 1"));
}

TEST_CASE("strings hold LEDs of three colours, equally many each") {
    auto display = stack();
    display.scan.driver = DriverChip::Apa102;
    for (const PixelFormat format : kPixelFormats) {
        display.format = format;
        CHECK(validate_display(display).has_value() == (bits_per_pixel(format) > bits_per_channel(format)));
    }
    display.format = PixelFormat::Rgb888;
    display.scan.strings = 32;
    check_fine(display);
    display.scan.strings = 3;
    CHECK_THAT(message(display), Contains("scan.strings: found 3; allowed: what divides the 256 LEDs"));
    display.scan.strings = 1;
    display.scan.row_groups = 2;
    CHECK_THAT(message(display), Contains("scan.row_groups: found 2; allowed with driver \"apa102\": 1"));
}

TEST_CASE("strings that move hold the LEDs of one slice") {
    auto display = swept();  // 8 × 8 LEDs, 4 slices.
    display.format = PixelFormat::Rgb888;
    display.scan.driver = DriverChip::Ws2812;
    display.scan.strings = 64;
    display.scan.serpentine = true;
    check_fine(display);
    display.scan.strings = 128;
    CHECK_THAT(message(display), Contains("scan.strings: found 128; allowed: what divides the 64 LEDs"));
}

TEST_CASE("one channel has no order of colours") {
    auto display = stack();
    display.scan.color_order = {'g', 'r', 'b'};
    CHECK_THAT(message(display), Contains("scan.color_order: found \"grb\"; allowed with format \"mono1\""));
    display.format = PixelFormat::Rgb111;
    check_fine(display);
}

TEST_CASE("the shortest light is at least as long as its edges where it is known") {
    auto display = stack();
    display.scan.min_on_ns = 99;
    display.scan.rise_ns = 60;
    check_fine(display);
    display.scan.rise_ns = 100;
    CHECK_THAT(message(display), Contains("scan.min_on_ns: found 99; allowed: at least 100"));
    display.scan.rise_ns = 60;
    display.scan.fall_ns = 40;
    CHECK_THAT(message(display),
               Contains("scan.min_on_ns: found 99; allowed: at least 100, which rise_ns and fall_ns"));
    display.scan.min_on_ns = 100;
    check_fine(display);
    display.scan.min_on_ns = 0;
    check_fine(display);
}

TEST_CASE("a limit of current needs the current of an LED") {
    auto display = stack();
    display.power.limit_ma = 500;
    CHECK_THAT(message(display),
               Contains("power.limit_ma: found 500, but it needs led_ma, or no current can be reckoned"));
    display.power.led_ma = 10;
    check_fine(display);

    const std::string file =
        "name = \"x\"\nkind = \"stacked-planes\"\nformat = \"mono1\"\ncycles_per_second = 1\nslices = 3\n"
        "plane_pitch_mm = 1\n[[panel]]\ncolumns = 3\nrows = 1\ncolumn_pitch_mm = 1\nrow_pitch_mm = 1\n[power]\n"
        "max_duty = 0.5\nlimit_ma = 500\n";
    const auto mistakes = find_mistakes(file);
    REQUIRE(mistakes.size() == 1);
    CHECK(mistakes[0].line == 14);
    CHECK(mistakes[0].contradiction);
    CHECK(find_mistakes(file + "led_ma = 2\n").empty());
}

TEST_CASE("light that is longer than a slice is said once, as a rate that the scan cannot reach") {
    const std::string file =
        "name = \"x\"\nkind = \"stacked-planes\"\nformat = \"rgb332\"\ncycles_per_second = 60000\nslices = 4\n"
        "plane_pitch_mm = 1\n[[panel]]\ncolumns = 3\nrows = 1\ncolumn_pitch_mm = 1\nrow_pitch_mm = 1\n[scan]\n"
        "min_on_ns = 4000\n";
    for (const char* power : {"", "[power]\nmax_duty = 0.3\n", "[power]\nmax_duty = 1\n"}) {
        const auto mistakes = find_mistakes(file + power);
        REQUIRE(mistakes.size() == 1);
        CHECK(mistakes[0].line == 4);
        CHECK_THAT(mistakes[0].message, Contains("at which a slice has 4.167 µs, but its scan needs 28 µs"));
    }
}

TEST_CASE("a duty below what the scan lights is refused") {
    auto display = stack();  // A layer is lit for a fourth of a refresh at most.
    display.format = PixelFormat::Mono2;
    display.scan.min_on_ns = 1'000'000;
    display.power.max_duty = 0.2;
    check_fine(display);
    display.power.max_duty = 0.17;
    CHECK_THAT(message(display),
               Contains("power.max_duty: found 0.17, but scan.min_on_ns lights an LED for 3 ms of 16.67 ms"));
    auto turning = rotor();
    turning.scan.min_on_ns = 1'000'000;
    turning.power.max_duty = 0.25;
    check_fine(turning);
    turning.power.max_duty = 0.23;
    CHECK_THAT(message(turning), Contains("a part of 0.24; allowed: at least that"));
}

TEST_CASE("a duty for which no brightness is faint enough is refused, and the least that is allowed is enough") {
    auto display = rotor();
    display.power.max_duty = 0.0039;
    CHECK_THAT(message(display),
               Contains("power.max_duty: found 0.0039, for which the least brightness, 1 of 255, is too"
                        " much, so that the display would stay dark; allowed: at least 0.00393"));
    display.power.max_duty = 0.00393;
    check_fine(display);
    // A layer of a cube is lit for an eighth of the time, and a row for a quarter of that.
    display = stack();
    display.slices = 8;
    display.scan.row_groups = 4;
    display.power.max_duty = 1.2e-4;
    CHECK_THAT(message(display), Contains("allowed: at least 0.000123"));
    display.power.max_duty = 1.23e-4;
    check_fine(display);
}

TEST_CASE("half a turn needs a panel that comes to stand where it was") {
    auto display = rotor();
    display.sweep_deg = 180;
    CHECK_THAT(message(display), Contains("sweep_deg: found 180 with 2 panels"));
    display.panel_count = 1;
    CHECK_THAT(message(display), Contains("panel 0, offset_mm: found 2; allowed with sweep_deg = 180: 0"));
    display.panels[0].offset_mm = 0;
    check_fine(display);
    const auto refused = [&](double Panel::*field) {
        auto moved = display;
        moved.panels[0].*field = 0.5;
        return message(moved);
    };
    CHECK_THAT(refused(&Panel::shift_mm), Contains("panel 0, shift_mm: found 0.5; allowed with sweep_deg = 180: 0"));
    CHECK_THAT(refused(&Panel::skew_mm), Contains("panel 0, skew_mm"));
    CHECK_THAT(refused(&Panel::tilt_deg), Contains("panel 0, tilt_deg"));
    display.panels[0].lift_mm = 3;
    display.panels[0].angle_deg = 30;
    check_fine(display);
}

TEST_CASE("a table of motion increases from 0 to 1") {
    const auto with_table = [](std::vector<double> heights) {
        auto display = swept();
        display.motion.profile = MotionProfile::Table;
        display.motion.table_size = static_cast<std::uint32_t>(heights.size());
        std::copy(heights.begin(), heights.end(), display.motion.table.begin());
        return display;
    };
    check_fine(with_table({0, 1}));
    check_fine(with_table({0, 0.1, 0.9, 1}));
    CHECK_THAT(message(with_table({0.1, 1})), Contains("motion.table: found 0.1 as the first height; allowed: 0"));
    CHECK_THAT(message(with_table({0, 0.9})), Contains("motion.table: found 0.9 as the last height; allowed: 1"));
    CHECK_THAT(message(with_table({0, 0.5, 0.5, 1})), Contains("found 0.5 after 0.5; allowed: heights that increase"));
    CHECK_THAT(message(with_table({0, 0.5, 0.4, 1})), Contains("found 0.4 after 0.5"));
    CHECK_THAT(message(with_table({0, std::nan(""), 1})), Contains("found nan after 0"));
    CHECK_THAT(message(with_table({0})), Contains("found 1 heights; allowed: 2 to 64"));
    auto display = swept();
    display.motion.table_size = 2;
    CHECK_THAT(message(display), Contains("motion.table: found 2 heights; allowed: none, or profile = \"table\""));
    display = swept();
    display.motion.dead_zone = 0.46;
    CHECK_THAT(message(display), Contains("motion.dead_zone: found 0.46; allowed: a number from 0 to 0.45"));
    display.motion.dead_zone = 0.45;
    check_fine(display);
}

TEST_CASE("uneven planes have a height each, and increase") {
    auto display = stack();
    const std::array heights{-3.0, -1.0, 0.5, 9.0};
    display.plane_heights_mm = heights;
    check_fine(display);
    display.slices = 5;
    CHECK_THAT(message(display), Contains("plane_heights_mm: found 4 heights; allowed: 5, one for each slice"));
    display.slices = 4;
    const std::array falling{-3.0, -1.0, -1.0, 9.0};
    display.plane_heights_mm = falling;
    CHECK_THAT(message(display), Contains("plane_heights_mm: found -1 after -1; allowed: heights that increase"));
    const std::array far{-3.0, -1.0, 0.5, 9e9};
    display.plane_heights_mm = far;
    CHECK_THAT(message(display), Contains("plane_heights_mm: found 9000000000"));
}

TEST_CASE("free points are as many as pixels, each at its own place") {
    auto display = stack();
    display.kind = DisplayKind::FreePoints;
    display.slices = 1;
    display.panels[0] = {.columns = 2, .rows = 2};
    CHECK_THAT(message(display), Contains("points: found 0 places; allowed: 4, one for each of 2 × 2 pixels"));
    std::array<PointMm, 4> points{{{0, 0, 1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    display.points = points;
    check_fine(display);
    points[3] = {-0.0, 0, 1};
    CHECK_THAT(message(display),
               Contains("points: found [0, 0, 1] for LED 0 and for LED 3; allowed: one LED a place") ||
                   Contains("points: found [-0, 0, 1] for LED 0 and for LED 3"));
    display.slices = 2;
    CHECK_THAT(message(display), Contains("slices: found 2; allowed: 1"));
}

TEST_CASE("the line of a point that is there twice is its own") {
    const auto mistakes = find_mistakes(
        "name = \"x\"\nkind = \"free-points\"\nformat = \"mono1\"\ncycles_per_second = 1\npoints = [\n[1, 2, 3],\n"
        "[4, 5, 6],\n[1, 2, 3],\n]\n[[panel]]\ncolumns = 3\nrows = 1\n");
    REQUIRE(mistakes.size() == 1);
    CHECK(mistakes[0].line == 8);
    CHECK_THAT(mistakes[0].message, Contains("points: found [1, 2, 3] for LED 0 and for LED 2"));
}

TEST_CASE("the speeds of stall and overspeed are below and above the display's") {
    auto display = rotor();
    display.sync.index = IndexSource::Pulses;
    display.sync.slowest_cycles_per_second = 59.9;
    display.sync.fastest_cycles_per_second = 60.1;
    check_fine(display);
    display.sync.slowest_cycles_per_second = 60;
    CHECK_THAT(message(display), Contains("sync.slowest_cycles_per_second: found 60; allowed: less than"));
    display.sync.slowest_cycles_per_second = 0;
    display.sync.fastest_cycles_per_second = 59;
    CHECK_THAT(message(display), Contains("sync.fastest_cycles_per_second: found 59; allowed: more than"));
}

TEST_CASE("speeds of stall and overspeed need an index") {
    auto display = rotor();
    display.sync.slowest_cycles_per_second = 59.9;
    CHECK_THAT(message(display), Contains("sync.slowest_cycles_per_second: found 59.9, but index = \"none\""));
    display.sync = {};
    display.sync.fastest_cycles_per_second = 60.1;
    CHECK_THAT(message(display), Contains("sync.fastest_cycles_per_second: found 60.1, but index = \"none\""));
}

TEST_CASE("pulses need a source") {
    auto display = rotor();
    display.sync.index_pulses = 2;
    CHECK_THAT(message(display), Contains("sync.index_pulses: found 2, but index = \"none\""));
    display.sync.index = IndexSource::Pulses;
    display.sync.index_phase = 0.5;
    check_fine(display);
    display.sync = {};
    display.sync.index_phase = 0.5;
    CHECK_THAT(message(display), Contains("sync.index_phase: found 0.5, but index = \"none\""));
}

TEST_CASE("a rotor whose panels lean counts a pixel as a column of samples") {
    auto display = rotor();
    display.panel_count = 1;
    display.slices = 1024;
    display.panels[0].columns = 256;
    display.panels[0].rows = 64;
    display.panels[0].tilt_deg = 10;
    check_fine(display);
    display.slices = 1025;
    CHECK_THAT(message(display),
               Contains("slices: found 1025, which makes 16793600 columns of samples; allowed: at most"
                        " 16777216; a pixel counts as one"));
    display.panels[0].tilt_deg = 0;
    check_fine(display);
}

TEST_CASE("turns and pulses that the device cannot count are refused") {
    DisplayDescription display = stack();
    display.kind = DisplayKind::RotatingPanel;
    display.sweep_deg = 180;
    display.sync.index = IndexSource::Pulses;
    display.cycles_per_second = 2e-3;
    CHECK(validate_display(display).has_value());
    display.cycles_per_second = 1.5e-3;
    CHECK_THAT(validate_display(display).error().message, Contains("cycles_per_second") && Contains("2000 s"));
    display.sync.index = IndexSource::None;
    CHECK(validate_display(display).has_value());
    display.sync.index = IndexSource::Encoder;
    display.cycles_per_second = 30;
    display.sync.index_pulses = 65536;
    CHECK(validate_display(display).has_value());
    display.cycles_per_second = 1900;
    CHECK_THAT(validate_display(display).error().message, Contains("sync.index_pulses") && Contains("16 ns"));
}

TEST_CASE("several contradictions are all found") {
    const auto mistakes = find_mistakes(
        "name = \"x\"\nkind = \"swept-plane\"\nformat = \"mono1\"\ncycles_per_second = 1\nslices = 3\n[motion]\n"
        "stroke_mm = 3\nprofile = \"table\"\ntable = [0,\n0.5,\n0.4, 1]\n[[panel]]\ncolumns = 3\nrows = 1\n"
        "column_pitch_mm = 1\nrow_pitch_mm = 1\n[scan]\nbit_planes = 2\nstrings = 2\n[sync]\nindex_pulses = 3\n");
    REQUIRE(mistakes.size() == 4);
    CHECK(std::ranges::all_of(mistakes, &DisplayMistake::contradiction));
    CHECK(mistakes[0].line == 11);
    CHECK_THAT(mistakes[0].message, Contains("motion.table: found 0.4 after 0.5"));
    CHECK(mistakes[1].line == 18);
    CHECK_THAT(mistakes[1].message, Contains("scan.bit_planes: found 2"));
    CHECK(mistakes[2].line == 19);
    CHECK(mistakes[3].line == 21);
}
