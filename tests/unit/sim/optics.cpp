#include "sim/optics.h"

#include <cmath>
#include <cstddef>
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

/// Where the only lit pixel of a page shows.
sim::Flash only_flash(const DisplayDescription& display, const Pixel& pixel, const sim::Misbuild& misbuild = {}) {
    std::vector<std::byte> page = dark_page(display);
    set_pixel(display, page, pixel, 1);
    const sim::LightField field = sim::expose(display, page, 255, misbuild);
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
    for (const sim::Flash& flash : sim::expose(display, page, 255).flashes) {
        const auto column = static_cast<std::size_t>(std::lround(flash.place_mm.x / 2.0 + 1.0));
        codes[column] = flash.code;
        CHECK(glm::distance(flash.light, sample.lights[column]) < 1e-6f);
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
    CHECK(field.flashes[0].light.x == Approx(0.2f));
    CHECK(field.flashes[0].code == 0xff);
}

TEST_CASE("swapped planes trade places") {
    const DisplayDescription display = stack_of(2, 2, 4);
    const sim::Misbuild misbuild{.swap_a = 0, .swap_b = 3};
    CHECK(only_flash(display, {.slice = 0}, misbuild).place_mm == only_flash(display, {.slice = 3}).place_mm);
    CHECK(only_flash(display, {.slice = 3}, misbuild).place_mm == only_flash(display, {.slice = 0}).place_mm);
    CHECK(only_flash(display, {.slice = 1}, misbuild).place_mm == only_flash(display, {.slice = 1}).place_mm);
}

TEST_CASE("a mirrored panel's columns run the other way") {
    const DisplayDescription display = rotor_of(6, 2, 5);
    const sim::Misbuild misbuild{.mirrored_panel = 1};
    const Pixel left{.slice = 2, .panel = 1, .row = 1, .column = 1};
    const Pixel right{.slice = 2, .panel = 1, .row = 1, .column = 4};
    const Pixel other{.slice = 2, .panel = 0, .row = 1, .column = 1};
    CHECK(only_flash(display, left, misbuild).place_mm == only_flash(display, right).place_mm);
    CHECK(only_flash(display, other, misbuild).place_mm == only_flash(display, other).place_mm);
}

TEST_CASE("an index mark that is off by a slice turns everything by a slice") {
    const DisplayDescription display = rotor_of(6, 2, 5);
    const sim::Misbuild misbuild{.phase_slices = 1};
    for (std::uint32_t slice = 0; slice < 5; ++slice) {
        const Pixel here{.slice = slice, .panel = 0, .row = 1, .column = 5};
        const Pixel next{.slice = (slice + 1) % 5, .panel = 0, .row = 1, .column = 5};
        const glm::dvec3 place = only_flash(display, here, misbuild).place_mm;
        CHECK(glm::distance(place, only_flash(display, next).place_mm) < 1e-12);
    }
}

}  // namespace
}  // namespace xorvox
