#include "sim/optics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <vector>

#include <glm/geometric.hpp>

#include "tests/catch.h"
#include "tests/unit/sim/displays.h"

namespace xorvox {
namespace {

using namespace test;

void check_place(const glm::dvec3& place, double x, double y, double z) {
    INFO("found " << place.x << ", " << place.y << ", " << place.z);
    CHECK(glm::distance(place, glm::dvec3(x, y, z)) < 1e-12);
}

sim::Faults with(std::string_view fault) {
    return {{sim::parse_fault(fault).value()}};
}

/// Where the only lit pixel of a page shows.
sim::Flash only_flash(const DisplayDescription& display, const Pixel& pixel, const sim::Faults& faults = {}) {
    std::vector<std::byte> page = dark_page(display);
    set_pixel(display, page, pixel, 1);
    const sim::LightField field = sim::expose(display, page, 255, faults);
    REQUIRE(field.flashes.size() == 1);
    return field.flashes[0];
}

TEST_CASE("an empty or dark page gives no light") {
    const DisplayDescription display = stack_of(5, 3, 2);
    CHECK(sim::expose(display, {}, 255).flashes.empty());
    CHECK(sim::expose(display, dark_page(display), 255).flashes.empty());
}

TEST_CASE("a stack's columns run along x, its rows along y, its planes upwards") {
    const DisplayDescription display = stack_of(5, 3, 2);  // 2 mm, 3 mm, 7 mm
    check_place(only_flash(display, {.slice = 0, .row = 0, .column = 0}).place_mm, -4.0, -3.0, -3.5);
    check_place(only_flash(display, {.slice = 0, .row = 0, .column = 4}).place_mm, 4.0, -3.0, -3.5);
    check_place(only_flash(display, {.slice = 0, .row = 2, .column = 1}).place_mm, -2.0, 3.0, -3.5);
    check_place(only_flash(display, {.slice = 1, .row = 1, .column = 2}).place_mm, 0.0, 0.0, 3.5);
    CHECK(only_flash(display, {.slice = 1, .row = 1, .column = 2}).time == 1);
}

TEST_CASE("a rotor's pixels stand where the panel is in the middle of the slice") {
    const DisplayDescription display = rotor_of(4, 3, 4);  // slice 0 is lit around 45 degrees
    const double h = std::sqrt(0.5);
    // Panel 0 in slice 0: u = (h, h), n = (h, -h). Column 3 is 3 mm along u, light is 3 mm along n, row 0 is on top.
    check_place(only_flash(display, {.slice = 0, .panel = 0, .row = 0, .column = 3}).place_mm, 6 * h, 0.0, 4.0);
    check_place(only_flash(display, {.slice = 0, .panel = 0, .row = 2, .column = 0}).place_mm, 0.0, -6 * h, -4.0);
    // Panel 1 is on the back: u and n point the other way.
    check_place(only_flash(display, {.slice = 0, .panel = 1, .row = 1, .column = 3}).place_mm, -6 * h, 0.0, 0.0);
    // Slice 1, a quarter turn later, counter-clockwise seen from above.
    check_place(only_flash(display, {.slice = 1, .panel = 0, .row = 0, .column = 3}).place_mm, 0.0, 6 * h, 4.0);
}

TEST_CASE("a clockwise rotor's phase runs the other way") {
    DisplayDescription display = rotor_of(4, 3, 4);
    display.clockwise = true;
    const double h = std::sqrt(0.5);
    // Slice 0 around -45 degrees: u = (h, -h), n = (-h, -h).
    check_place(only_flash(display, {.slice = 0, .panel = 0, .row = 0, .column = 3}).place_mm, 0.0, -6 * h, 4.0);
    check_place(only_flash(display, {.slice = 1, .panel = 0, .row = 0, .column = 3}).place_mm, -6 * h, 0.0, 4.0);
}

TEST_CASE("a panel's shift, lift and mounting angle move its light") {
    DisplayDescription display = rotor_of(3, 1, 2, PixelFormat::Mono1, 1);  // slice 0 is lit around 90 degrees
    display.panels[0].shift_mm = 10.0;
    display.panels[0].lift_mm = 50.0;
    // u = (0, 1), n = (1, 0).
    check_place(only_flash(display, {.column = 2}).place_mm, 3.0, 12.0, 50.0);
    display.panels[0].angle_deg = -90.0;  // u = (1, 0), n = (0, -1)
    check_place(only_flash(display, {.column = 2}).place_mm, 12.0, -3.0, 50.0);
}

TEST_CASE("a panel that leans, with its odd columns farther out") {
    DisplayDescription display = rotor_of(3, 2, 1, PixelFormat::Mono1, 1);  // lit around 180 degrees
    Panel& panel = display.panels[0];
    panel.tilt_deg = 30.0;
    panel.skew_mm = 0.5;
    panel.lift_mm = 7.0;
    // u = (-1, 0), n = (0, 1). Rows are 2 mm above and below the centre: 1 mm towards who looks, and sqrt(3) mm up.
    const double up = std::sqrt(3.0);
    check_place(only_flash(display, {.row = 0, .column = 0}).place_mm, 2.0, 4.0, 7.0 + up);
    check_place(only_flash(display, {.row = 1, .column = 0}).place_mm, 2.0, 2.0, 7.0 - up);
    check_place(only_flash(display, {.row = 0, .column = 1}).place_mm, 0.0, 4.5, 7.0 + up);
    check_place(only_flash(display, {.row = 1, .column = 2}).place_mm, -2.0, 2.0, 7.0 - up);
}

TEST_CASE("a mounted panel is mirrored first and turned then") {
    DisplayDescription display = rotor_of(5, 2, 1, PixelFormat::Mono1, 1);
    Panel& panel = display.panels[0];
    panel.angle_deg = 180.0;  // and 180 by the phase: columns along +x, who looks stands at -y
    const Pixel pixel{.row = 0, .column = 4};
    struct Case {
        bool mirrored;
        std::uint8_t turned;
        double x;
        double z;
    };
    const Case cases[] = {{false, 0, 4.0, 2.0}, {false, 1, -2.0, 4.0}, {false, 2, -4.0, -2.0}, {false, 3, 2.0, -4.0},
                          {true, 0, -4.0, 2.0}, {true, 1, -2.0, -4.0}, {true, 2, 4.0, -2.0},   {true, 3, 2.0, 4.0}};
    for (const Case& mounted : cases) {
        INFO(mounted.mirrored << " " << int{mounted.turned});
        panel.mirrored = mounted.mirrored;
        panel.turned = mounted.turned;
        check_place(only_flash(display, pixel).place_mm, mounted.x, -3.0, mounted.z);
    }
}

TEST_CASE("the skew of a mirrored panel stays with its odd columns") {
    DisplayDescription display = rotor_of(4, 1, 1, PixelFormat::Mono1, 1);
    display.panels[0].angle_deg = 180.0;
    display.panels[0].mirrored = true;
    display.panels[0].skew_mm = 0.25;
    check_place(only_flash(display, {.column = 0}).place_mm, 3.0, -3.0, 0.0);
    check_place(only_flash(display, {.column = 1}).place_mm, 1.0, -3.25, 0.0);
}

TEST_CASE("the frame of a half turn is lit in half a turn") {
    DisplayDescription display = rotor_of(3, 1, 2, PixelFormat::Mono1, 1);
    display.sweep_deg = 180.0;
    display.panels[0].offset_mm = 0.0;
    const double h = std::sqrt(2.0);
    check_place(only_flash(display, {.slice = 0, .column = 2}).place_mm, h, h, 0.0);
    check_place(only_flash(display, {.slice = 1, .column = 2}).place_mm, -h, h, 0.0);
}

TEST_CASE("the planes of an uneven stack stand at their heights") {
    constexpr double kHeights[] = {-5.0, 1.0, 2.5};
    DisplayDescription display = stack_of(3, 2, 3);
    display.plane_heights_mm = kHeights;
    for (std::uint32_t plane = 0; plane < 3; ++plane) {
        check_place(only_flash(display, {.slice = plane, .column = 2}).place_mm, 2.0, -1.5, kHeights[plane]);
    }
    CHECK(sim::plane_height_mm(display, -0.5) == Approx(-8.0));
    CHECK(sim::plane_height_mm(display, 1.5) == Approx(1.75));
    CHECK(sim::plane_height_mm(display, 2.5) == Approx(3.25));
}

TEST_CASE("a swept plane is as high as its motion says in the middle of each slice") {
    const auto height = [](const DisplayDescription& display, std::uint32_t slice) {
        const sim::Flash flash = only_flash(display, {.slice = slice, .row = 1, .column = 2});
        CHECK(flash.time == slice);
        CHECK(flash.place_mm.x == 2.0);
        CHECK(flash.place_mm.y == 1.5);
        return flash.place_mm.z;
    };
    DisplayDescription constant = swept_of(3, 2, 3, MotionProfile::Constant);  // 60 mm in three slices
    CHECK(height(constant, 0) == Approx(-20.0));
    CHECK(height(constant, 2) == Approx(20.0));
    constant.motion.dead_zone = 0.25;  // 30 mm of them are lit
    CHECK(height(constant, 0) == Approx(-10.0));
    CHECK(height(constant, 1) == Approx(0.0).margin(1e-12));
    constant.motion.both_ways = true;
    CHECK(height(constant, 2) == Approx(10.0));

    const DisplayDescription sine = swept_of(3, 2, 3, MotionProfile::Sine);  // at 30, 90 and 150 degrees
    CHECK(height(sine, 0) == Approx(-15.0 * std::sqrt(3.0)));
    CHECK(height(sine, 1) == Approx(0.0).margin(1e-12));
    CHECK(height(sine, 2) == Approx(15.0 * std::sqrt(3.0)));

    // Heights 0, 0.1, 0.5, 1 at thirds of the sweep; slices at 1/4 and 3/4 of it.
    const DisplayDescription table = swept_of(3, 2, 2, MotionProfile::Table);
    CHECK(height(table, 0) == Approx(60.0 * (0.075 - 0.5)));
    CHECK(height(table, 1) == Approx(60.0 * (0.625 - 0.5)));
}

TEST_CASE("a helix is as high as its screen where the image meets it") {
    // Pixels at x = -2, 0, 2 and y = -3, 0, 3. One blade of 40 mm; in slice 0 of 4 it has turned by an eighth.
    const auto height = [](const DisplayDescription& display, std::uint32_t slice, std::uint32_t row,
                           std::uint32_t column) {
        const glm::dvec3 place = only_flash(display, {.slice = slice, .row = row, .column = column}).place_mm;
        CHECK(place.x == 2.0 * column - 2.0);
        CHECK(place.y == 3.0 * row - 3.0);
        return place.z;
    };
    DisplayDescription display = helix_of(3, 3, 4, 1);
    CHECK(height(display, 0, 2, 1) == Approx(40.0 * (0.25 - 0.125) - 20.0));        // at 90 degrees
    CHECK(height(display, 1, 2, 1) == Approx(40.0 * (0.25 - 0.375 + 1.0) - 20.0));  // the foot has passed
    CHECK(height(display, 3, 0, 1) == Approx(40.0 * (0.75 - 0.875 + 1.0) - 20.0));  // at 270 degrees
    CHECK(height(display, 0, 1, 1) == Approx(40.0 * (0.0 - 0.125 + 1.0) - 20.0));   // on the axis: as along +x
    display.clockwise = true;
    CHECK(height(display, 0, 2, 1) == Approx(40.0 * (0.25 + 0.125) - 20.0));
    CHECK(height(display, 3, 2, 1) == Approx(40.0 * (0.25 + 0.875 - 1.0) - 20.0));
    display = helix_of(3, 3, 4, 2);
    CHECK(height(display, 0, 2, 1) == Approx(40.0 * (0.5 - 0.125) - 20.0));
    CHECK(height(display, 0, 1, 0) == Approx(40.0 * (1.0 - 0.125) - 20.0));  // at 180 degrees: the second one
}

TEST_CASE("where a helix ends exactly over a pixel, light is at its foot") {
    // Two slices: the screen has turned by a quarter in the first. Above the pixels at 90 degrees it ends.
    DisplayDescription display = helix_of(3, 3, 2, 1);
    CHECK(only_flash(display, {.slice = 0, .row = 2, .column = 1}).place_mm.z == Approx(-20.0));
    // And at all eight octants of a square image.
    display = helix_of(9, 9, 12, 3);
    display.panels[0].row_pitch_mm = 2.0;
    display.slices = 4;  // φ of 1/8, 3/8 …; 3·α of 3/8, 9/8 … at the diagonals
    for (std::uint32_t slice = 0; slice < 4; ++slice) {
        for (std::uint32_t i = 0; i < 9; ++i) {
            for (const std::uint32_t column : {i, 8 - i}) {
                const double z = only_flash(display, {.slice = slice, .row = i, .column = column}).place_mm.z;
                CHECK(z < 20.0 - 1e-6);
                CHECK(z > -20.0 - 1e-6);
            }
        }
    }
}

TEST_CASE("free points are lit where they are, row after row") {
    const DisplayDescription display = points_of();
    for (std::uint32_t row = 0; row < 2; ++row) {
        for (std::uint32_t column = 0; column < 5; ++column) {
            const PointMm& point = kPoints[5 * row + column];
            check_place(only_flash(display, {.row = row, .column = column}).place_mm, point.x, point.y, point.z);
        }
    }
}

TEST_CASE("pixels are read from their bits in every format") {
    struct Case {
        PixelFormat format;
        std::vector<unsigned> row;  ///< Three pixels.
        std::vector<std::uint32_t> codes;
        std::vector<glm::vec3> lights;
    };
    const auto [name, sample] = GENERATE(table<const char*, Case>({
        {"mono1", {PixelFormat::Mono1, {0b110}, {0, 1, 1}, {{0, 0, 0}, {1, 1, 1}, {1, 1, 1}}}},
        // Pixel 0 blue, 1 red and green, 2 red and blue; the last one in bits 6, 7 and 8.
        {"rgb111", {PixelFormat::Rgb111, {0b01'011'100, 0b1}, {4, 3, 5}, {{0, 0, 1}, {1, 1, 0}, {1, 0, 1}}}},
        {"mono2", {PixelFormat::Mono2, {0b11'00'10}, {2, 0, 3}, {glm::vec3(2.0f / 3), {0, 0, 0}, {1, 1, 1}}}},
        {"mono4",
         {PixelFormat::Mono4, {0xf1, 0x05}, {1, 15, 5}, {glm::vec3(1.0f / 15), {1, 1, 1}, glm::vec3(1.0f / 3)}}},
        // 15 bits a pixel: red, green, and one of blue with all of red.
        {"rgb555",
         {PixelFormat::Rgb555,
          {0x00, 0x7c, 0xf0, 0x41, 0x00, 0x1f},
          {0x7c00, 0x03e0, 0x7c01},
          {{1, 0, 0}, {0, 1, 0}, {1, 0, 1.0 / 31}}}},
        {"rgb332",
         {PixelFormat::Rgb332,
          {0b111'000'00, 0b000'011'00, 0b001'000'10},
          {0xe0, 0x0c, 0x22},
          {{1, 0, 0}, {0, 3.0 / 7, 0}, {1.0 / 7, 0, 2.0 / 3}}}},
        {"rgb565",
         {PixelFormat::Rgb565,
          {0x00, 0xf8, 0xe0, 0x07, 0x01, 0x08},
          {0xf800, 0x07e0, 0x0801},
          {{1, 0, 0}, {0, 1, 0}, {1.0 / 31, 0, 1.0 / 31}}}},
        {"rgb888",
         {PixelFormat::Rgb888,
          {0xff, 0x00, 0x33, 0x00, 0x66, 0x00, 0x00, 0x00, 0x01},
          {0x3300ff, 0x006600, 0x010000},
          {{1, 0, 0.2}, {0, 0.4, 0}, {0, 0, 1.0 / 255}}}},
    }));
    INFO(name);
    DisplayDescription display = stack_of(3, 1, 1, sample.format);
    std::vector<std::byte> page;
    for (const unsigned byte : sample.row) page.push_back(static_cast<std::byte>(byte));
    REQUIRE(page.size() == frame_bytes(display));

    std::vector<std::uint32_t> codes(3);
    const sim::LightField field = sim::expose(display, page, 255);
    CHECK(field.flashes.size() ==
          static_cast<std::size_t>(std::ranges::count_if(sample.codes, [](auto code) { return code != 0; })));
    for (const sim::Flash& flash : field.flashes) {
        const auto column = static_cast<std::size_t>(std::lround(flash.place_mm.x / 2.0 + 1.0));
        codes[column] = flash.code;
        CHECK(glm::distance(field.light(flash), sample.lights[column]) < 1e-6f);
    }
    CHECK(codes == sample.codes);
}

TEST_CASE("rows begin at a byte, panels and slices follow each other") {
    // Two panels of 9 columns and 2 rows: rows of 2 bytes, slices of 8.
    const DisplayDescription display = rotor_of(9, 2, 3);
    std::vector<std::byte> page(24);
    page[8 + 4 + 2 + 1] = std::byte{1};  // slice 1, panel 1, row 1, column 8
    const sim::LightField field = sim::expose(display, page, 255);
    REQUIRE(field.flashes.size() == 1);
    const glm::dvec3 expected = only_flash(display, {.slice = 1, .panel = 1, .row = 1, .column = 8}).place_mm;
    CHECK(field.flashes[0].place_mm == expected);
    // Slice 1 of 3 is around 180 degrees; panel 1 adds 180: u = (1, 0), n = (0, -1).
    check_place(expected, 8.0, -3.0, -2.0);
}

TEST_CASE("brightness dims light, not codes") {
    const DisplayDescription display = stack_of(1, 1, 1, PixelFormat::Rgb888);
    std::vector<std::byte> page = dark_page(display);
    set_pixel(display, page, {}, 0x0000ff);
    const sim::LightField field = sim::expose(display, page, 51);
    REQUIRE(field.flashes.size() == 1);
    CHECK(field.light(field.flashes[0]).x == Approx(0.2f));
    CHECK(field.flashes[0].code == 0xff);
}

TEST_CASE("light follows the response of the display") {
    const auto light_of = [](Light light, std::uint32_t code) {
        DisplayDescription display = stack_of(1, 1, 1, PixelFormat::Rgb888);
        display.light = light;
        std::vector<std::byte> page = dark_page(display);
        set_pixel(display, page, {}, code | 0xff00);
        const sim::LightField field = sim::expose(display, page, 255);
        CHECK(field.light(field.flashes.at(0)).y == 1.0f);
        CHECK(field.light(field.flashes.at(0)).z == 0.0f);
        return static_cast<double>(field.light(field.flashes.at(0)).x);
    };
    CHECK(light_of({}, 51) == Approx(0.2));
    CHECK(light_of({Response::Gamma, 2.0}, 51) == Approx(0.04));
    CHECK(light_of({Response::Gamma, 2.2}, 128) == Approx(0.219520));
    CHECK(light_of({Response::Srgb}, 128) == Approx(0.215861).epsilon(1e-5));
    CHECK(light_of({Response::Srgb}, 5) == Approx(5.0 / 255 / 12.92));
    // A lightness of 60 and of 4.
    CHECK(light_of({Response::Cie1931}, 153) == Approx(0.281233).epsilon(1e-5));
    CHECK(light_of({Response::Cie1931}, 10) == Approx(1000.0 / 255 / 903.2963).epsilon(1e-5));
}

TEST_CASE("bits that are not shown give no light") {
    DisplayDescription display = stack_of(4, 1, 1, PixelFormat::Rgb332);
    display.scan.bit_planes = 2;
    std::vector<std::byte> page = dark_page(display);
    set_pixel(display, page, {.column = 0}, 0b001'001'00);  // Only bits that are hidden: blue has two in all.
    set_pixel(display, page, {.column = 1}, 0b011'101'01);
    set_pixel(display, page, {.column = 3}, 0b111'000'00);
    CHECK(sim::count_lit(display, page) == 2);
    const sim::LightField field = sim::expose(display, page, 255);
    REQUIRE(field.flashes.size() == 2);
    CHECK(field.flashes[0].code == 0b011'101'01);
    CHECK(glm::distance(field.light(field.flashes[0]), glm::vec3(1.0f / 3, 2.0f / 3, 1.0f / 3)) < 1e-6f);
    CHECK(field.light(field.flashes[1]) == glm::vec3(1, 0, 0));
    // The response is that of what is shown.
    display.light = {Response::Gamma, 2.0};
    const sim::LightField curved = sim::expose(display, page, 255);
    CHECK(glm::distance(curved.light(curved.flashes[0]), glm::vec3(1.0f / 9, 4.0f / 9, 1.0f / 9)) < 1e-6f);
}

TEST_CASE("of a large dark page every lit pixel is found, and none beyond the row") {
    // Rows of 77 pixels end within a byte; the bits behind them are not pixels.
    const auto format = GENERATE(from_range(kPixelFormats));
    INFO(to_string(format));
    const DisplayDescription display = stack_of(77, 3, 2, format);
    const std::uint32_t bits = bits_per_pixel(format);
    for (std::uint32_t column = 0; column < 77; ++column) {
        for (const std::uint32_t code : {1u, 1u << (bits - 1), (1u << bits) - 1}) {
            std::vector<std::byte> page = dark_page(display);
            const std::size_t row = row_bytes(display.panels[0], format);
            if (77 * bits % 8 != 0) page[5 * row - 1] |= std::byte{0x80};
            set_pixel(display, page, {.slice = 1, .row = 1, .column = column}, code);
            const sim::LightField field = sim::expose(display, page, 255);
            REQUIRE(field.flashes.size() == 1);
            REQUIRE(field.flashes[0].code == code);
            REQUIRE(field.flashes[0].place_mm.x == 2.0 * column - 76.0);
        }
    }
}

TEST_CASE("swapped planes trade places") {
    const DisplayDescription display = stack_of(2, 2, 4);
    const sim::Faults faults = with("swapped-slices:slice=0,other=3");
    CHECK(only_flash(display, {.slice = 0}, faults).place_mm == only_flash(display, {.slice = 3}).place_mm);
    CHECK(only_flash(display, {.slice = 3}, faults).place_mm == only_flash(display, {.slice = 0}).place_mm);
    CHECK(only_flash(display, {.slice = 1}, faults).place_mm == only_flash(display, {.slice = 1}).place_mm);
}

TEST_CASE("a mirrored panel's columns run the other way") {
    const DisplayDescription display = rotor_of(6, 2, 5);
    const sim::Faults faults = with("mirrored:panel=1");
    const Pixel left{.slice = 2, .panel = 1, .row = 1, .column = 1};
    const Pixel right{.slice = 2, .panel = 1, .row = 1, .column = 4};
    const Pixel other{.slice = 2, .panel = 0, .row = 1, .column = 1};
    CHECK(only_flash(display, left, faults).place_mm == only_flash(display, right).place_mm);
    CHECK(only_flash(display, other, faults).place_mm == only_flash(display, other).place_mm);
}

TEST_CASE("points of a string can be swapped, and counted from the wrong one") {
    const DisplayDescription display = points_of();
    const auto place = [&](std::uint32_t point, const sim::Faults& faults = {}) {
        return only_flash(display, {.row = point / 5, .column = point % 5}, faults).place_mm;
    };
    CHECK(place(2, with("swapped-slices:slice=2,other=8")) == place(8));
    CHECK(place(8, with("swapped-slices:slice=2,other=8")) == place(2));
    CHECK(place(0, with("phase:slices=-1")) == place(9));
    CHECK(place(4, with("phase:slices=1")) == place(5));
    CHECK(place(6, with("mirrored:panel=0")) == place(8));
}

TEST_CASE("a swept plane that is late is one slice higher, and at the top on its way down") {
    const auto profile = GENERATE(MotionProfile::Constant, MotionProfile::Sine, MotionProfile::Table);
    const DisplayDescription display = swept_of(2, 2, 6, profile);
    for (std::uint32_t slice = 0; slice < 6; ++slice) {
        const double late = only_flash(display, {.slice = slice}, with("phase:slices=1")).place_mm.z;
        const double next = only_flash(display, {.slice = std::min(slice + 1, 5u)}).place_mm.z;
        CHECK(late == Approx(next).margin(1e-9));
    }
}

TEST_CASE("a helix whose index is off by a slice is a slice of height too low") {
    const DisplayDescription display = helix_of(4, 3, 5, 2);
    for (std::uint32_t slice = 0; slice < 5; ++slice) {
        const double late = only_flash(display, {.slice = slice}, with("phase:slices=1")).place_mm.z;
        CHECK(late == Approx(only_flash(display, {.slice = (slice + 1) % 5}).place_mm.z).margin(1e-9));
    }
}

TEST_CASE("an index mark that is off by a slice turns everything by a slice") {
    const DisplayDescription display = rotor_of(6, 2, 5);
    const sim::Faults faults = with("phase:slices=1");
    for (std::uint32_t slice = 0; slice < 5; ++slice) {
        const Pixel here{.slice = slice, .panel = 0, .row = 1, .column = 5};
        const Pixel next{.slice = (slice + 1) % 5, .panel = 0, .row = 1, .column = 5};
        const glm::dvec3 place = only_flash(display, here, faults).place_mm;
        CHECK(glm::distance(place, only_flash(display, next).place_mm) < 1e-12);
    }
}

}  // namespace
}  // namespace xorvox
