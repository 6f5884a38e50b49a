#include "sim/exposure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <tuple>
#include <vector>

#include <glm/geometric.hpp>

#include "driver/display/timing.h"
#include "driver/display/toml.h"
#include "sim/light_times.h"
#include "sim/pixel_rows.h"
#include "sim/scan_out.h"
#include "sim/seats.h"
#include "tests/catch.h"
#include "tests/unit/sim/displays.h"
#include "tests/unit/sim/perfect.h"

namespace xorvox {
namespace {

using namespace test;

/// Slice, panel, row, column on the wire.
using PixelKey = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;
using Lights = std::map<PixelKey, glm::vec3>;

std::uint32_t wired(const sim::ExposedRow& row, std::size_t column) {
    return static_cast<std::uint32_t>(row.mirrored ? row.light.size() - 1 - column : column);
}

Lights lights_of(const sim::Exposure& exposure) {
    Lights lights;
    exposure.for_each_row([&](const sim::ExposedRow& row) {
        for (std::size_t column = 0; column < row.light.size(); ++column) {
            if (row.light[column] == glm::vec3(0.0f)) continue;
            lights[{row.slice, row.panel, row.row, wired(row, column)}] += row.light[column];
        }
    });
    return lights;
}

/// The same without places.
Lights lights_anywhere(const sim::Exposure& exposure) {
    Lights lights;
    const DisplayDescription& display = exposure.display();
    for (std::uint32_t slice = 0; slice < display.slices; ++slice) {
        for (std::uint32_t p = 0; p < display.panel_count; ++p) {
            for (std::uint32_t row = 0; row < display.panels[p].rows; ++row) {
                std::vector<glm::vec3> light(display.panels[p].columns, glm::vec3(0.0f));
                if (!exposure.add_row_light(slice, p, row, light)) continue;
                for (std::uint32_t column = 0; column < light.size(); ++column) {
                    if (light[column] != glm::vec3(0.0f)) lights[{slice, p, row, column}] = light[column];
                }
            }
        }
    }
    return lights;
}

/// The steady light of a page.
Lights steady_lights(const DisplayDescription& display, std::span<const std::byte> page) {
    Lights lights;
    const sim::PixelLight pixels(display);
    sim::for_each_row(display, page, [&](std::uint32_t slice, std::uint32_t p, std::uint32_t row, auto bytes) {
        sim::for_each_lit(bytes, display.panels[p].columns, bits_per_pixel(display.format), pixels.shown_bits(),
                          [&](std::uint32_t column, std::uint32_t code) {
                              lights[{slice, p, row, column}] = pixels.of(code);
                          });
    });
    return lights;
}

std::vector<std::byte> random_page(const DisplayDescription& display) {
    std::vector<std::byte> page = dark_page(display);
    std::mt19937 random(7);
    for (std::byte& byte : page) byte = static_cast<std::byte>(random() & random());
    return page;
}

std::vector<std::byte> white_page(const DisplayDescription& display) {
    return std::vector<std::byte>(frame_bytes(display), std::byte{0xff});
}

/// A shutter that is open for `cycles` of them after the first one.
sim::Exposure exposed(const DisplayDescription& display, std::span<const std::byte> page, std::uint32_t cycles = 1,
                      sim::Exposure::CyclesAt cycles_at = {}, std::uint8_t brightness = 255) {
    const TimeAt time_at = perfect_time(display);
    sim::Exposure exposure(display, display, std::move(cycles_at), time_at(device::kCycle),
                           time_at((1 + cycles) * device::kCycle));
    const auto scan = sim::make_strobe_scan(display, [&](const sim::Strobe& strobe) { exposure.add(strobe); });
    scan_page(display, page, cycles + 2, *scan, time_at, brightness);
    return exposure;
}

/// The greatest difference, of the light of full codes.
double greatest_difference(const Lights& a, const Lights& b) {
    if (a.size() != b.size()) return INFINITY;
    float most = 0.0f;
    for (const auto& [pixel, light] : a) {
        const auto other = b.find(pixel);
        if (other == b.end()) return INFINITY;
        const glm::vec3 away = glm::abs(other->second - light);
        most = std::max({most, away.x, away.y, away.z});
    }
    return static_cast<double>(most);
}

/// With fewer pixels and slices where it has many.
DisplayFile small_preset(const Preset& preset) {
    DisplayFile display = load_display(std::string(preset.name)).value();
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        Panel& panel = display.panels[p];
        panel.columns = std::min<std::uint16_t>(panel.columns, 37);
        panel.rows = std::min<std::uint16_t>(panel.rows, 64);
    }
    display.slices = std::min(display.slices, 48u);
    return display;
}

DisplayDescription hub75_rotor() {
    DisplayDescription display = rotor_of(12, 4, 16, PixelFormat::Rgb888);
    display.scan.driver = DriverChip::Hub75;
    display.scan.pixel_clock_hz = 10'000'000;
    display.scan.latch_ns = 100;
    display.scan.min_on_ns = 500;
    display.scan.rise_ns = 200;
    display.scan.fall_ns = 100;
    display.scan.row_groups = 2;
    display.panels[1].connector = 1;
    return display;
}

TEST_CASE("one cycle of a perfect rotor is the steady light of its page, for every preset") {
    for (const Preset& preset : presets()) {
        CAPTURE(preset.name);
        const DisplayFile display = small_preset(preset);
        const std::vector<std::byte> page = random_page(display);
        // Strobes begin and end at whole nanoseconds.
        const double rounding = 2.0 / (sim::full_light_ns(display) / (display.motion.both_ways ? 2.0 : 1.0));
        const bool by_levels = !lit_by_planes(display);
        CHECK(greatest_difference(lights_of(exposed(display, page)), steady_lights(display, page)) <=
              1e-6 + (by_levels ? rounding : 0.0));
    }
}

TEST_CASE("responses that are not linear, both ways of a sweep, and half turns give the light of the page") {
    DisplayDescription gamma = hub75_rotor();
    gamma.light = {.response = Response::Gamma, .gamma = 2.2};
    DisplayDescription half_turns = hub75_rotor();
    half_turns.panel_count = 1;
    half_turns.panels[0].offset_mm = 0.0;
    half_turns.sweep_deg = 180.0;
    DisplayDescription half_turns_of_levels = half_turns;
    half_turns_of_levels.scan = {.driver = DriverChip::Dlp};
    DisplayDescription sweep = swept_of(5, 4, 9, MotionProfile::Sine, PixelFormat::Rgb565);
    sweep.motion.dead_zone = 0.1;
    sweep.motion.both_ways = true;
    for (const DisplayDescription& display :
         {gamma, half_turns, half_turns_of_levels, sweep, helix_of(6, 4, 10, 2, PixelFormat::Mono4), points_of()}) {
        CAPTURE(display.name.view(), display.sweep_deg);
        const std::vector<std::byte> page = random_page(display);
        CHECK(greatest_difference(lights_of(exposed(display, page)), steady_lights(display, page)) < 1e-5);
        const sim::Exposure two = exposed(display, page, 2);
        CHECK(greatest_difference(lights_of(two), steady_lights(display, page)) < 1e-5);
        CHECK(greatest_difference(lights_anywhere(two), lights_of(two)) < 1e-6);
    }
}

TEST_CASE("the light of a plane is half of that of the plane before, rise and fall made up for") {
    const DisplayDescription display = hub75_rotor();
    for (std::uint32_t bit = 0; bit < 8; ++bit) {
        CAPTURE(bit);
        std::vector<std::byte> page = dark_page(display);
        set_pixel(display, page, {.slice = 3, .panel = 1, .row = 2, .column = 5}, 1u << (8 + bit));
        const Lights lights = lights_of(exposed(display, page));
        REQUIRE(lights.size() == 1);
        CHECK(lights.at({3, 1, 2, 5}).y == Approx((1u << bit) / 255.0).epsilon(1e-6));
        CHECK(lights.at({3, 1, 2, 5}).x == 0.0f);
    }
}

TEST_CASE("a channel of fewer planes repeats them: its steady light is that of the planes that are lit") {
    for (const PixelFormat format : {PixelFormat::Rgb332, PixelFormat::Rgb565}) {
        for (const unsigned bit_planes : {0u, 3u, 2u, 1u}) {
            DisplayDescription display = hub75_rotor();
            display.format = format;
            display.scan.bit_planes = static_cast<std::uint8_t>(bit_planes);
            CAPTURE(to_string(format), bit_planes);
            const std::vector<std::byte> page = random_page(display);
            CHECK(greatest_difference(lights_of(exposed(display, page)), steady_lights(display, page)) < 1e-6);
        }
    }
    DisplayDescription display = hub75_rotor();
    display.format = PixelFormat::Rgb332;
    CHECK(sim::PixelLight(display).of(2).z == Approx(5.0 / 7.0));
    CHECK(sim::PixelLight(display).of(1).z == Approx(2.0 / 7.0));
    CHECK(sim::PixelLight(display).of(3).z == 1.0f);
    display.scan.bit_planes = 2;
    CHECK(sim::PixelLight(display).of(2).z == Approx(2.0 / 3.0));
    display.scan = {};
    CHECK(sim::PixelLight(display).of(2).z == Approx(2.0 / 3.0));
}

TEST_CASE("an LED that is switched off before it has risen gives the light of its triangle") {
    Scan scan;
    scan.rise_ns = 100;
    scan.fall_ns = 50;
    CHECK(sim::emitted_ns(scan, 1000) == 1000.0 - 50.0 + 25.0);
    CHECK(sim::emitted_ns(scan, 100) == 50.0 + 25.0);
    CHECK(sim::emitted_ns(scan, 50) == 0.5 * 0.5 * 50.0 + 0.5 * 0.5 * 0.5 * 50.0);
}

TEST_CASE("two turns give the light of one, and a dimmed display that of its brightness") {
    const DisplayDescription display = hub75_rotor();
    const std::vector<std::byte> page = random_page(display);
    const Lights one = lights_of(exposed(display, page));
    CHECK(greatest_difference(lights_of(exposed(display, page, 2)), one) < 1e-6);
    Lights dimmed = one;
    for (auto& [pixel, light] : dimmed) light *= 128.0f / 255.0f;
    CHECK(greatest_difference(lights_of(exposed(display, page, 1, {}, 128)), dimmed) < 1e-3);
}

TEST_CASE("a cube of strings keeps its light from frame to frame") {
    DisplayDescription display = stack_of(4, 3, 2, PixelFormat::Rgb888);
    display.scan.driver = DriverChip::Ws2812;
    display.scan.pixel_clock_hz = 800'000;
    display.scan.latch_ns = 300'000;
    const std::vector<std::byte> page = white_page(display);
    for (const auto& [pixel, light] : lights_of(exposed(display, page, 3))) CHECK(light.x == Approx(1.0).epsilon(1e-7));
}

TEST_CASE("light is where the display is in the middle of the strobe") {
    DisplayDescription display = rotor_of(4, 2, 8);
    std::vector<std::byte> page = dark_page(display);
    set_pixel(display, page, {.slice = 2, .panel = 1, .row = 1, .column = 3}, 1);
    const double ahead = 0.3;  // Slices.
    const auto cycles_at = [&](std::uint64_t time_ns) {
        return static_cast<double>(time_ns) * 1e-9 * display.cycles_per_second + ahead / display.slices;
    };
    const sim::LightField field = exposed(display, page, 1, cycles_at).light();
    REQUIRE(field.flashes.size() == 1);
    const sim::Faults none;
    const sim::Seats seats(display, 1, 2.5 + ahead, none);
    CHECK(glm::distance(field.flashes[0].place_mm, seats.place_mm(1, 3)) < 1e-6);
    CHECK(field.flashes[0].time == 2);
    CHECK(field.light(field.flashes[0]).x == Approx(1.0));
}

TEST_CASE("row groups and planes that are lit one after the other stand apart by as much as the display moved") {
    DisplayDescription display = hub75_rotor();
    const std::vector<std::byte> page = white_page(display);
    std::vector<double> first;
    exposed(display, page).for_each_row([&](const sim::ExposedRow& row) {
        if (row.slice != 5 || row.panel != 0) return;
        CHECK(std::abs(row.late) < 0.5);
        CHECK(row.at == Approx(5.5 + row.late));
        if (row.row == 0) first.push_back(row.late);
        if (row.row == 1) CHECK(row.late > 0.0);  // The second group.
    });
    REQUIRE(first.size() >= 1);
    for (const double late : first) CHECK(late < 0.0);
    CHECK(std::ranges::is_sorted(first));
}

TEST_CASE("a swept plane's light is at its height on the way up and on the way down") {
    DisplayDescription display = swept_of(2, 2, 8, MotionProfile::Sine);
    display.motion.both_ways = true;
    std::vector<std::byte> page = dark_page(display);
    set_pixel(display, page, {.slice = 6}, 1);
    const sim::LightField field = exposed(display, page).light();
    REQUIRE(field.flashes.size() == 1);  // One place.
    CHECK(field.flashes[0].place_mm.z == Approx(sim::plane_height_mm(display, 6.0)).margin(1e-3));
    CHECK(field.light(field.flashes[0]).x == Approx(1.0).epsilon(1e-5));

    const auto late = [&](std::uint64_t time_ns) {  // By three quarters of a slice; there are 16 in a cycle.
        return static_cast<double>(time_ns) * 1e-9 * display.cycles_per_second + 0.75 / 16.0;
    };
    const sim::LightField two = exposed(display, page, 1, late).light();
    REQUIRE(two.flashes.size() == 2);
    std::array heights{two.flashes[0].place_mm.z, two.flashes[1].place_mm.z};
    std::ranges::sort(heights);
    CHECK(heights[0] == Approx(sim::plane_height_mm(display, 5.25)).margin(1e-3));
    CHECK(heights[1] == Approx(sim::plane_height_mm(display, 6.75)).margin(1e-3));
    CHECK(two.measured[0].x + two.measured[1].x == Approx(1.0).epsilon(1e-5));
}

TEST_CASE("light that comes to the same slice of the way from several is added up, at its mean place") {
    DisplayDescription display = rotor_of(4, 2, 8, PixelFormat::Mono1, 1);
    std::vector<std::byte> page = dark_page(display);
    for (std::uint32_t slice = 2; slice < 5; ++slice) set_pixel(display, page, {.slice = slice}, 1);
    // Two cycles: one of them late by a slice and a quarter.
    const auto cycles_at = [&](std::uint64_t time_ns) {
        const double cycles = static_cast<double>(time_ns) * 1e-9 * display.cycles_per_second;
        return cycles < 2.0 ? cycles : cycles + 1.25 / 8.0;
    };
    const sim::LightField field = exposed(display, page, 2, cycles_at).light();
    REQUIRE(field.flashes.size() == 4);
    std::vector<float> light;
    for (const sim::Flash& flash : field.flashes) light.push_back(field.light(flash).x);
    std::ranges::sort(light);
    CHECK(light[0] == Approx(0.5));
    CHECK(light[1] == Approx(0.5));
    CHECK(light[2] == Approx(1.0));
    CHECK(light[3] == Approx(1.0));
    const sim::Faults none;
    const sim::Seats seats(display, 0, 3.5 + 0.125, none);
    CHECK(std::ranges::any_of(field.flashes, [&](const sim::Flash& flash) {
        return glm::distance(flash.place_mm, seats.place_mm(0, 0)) < 1e-3;
    }));
}

TEST_CASE("half turns light both halves of the way, and count as the same pixels") {
    DisplayDescription display = rotor_of(4, 2, 8, PixelFormat::Mono1, 1);
    display.panels[0].offset_mm = 0.0;
    display.sweep_deg = 180.0;
    std::vector<std::byte> page = dark_page(display);
    set_pixel(display, page, {.slice = 2, .row = 1, .column = 3}, 1);
    const sim::Exposure exposure = exposed(display, page, 2);
    std::vector<bool> mirrored;
    exposure.for_each_row([&](const sim::ExposedRow& row) { mirrored.push_back(row.mirrored); });
    CHECK(mirrored == std::vector{false, true});
    const Lights lights = lights_of(exposure);
    REQUIRE(lights.size() == 1);
    CHECK(lights.at({2, 0, 1, 3}).x == Approx(1.0).epsilon(1e-5));
    const sim::LightField field = exposure.light();
    REQUIRE(field.flashes.size() == 2);
    CHECK(glm::distance(field.flashes[0].place_mm, field.flashes[1].place_mm) < 1e-3);
}

TEST_CASE("jitter smears light, and loses none") {
    const DisplayDescription display = hub75_rotor();
    const std::vector<std::byte> page = random_page(display);
    const auto cycles_at = [&](std::uint64_t time_ns) {  // A quarter of a slice to both sides, from turn to turn.
        const double turns = static_cast<double>(time_ns) * 1e-9 * display.cycles_per_second;
        return turns + 0.25 * std::sin(5.0 * turns) / display.slices;
    };
    const sim::Exposure exposure = exposed(display, page, 5, cycles_at);
    CHECK(greatest_difference(lights_of(exposure), steady_lights(display, page)) < 1e-6);
    CHECK(greatest_difference(lights_anywhere(exposure), steady_lights(display, page)) < 1e-6);
    std::size_t places = 0;
    double most = 0.0;
    exposure.for_each_row([&](const sim::ExposedRow& row) {
        if (row.slice == 3 && row.row == 0 && row.panel == 0) ++places;
        most = std::max(most, std::abs(row.late));
    });
    CHECK(places >= 3);
    CHECK(most < 0.75);
}

TEST_CASE("rows that never stay the same are added up, at the same light") {
    const DisplayDescription display = hub75_rotor();
    const TimeAt time_at = perfect_time(display);
    constexpr std::uint32_t kCycles = 40;
    sim::Exposure exposure(display, display, {}, 0, time_at(kCycles * device::kCycle));
    const auto scan = sim::make_strobe_scan(display, [&](const sim::Strobe& strobe) {
        sim::Strobe later = strobe;
        exposure.add(later);
    });
    // Another page in each cycle: the same, but with another pixel on.
    Lights sum;
    std::mt19937 random(3);
    for (std::uint32_t cycle = 0; cycle < kCycles; ++cycle) {
        std::vector<std::byte> page = dark_page(display);
        for (std::byte& byte : page) byte = static_cast<std::byte>(random());
        for (const auto& [pixel, light] : steady_lights(display, page)) sum[pixel] += light / float{kCycles};
        const auto at_cycle = [&](device::Phase phase) { return time_at(cycle * device::kCycle + phase); };
        scan_page(display, page, 1, *scan, at_cycle);
    }
    CHECK(greatest_difference(lights_of(exposure), sum) < 2e-6);
    CHECK(greatest_difference(lights_anywhere(exposure), sum) < 2e-6);
}

TEST_CASE("an exposure's memory has a bound, and no light is lost to it") {
    DisplayDescription display = hub75_rotor();
    display.slices = 4;
    std::mt19937 random(11);
    double ahead = 0.0;
    std::uint64_t time_ns = 0;
    constexpr std::uint32_t kStrobes = 20'000;
    const sim::Exposure::CyclesAt cycles_at = [&](std::uint64_t) { return ahead; };
    sim::Exposure exposure(display, display, cycles_at, 0, std::uint64_t{kStrobes} * 1000);
    std::vector<std::byte> bits(4 * 3 * 2);
    std::uint32_t lit = 0;
    for (std::uint32_t i = 0; i < kStrobes; ++i, time_ns += 1000) {
        for (std::byte& byte : bits) byte = static_cast<std::byte>(random());
        bits[0] |= std::byte{1};
        bits[1] &= std::byte{0x0f};
        ahead = static_cast<double>(random() % 1000) / 1000.0;
        sim::Strobe strobe{.on_ns = time_ns, .off_ns = time_ns + 1000, .row_group = sim::Strobe::kAllRows, .slice = 2};
        for (std::uint32_t p = 0; p < 2; ++p) {
            strobe.panels[p] = {.first = bits.data(), .row_bytes = 6, .channel_bytes = {0, 2, 4}};
        }
        exposure.add(strobe);
        ++lit;
        REQUIRE(exposure.bytes() <= sim::Exposure::most_bytes(display));
    }
    // The pixel that was always lit has all of the light, at all of its few places.
    const double full = sim::full_light_ns(display) * 1e-9 * display.cycles_per_second;
    std::size_t places = 0;
    double light = 0.0;
    exposure.for_each_place(2, 1, 0, [&](const sim::ExposedRow& row) {
        ++places;
        light += double{row.light[0].x};
    });
    CHECK(light == Approx((1000.0 - 100.0 + 50.0) / 1000.0 / full).epsilon(1e-4));
    CHECK(places <= 64 + 8);
}

TEST_CASE("a page that stays takes little memory, wherever the display strays to") {
    const DisplayDescription display = hub75_rotor();
    const TimeAt time_at = perfect_time(display);
    double ahead = 0.0;
    const auto cycles_at = [&](std::uint64_t ns) {
        return static_cast<double>(ns) * 1e-9 * display.cycles_per_second * 1.0037 + ahead;
    };
    sim::Exposure exposure(display, display, cycles_at, 0, time_at(500 * device::kCycle));
    const auto scan = sim::make_strobe_scan(display, [&](const sim::Strobe& strobe) { exposure.add(strobe); });
    scan_page(display, white_page(display), 500, *scan, time_at);
    const std::size_t rows = 2 * 4 * 16;
    CHECK(exposure.bytes() < rows * 2000);
}

TEST_CASE("a shutter cuts the light of a strobe") {
    const DisplayDescription display = stack_of(2, 1, 1);
    sim::Exposure exposure(display, display, {}, 1000, 10'001'000);  // A cycle.
    const std::array bits{std::byte{0b10}};
    sim::Strobe strobe{.on_ns = 0, .off_ns = 2000, .row_group = sim::Strobe::kAllRows, .plane = sim::Strobe::kLevels};
    strobe.panels[0] = {.first = bits.data(), .row_bytes = 1};
    exposure.add(strobe);
    const Lights lights = lights_of(exposure);
    REQUIRE(lights.size() == 1);
    CHECK(lights.at({0, 0, 0, 1}).x == Approx(1000.0 / 1e7));
    strobe.on_ns = 10'001'000;
    strobe.off_ns = 10'002'000;
    exposure.add(strobe);
    CHECK(lights_of(exposure) == lights);
}

}  // namespace
}  // namespace xorvox
