// The scanners on virtual lines: which LED is lit for how long, when, and which levels the pins have meanwhile.
#include <array>
#include <cstdint>
#include <vector>

#include "driver/device/scan/modulation.h"
#include "tests/catch.h"
#include "tests/unit/device/scan_rig.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

/// Bits of a channel of a pixel as on the wire; by the drawing in description.h, for the formats used here.
struct Code {
    std::uint32_t level = 0;
    std::uint32_t bits = 0;
};
Code code_of(PixelFormat format, std::span<const std::byte> row, std::uint32_t column, std::uint32_t channel) {
    const auto byte = [&](std::uint32_t i) { return std::to_integer<std::uint32_t>(row[i]); };
    switch (format) {
        case PixelFormat::Mono1: return {byte(column / 8) >> (column % 8) & 1u, 1};
        case PixelFormat::Mono2: return {byte(column / 4) >> (2 * (column % 4)) & 3u, 2};
        case PixelFormat::Mono4: return {byte(column / 2) >> (4 * (column % 2)) & 15u, 4};
        case PixelFormat::Rgb111: {
            const std::uint32_t bit = 3 * column + channel;
            return {byte(bit / 8) >> (bit % 8) & 1u, 1};
        }
        case PixelFormat::Rgb332:
            if (channel == 2) return {byte(column) & 3u, 2};
            return {byte(column) >> (channel == 0 ? 5 : 2) & 7u, 3};
        default: return {byte(3 * column + channel), 8};
    }
}

/// For how long an LED is lit in a slice: its bits, the most significant first, and again from there.
std::uint64_t expected_ns(const DisplayDescription& display, const device::Modulation& modulation,
                          std::span<const std::byte> bytes, const Led& led, bool mirrored, std::uint8_t brightness) {
    std::size_t at = 0;
    for (std::uint32_t p = 0; p < led.panel; ++p) {
        at += row_bytes(display.panels[p], display.format) * display.panels[p].rows;
    }
    const Panel& panel = display.panels[led.panel];
    at += row_bytes(panel, display.format) * led.row;
    const std::uint32_t column = mirrored ? panel.columns - 1u - led.column : led.column;
    const Code code = code_of(display.format, bytes.subspan(at), column, led.channel);
    const std::uint32_t shown = shown_bit_planes(display) < code.bits ? shown_bit_planes(display) : code.bits;
    std::uint64_t sum = 0;
    for (std::uint32_t plane = 0; plane < modulation.planes; ++plane) {
        const std::uint32_t bit = code.bits - 1 - plane % shown;
        if ((code.level >> bit & 1u) != 0) sum += modulation.on_ns(plane, brightness);
    }
    return sum;
}

/// Scans a slice, and compares every LED's light and every strobe's time with the plan.
void check_slice(const DisplayDescription& display, std::uint64_t available_ns, bool mirrored, std::uint8_t brightness,
                 std::uint32_t slice) {
    ScanRig rig(display);
    const auto bytes = random_slice(display, slice + 17);
    device::ScanOrder order = lit_order(bytes, slice, brightness);
    order.mirrored = mirrored;
    REQUIRE(rig.blank() == Status::Ok);
    const std::uint64_t begin_ns = rig.lines().time_ns();
    REQUIRE(rig.scan(order, available_ns) == Status::Ok);

    const auto modulation = device::modulate(device::modulation_config(display), available_ns);
    std::vector<Lit> expected;
    std::uint64_t at = begin_ns + modulation.first_ns();
    for (std::uint32_t g = 0; g < modulation.row_groups; ++g) {
        for (std::uint32_t p = 0; p < modulation.planes; ++p) {
            const bool cube = display.scan.driver == DriverChip::ShiftRegister595;
            const std::uint64_t on_ns = modulation.on_ns(p, brightness);
            if (on_ns > 0) expected.push_back({at, at + on_ns, static_cast<int>(cube ? slice : g)});
            at += modulation.slot_ns(p);
        }
    }
    CHECK(rig.bench->lights.size() == expected.size());
    CHECK((rig.bench->lights == expected));
    CHECK_FALSE(rig.bench->several);
    if (!expected.empty()) CHECK(rig.lines().time_ns() == expected.back().off_ns);

    const std::vector<Led> leds = Bench::all_leds(display);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < leds.size(); ++i) {
        const std::uint64_t planned = expected_ns(display, modulation, bytes, leds[i], mirrored, brightness);
        wrong += rig.bench->light_ns[i] == planned ? 0u : 1u;
    }
    CHECK(wrong == 0);
}

std::string bits_of(LineMask levels, std::uint32_t lines) {
    std::string text;
    for (std::uint32_t i = 0; i < lines; ++i) text += (levels >> i & 1u) != 0 ? '1' : '0';
    return text;
}

}  // namespace

TEST_CASE("scanners light every LED for its code's time, strobe by strobe as modulate() says") {
    for (const PixelFormat format : {PixelFormat::Mono1, PixelFormat::Mono2, PixelFormat::Mono4, PixelFormat::Rgb111,
                                     PixelFormat::Rgb332, PixelFormat::Rgb888}) {
        for (DisplayDescription display : {small_hub75(format), small_cube(format), small_matrix(format)}) {
            if (is_mono(format)) display.scan.color_order = {'r', 'g', 'b'};
            for (const std::uint64_t available_ns : {100u, 30'000u, 97'531u, 2'000'000u}) {
                INFO(display.name.view() << ", " << to_string(format) << ", " << available_ns << " ns");
                check_slice(display, available_ns, false, 255, 1);
            }
            INFO(display.name.view() << ", " << to_string(format) << ", dimmed or mirrored");
            check_slice(display, 200'000, false, 100, 2);
            check_slice(display, 200'000, true, 255, 0);
            check_slice(display, 200'000, false, 0, 0);
        }
    }
}

TEST_CASE("a cube's bits go out in either order, pixels or layers first") {
    for (const bool msb_first : {true, false}) {
        for (const bool layers_first : {true, false}) {
            for (const PixelFormat format : {PixelFormat::Mono2, PixelFormat::Rgb111}) {
                DisplayDescription display = small_cube(format);
                display.scan.msb_first = msb_first;
                display.scan.layers_first = layers_first;
                if (!is_mono(format)) display.scan.color_order = {'b', 'r', 'g'};
                for (std::uint32_t layer = 0; layer < display.slices; ++layer) {
                    INFO("msb first " << msb_first << ", layers first " << layers_first << ", layer " << layer);
                    check_slice(display, 100'000, false, 255, layer);
                }
            }
        }
    }
}

TEST_CASE("fewer bits are shown where the display shows fewer, and where there is no time") {
    DisplayDescription display = small_hub75();
    display.scan.bit_planes = 2;
    check_slice(display, 300'000, false, 255, 0);
    display.scan.bit_planes = 0;
    const auto config = device::modulation_config(display);
    REQUIRE(device::modulate(config, 9000).planes == 1);
    check_slice(display, 9000, false, 255, 0);
}

TEST_CASE("a HUB75 panel of 2 x 2 LEDs has these levels, nanosecond by nanosecond") {
    DisplayDescription display = small_hub75(PixelFormat::Rgb111);
    display.panel_count = 1;
    display.panels[0] = {.columns = 2, .rows = 2, .offset_mm = 9.0};
    display.scan = {};
    display.scan.driver = DriverChip::Hub75;
    display.scan.pixel_clock_hz = 10'000'000;
    display.scan.latch_ns = 30;
    display.scan.fall_ns = 20;
    ScanRig rig(display);
    // R, G, B from bit 0 on. Row 0: column 0 is red and blue, column 1 green. Row 1: column 0 is off, column 1 white.
    const std::array<std::byte, 2> bytes{std::byte{0b010'101}, std::byte{0b111'000}};
    REQUIRE(rig.scan(lit_order(bytes), 1250) == Status::Ok);
    // Shift 200 ns, gap 50; what is left of 1250 is 950 for the light: 950 + 10 as if nothing fell.
    struct Expected {
        std::uint64_t time_ns;
        const char* levels;  // clock, latch, oe, a b c d e, r1 g1 b1, r2 g2 b2
    };
    const std::vector<Expected> expected{
        {0, "001 00000 000 000"},     // Safe.
        {0, "001 00000 101 000"},     // Column 0 of both rows, the clock low …
        {50, "101 00000 101 000"},    // … and taken.
        {100, "001 00000 010 111"},   // Column 1.
        {150, "101 00000 010 111"},   //
        {220, "111 00000 010 111"},   // Shifted at 200, and 20 for what was lit to fall: latched.
        {235, "101 00000 010 111"},   // A pulse of 15, and 15 to settle:
        {250, "100 00000 010 111"},   // lit,
        {1200, "101 00000 010 111"},  // for 950.
    };
    REQUIRE(rig.bench->edges.size() == expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        std::string levels = bits_of(rig.bench->edges[i].levels, 14);
        levels.insert(8, 1, ' ').insert(3, 1, ' ').insert(13, 1, ' ');
        CHECK(rig.bench->edges[i].time_ns == expected[i].time_ns);
        CHECK(levels == expected[i].levels);
    }
}

TEST_CASE("a cube of 2 x 1 x 2 LEDs has these levels, nanosecond by nanosecond") {
    DisplayDescription display = small_cube(PixelFormat::Mono1);
    display.slices = 2;
    display.panels[0] = {.columns = 2, .rows = 1};
    display.scan = {};
    display.scan.driver = DriverChip::ShiftRegister595;
    display.scan.pixel_clock_hz = 50'000'000;
    display.scan.latch_ns = 5;
    ScanRig rig(display);
    const std::array<std::byte, 1> bytes{std::byte{0b01}};
    REQUIRE(rig.scan(lit_order(bytes, 1), 1085) == Status::Ok);
    // Four bits in 80 ns: pixel 1, pixel 0, layer 1, layer 0; then 5 to settle, and 995 of light and 5 after it.
    struct Expected {
        std::uint64_t time_ns;
        const char* levels;  // clock, latch, oe, data
    };
    const std::vector<Expected> expected{
        {0, "0010"},                 // Safe. Pixel 1 is off, the clock low …
        {10, "1010"},                // … and taken.
        {20, "0011"}, {30, "1011"},  // Pixel 0 is lit.
        {40, "0011"}, {50, "1011"},  // Layer 1 is selected,
        {60, "0010"}, {70, "1010"},  // layer 0 is not.
        {80, "1110"}, {82, "1010"},  // Latched.
        {85, "1000"}, {1080, "1010"},
    };
    // The first element sets nothing: data and clock are low already.
    REQUIRE(rig.bench->edges.size() == expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        CHECK(rig.bench->edges[i].time_ns == expected[i].time_ns);
        CHECK(bits_of(rig.bench->edges[i].levels, 4) == expected[i].levels);
    }
}

TEST_CASE("a matrix of 2 rows and 2 columns has these levels, nanosecond by nanosecond") {
    DisplayDescription display = small_matrix(PixelFormat::Mono1);
    display.panel_count = 1;
    display.panels[0] = {.columns = 2, .rows = 2};
    display.scan = {};
    display.scan.latch_ns = 10;
    display.scan.fall_ns = 40;
    display.scan.row_groups = 2;
    ScanRig rig(display);
    const std::array<std::byte, 2> bytes{std::byte{0b10}, std::byte{0b01}};
    REQUIRE(rig.scan(lit_order(bytes), 1050) == Status::Ok);
    // Two slots of 450 and a gap of 50, and the gap before the first.
    struct Expected {
        std::uint64_t time_ns;
        const char* levels;  // row 0, row 1, column 0, column 1
    };
    const std::vector<Expected> expected{
        {0, "0000"}, {40, "0001"}, {50, "1001"}, {500, "0001"}, {540, "0010"}, {550, "0110"}, {1000, "0010"},
    };
    REQUIRE(rig.bench->edges.size() == expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        CHECK(rig.bench->edges[i].time_ns == expected[i].time_ns);
        CHECK(bits_of(rig.bench->edges[i].levels, 4) == expected[i].levels);
    }
}

TEST_CASE("no step of a scanner takes longer than the shift, the gap and the longest hold") {
    for (const DisplayDescription& display : small_displays()) {
        ScanRig rig(display);
        const auto bytes = random_slice(display, 3);
        REQUIRE(rig.begin(lit_order(bytes), 50'000'000) == Status::Ok);
        CHECK(rig.lines().time_ns() == 0);
        std::uint64_t longest = 0;
        while (!rig.finished()) {
            const std::uint64_t before = rig.lines().time_ns();
            REQUIRE(rig.step() == Status::Ok);
            longest = std::max(longest, rig.lines().time_ns() - before);
        }
        const auto& m = rig.modulation;
        CHECK(longest <= m.shift_ns + m.fall_ns + m.latch_ns + device::Hub75Scan::kLongestHoldNs);
        CHECK(longest > 50'000);
    }
}

TEST_CASE("lines that cannot strobe by themselves give the same light, dark in between") {
    for (const DisplayDescription& display : small_displays()) {
        ScanRig with(display);
        const auto bytes = random_slice(display, 5);
        REQUIRE(with.scan(lit_order(bytes), 4'000'000) == Status::Ok);

        ScanRig rig(display);
        static LinesOperations without;
        without = *rig.lines().lines().operations;
        without.strobe = nullptr;
        without.join = nullptr;
        rig.replace_lines({&without, rig.lines().lines().self});
        REQUIRE(rig.begin(lit_order(bytes), 4'000'000) == Status::Ok);
        std::size_t lit_between = 0;
        while (!rig.finished()) {
            REQUIRE(rig.step() == Status::Ok);
            lit_between += rig.bench->chips().output_on() ? 1u : 0u;
        }
        CHECK(lit_between == 0);
        CHECK((rig.bench->light_ns == with.bench->light_ns));
    }
}

TEST_CASE("scanners refuse what they cannot do") {
    transport::VirtualLines lines({.outputs = ~LineMask{0}});
    std::vector<std::uint64_t> buffer(10'000);
    device::Hub75Scan hub75;
    device::ShiftRegisterScan cube;
    device::MatrixScan matrix;
    CHECK(hub75.begin(lit_order({}), 1000) == Status::InvalidArgument);
    CHECK(hub75.blank() == Status::InvalidArgument);
    CHECK(hub75.step() == Status::Ok);

    DisplayDescription display = small_hub75();
    const auto good = device::hub75_config(display);
    CHECK(hub75.init(good, lines.lines(), std::span(buffer).first(scan_buffer_words(good) - 1)) == Status::OutOfMemory);
    CHECK(hub75.init(good, {}, buffer) == Status::InvalidArgument);
    transport::VirtualLines few({.outputs = 0xff});
    CHECK(hub75.init(good, few.lines(), buffer) == Status::InvalidArgument);
    device::Hub75Pins crossed;
    crossed.data[2][0] = crossed.clock;
    CHECK(hub75.init(device::hub75_config(display, crossed), lines.lines(), buffer) == Status::InvalidArgument);
    crossed = {};
    crossed.latch = 64;
    CHECK(hub75.init(device::hub75_config(display, crossed), lines.lines(), buffer) == Status::InvalidArgument);
    CHECK(hub75.init(good, lines.lines(), buffer) == Status::Ok);
    CHECK(hub75.begin(lit_order(std::span(std::as_bytes(std::span(buffer))).first(slice_bytes(display) - 1)), 1000) ==
          Status::InvalidArgument);
    CHECK(hub75.finished());

    CHECK(cube.init(device::shift_register_config(display), lines.lines(), buffer) == Status::Unsupported);
    CHECK(matrix.init(device::matrix_config(display), lines.lines(), buffer) == Status::Unsupported);
    display.scan.row_groups = 64;
    display.panels[0].rows = display.panels[1].rows = display.panels[2].rows = 128;
    CHECK(hub75.init(device::hub75_config(display), lines.lines(), buffer) == Status::Unsupported);
    DisplayDescription turning = small_cube();
    turning.kind = DisplayKind::RotatingPanel;
    CHECK(cube.init(device::shift_register_config(turning), lines.lines(), buffer) == Status::Unsupported);
    DisplayDescription wide = small_matrix();
    wide.panels[0].columns = 40;
    CHECK(matrix.init(device::matrix_config(wide), lines.lines(), buffer) == Status::Unsupported);
}

TEST_CASE("pins have names") {
    const device::Hub75Pins hub75;
    CHECK(pin_name(hub75, 0).view() == "clock");
    CHECK(pin_name(hub75, 2).view() == "oe");
    CHECK(pin_name(hub75, 7).view() == "e");
    CHECK(pin_name(hub75, 8).view() == "r1");
    CHECK(pin_name(hub75, 13).view() == "b2");
    CHECK(pin_name(hub75, 14).view() == "r1_1");
    CHECK(pin_name(hub75, 63).empty());
    CHECK(pin_name(device::ShiftRegisterPins{}, 3).view() == "data");
    CHECK(pin_name(device::ShiftRegisterPins{}, 10).view() == "data_7");
    CHECK(pin_name(device::MatrixPins{}, 10, 9).view() == "row9");
    CHECK(pin_name(device::MatrixPins{}, 10, 23).view() == "col13");
}
