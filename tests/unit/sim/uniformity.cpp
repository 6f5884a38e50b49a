#include "sim/uniformity.h"

#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include <glm/common.hpp>

#include "driver/display/lattice.h"
#include "tests/catch.h"
#include "tests/unit/sim/displays.h"

namespace xorvox {
namespace {

using namespace test;

using CodeOf = std::function<std::uint32_t(const Pixel&)>;

std::vector<std::byte> page_of(const DisplayDescription& display, const CodeOf& code) {
    std::vector<std::byte> page = dark_page(display);
    for (std::uint32_t slice = 0; slice < display.slices; ++slice) {
        for (std::uint32_t p = 0; p < display.panel_count; ++p) {
            for (std::uint32_t row = 0; row < display.panels[p].rows; ++row) {
                for (std::uint32_t column = 0; column < display.panels[p].columns; ++column) {
                    const Pixel pixel{slice, p, row, column};
                    set_pixel(display, page, pixel, code(pixel));
                }
            }
        }
    }
    return page;
}

sim::Uniformity uniformity(const DisplayDescription& display, const CodeOf& code) {
    sim::UniformityMeter meter(display);
    meter.add(page_of(display, code));
    return meter.result();
}

std::uint32_t white(const Pixel&) {
    return 0xffffff;
}

/// A rotor of one panel through the axis, with 8-bit levels: 64 × 32 pixels of 2 mm, 512 slices.
DisplayDescription thin_rotor() {
    DisplayDescription display = rotor_of(64, 32, 512, PixelFormat::Rgb888, 1);
    display.panels[0].offset_mm = 0.0;
    display.panels[0].row_pitch_mm = 2.0;
    return display;
}

/// Grey of a level.
std::uint32_t grey(double level) {
    return static_cast<std::uint32_t>(std::lround(255.0 * level)) * 0x010101;
}

/// The level that makes a rotor even: in proportion to the place along a panel of 64 columns.
std::uint32_t even(const Pixel& pixel) {
    return grey(std::abs(2.0 * pixel.column - 63.0) / 63.0);
}

}  // namespace

TEST_CASE("a stack of even planes that is all white is even") {
    const sim::Uniformity found = uniformity(stack_of(16, 16, 16, PixelFormat::Rgb888), white);
    CHECK(found.ratio() == Approx(1.0));
    CHECK(found.cells_a_side == 4);  // 64 samples each.
    CHECK(found.cells == 64);
    CHECK(found.mean == Approx(1.0 / (2.0 * 3.0 * 7.0)));
    CHECK(found.most == Approx(found.mean));
}

TEST_CASE("cells are as small as 48 samples each allow, at most 16 a side") {
    CHECK(sim::UniformityMeter(stack_of(3, 3, 3)).result().cells_a_side == 1);
    CHECK(sim::UniformityMeter(stack_of(3, 3, 3)).result().cells == 0);
    CHECK(sim::UniformityMeter(stack_of(8, 8, 8)).result().cells_a_side == 2);
    CHECK(sim::UniformityMeter(stack_of(80, 80, 80)).result().cells_a_side == 16);
    CHECK(sim::UniformityMeter(stack_of(80, 80, 80)).result().cells == 4096);
}

TEST_CASE("of a small rotor the middle is told from the rim") {
    DisplayDescription display = rotor_of(8, 10, 24, PixelFormat::Mono1, 1);
    display.panels[0].offset_mm = 1.0;
    const sim::Uniformity found = uniformity(display, white);
    CHECK(found.cells_a_side == 3);
    CHECK(found.ratio() > 2.0);
}

TEST_CASE("a darker half is found, where it is") {
    const DisplayDescription display = stack_of(16, 16, 16, PixelFormat::Rgb888);
    const auto half = [](const Pixel& pixel) { return pixel.slice < 8 ? 0x333333u : 0xffffffu; };
    const sim::Uniformity found = uniformity(display, half);
    CHECK(found.ratio() == Approx(5.0));
    CHECK(found.mean == Approx(0.6 / 42.0));
    CHECK(found.most_mm.z == Approx(14.0));  // Cells are 8 mm, 12 mm and 28 mm large, about the origin.
    CHECK(found.least_mm.z == Approx(-42.0));
    CHECK(uniformity(display, [](const Pixel& pixel) { return pixel.column < 4 ? 0u : 0xffffffu; }).ratio() ==
          std::numeric_limits<double>::infinity());
    CHECK(uniformity(display, [](const Pixel&) { return 0u; }).ratio() == 1.0);
}

TEST_CASE("luminance counts, by the response of the display and the bits that are shown") {
    DisplayDescription display = stack_of(8, 8, 8, PixelFormat::Rgb332);
    const auto mean = [&](std::uint32_t code) {
        return uniformity(display, [&](const Pixel&) { return code; }).mean * 42.0;
    };
    CHECK(mean(0b111'000'00) == Approx(0.2126));
    CHECK(mean(0b000'111'00) == Approx(0.7152));
    CHECK(mean(0b000'000'11) == Approx(0.0722));
    CHECK(mean(0b000'001'00) == Approx(0.7152 / 7));
    display.scan.bit_planes = 2;
    CHECK(mean(0b000'011'00) == Approx(0.7152 / 3));
    CHECK(mean(0b000'001'00) == 0.0);
    display.light = {Response::Gamma, 2.0};
    CHECK(mean(0b000'011'00) == Approx(0.7152 / 9));
}

TEST_CASE("a white rotor is brighter near its axis, by as much as its LEDs are slower there") {
    const sim::Uniformity found = uniformity(thin_rotor(), white);
    CHECK(found.cells_a_side == 16);
    // Light falls off as 1 ÷ r. Its mean over the square of 8 mm at the axis is 2·ln(1 + √2) ÷ 8 mm, of a rim cell
    // about 1 ÷ r.
    const double middle = 2.0 * std::log(1.0 + std::numbers::sqrt2) / 8.0;
    CHECK(std::hypot(found.most_mm.x, found.most_mm.y) == Approx(std::hypot(4.0, 4.0)));
    CHECK(std::hypot(found.least_mm.x, found.least_mm.y) > 56.0);
    CHECK(found.ratio() == Approx(middle * 62.0).epsilon(0.05));
}

TEST_CASE("a rotor whose light grows with the distance from the axis is even") {
    CHECK(uniformity(thin_rotor(), even).ratio() < 1.02);
    // Two panels back to back, at a distance from the axis.
    DisplayDescription display = thin_rotor();
    display.panel_count = 2;
    display.panels[0].offset_mm = 5.0;
    display.panels[1] = display.panels[0];
    display.panels[1].angle_deg = 180.0;
    CHECK(uniformity(display, even).ratio() < 1.03);
    // Half a turn a frame.
    display = thin_rotor();
    display.sweep_deg = 180.0;
    CHECK(uniformity(display, even).ratio() < 1.02);
    CHECK(uniformity(display, even).mean == Approx(uniformity(thin_rotor(), even).mean).epsilon(0.01));
}

TEST_CASE("space that two panels sweep is twice as bright as space that one sweeps") {
    DisplayDescription display = thin_rotor();
    display.panel_count = 2;
    display.panels[1] = display.panels[0];
    display.panels[1].angle_deg = 90.0;
    CHECK(uniformity(display, even).ratio() < 1.02);
    display.panels[1].columns = 32;  // As bright at each place, but half as wide.
    const auto code = [](const Pixel& pixel) {
        return even({pixel.slice, 0, pixel.row, pixel.panel == 1 ? pixel.column + 16 : pixel.column});
    };
    CHECK(uniformity(display, code).ratio() == Approx(2.0).epsilon(0.03));
    // Twice as high instead: its lower half is above the first panel.
    display.panels[1] = display.panels[0];
    display.panels[1].angle_deg = 90.0;
    display.panels[1].lift_mm = 32.0;
    CHECK(uniformity(display, even).ratio() == Approx(2.0).epsilon(0.03));
}

TEST_CASE("a plane that swings is brighter at its ends, where it dwells") {
    const sim::Uniformity steady =
        uniformity(swept_of(16, 16, 256, MotionProfile::Constant, PixelFormat::Rgb888), white);
    CHECK(steady.ratio() == Approx(1.0));
    CHECK(steady.cells_a_side == 10);
    const sim::Uniformity found = uniformity(swept_of(64, 64, 640, MotionProfile::Sine, PixelFormat::Mono1), white);
    REQUIRE(found.cells_a_side == 16);
    // The time of a sweep that the plane spends in the last and in a middle sixteenth of its stroke.
    const auto when = [](double height) { return std::acos(1.0 - 2.0 * height) / std::numbers::pi; };
    CHECK(found.ratio() == Approx(when(1.0 / 16) / (when(0.5) - when(7.0 / 16))).epsilon(0.03));
    CHECK(std::abs(found.most_mm.z) == Approx(60.0 * 7.5 / 16));
}

TEST_CASE("a helix and evenly spread points are even, and points count by number") {
    CHECK(uniformity(helix_of(32, 32, 32, 2), white).ratio() == Approx(1.0).epsilon(0.02));
    std::vector<PointMm> points;
    for (int z = 0; z < 8; ++z) {
        for (int y = 0; y < 8; ++y) {
            for (int x = 0; x < 8; ++x) points.push_back({1.0 * x, 1.0 * y, 1.0 * z});
        }
    }
    DisplayDescription display = points_of();
    display.panels[0].columns = 64;
    display.panels[0].rows = 8;
    display.points = points;
    const sim::Uniformity found = uniformity(display, white);
    CHECK(found.cells == 8);
    CHECK(found.ratio() == 1.0);
    CHECK(found.mean == 1.0);
}

TEST_CASE("what frames light in turn is even together") {
    const DisplayDescription display = stack_of(16, 16, 16);
    sim::UniformityMeter meter(display);
    meter.add(page_of(display, [](const Pixel& pixel) { return pixel.row < 8 ? 1u : 0u; }));
    CHECK(meter.result().ratio() == std::numeric_limits<double>::infinity());
    meter.add(page_of(display, [](const Pixel& pixel) { return pixel.row < 8 ? 0u : 1u; }));
    CHECK(meter.result().ratio() == 1.0);
    CHECK(meter.result().mean == Approx(0.5 / 42.0));
}

TEST_CASE("every pixel's light is in the cell that it is in by its place") {
    std::vector<DisplayDescription> displays{
        stack_of(16, 20, 24), swept_of(16, 20, 24, MotionProfile::Table),  helix_of(20, 20, 20, 3),
        rotor_of(24, 20, 36), rotor_of(24, 20, 36, PixelFormat::Rgb111),   rotor_of(24, 20, 36),
        rotor_of(24, 20, 36), rotor_of(24, 20, 36, PixelFormat::Mono1, 1), stack_of(16, 20, 24),
    };
    displays[4].panels[1].turned = 1;
    displays[4].panels[1].mirrored = true;
    displays[5].panels[0].tilt_deg = 20.0;
    displays[6].panels[0].skew_mm = 1.0;
    displays[6].panels[0].turned = 3;
    displays[7].clockwise = true;
    constexpr double kHeights[] = {0,  1,  2,  4,  5,  7,  8,  9,  10, 12, 13, 15,
                                   16, 17, 18, 20, 21, 22, 23, 24, 25, 26, 27, 40};
    displays[8].plane_heights_mm = kHeights;
    displays[8].plane_pitch_mm = 1.0;
    std::mt19937 random(5);
    for (const DisplayDescription& display : displays) {
        const sim::UniformityMeter fresh(display);
        const auto side = static_cast<double>(fresh.result().cells_a_side);
        REQUIRE(side > 1.0);
        const DisplayExtent box = extent(display);
        const glm::dvec3 half = (box.upper - box.lower) / side / 2.0;
        std::size_t in_cells = 0;
        for (int i = 0; i < 60; ++i) {
            Pixel pixel{static_cast<std::uint32_t>(random() % display.slices),
                        static_cast<std::uint32_t>(random() % display.panel_count), 0, 0};
            pixel.row = static_cast<std::uint32_t>(random() % display.panels[pixel.panel].rows);
            pixel.column = static_cast<std::uint32_t>(random() % display.panels[pixel.panel].columns);
            std::vector<std::byte> page = dark_page(display);
            set_pixel(display, page, pixel, 1);
            sim::UniformityMeter meter = fresh;
            meter.add(page);
            const sim::Uniformity found = meter.result();
            if (found.most == 0.0) continue;  // In a cell of few samples.
            ++in_cells;
            const glm::dvec3 place = sim::expose(display, page, 255).flashes.at(0).place_mm;
            CHECK(glm::all(glm::lessThanEqual(glm::abs(place - found.most_mm), half * (1.0 + 1e-9))));
        }
        CHECK(in_cells > 40);
    }
}

}  // namespace xorvox
