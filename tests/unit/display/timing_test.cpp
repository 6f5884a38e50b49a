// Descriptions are refused that have no time for their planes: the planes of one that is valid are all lit, by the
// modulation that lights them.
#include "driver/display/timing.h"

#include <cmath>
#include <random>
#include <string>
#include <utility>

#include "driver/device/scan/modulation.h"
#include "driver/display/names.h"
#include "driver/display/rules.h"
#include "driver/display/toml.h"
#include "tests/catch.h"

using namespace xorvox;

namespace {

device::Modulation of_a_slice(const DisplayDescription& display) {
    return device::modulate(device::modulation_config(display), static_cast<std::uint64_t>(slice_time_ns(display)));
}

/// With figures of all sizes, many of them so large that they do not fit.
DisplayDescription random_display(std::mt19937_64& random) {
    const auto below = [&](std::uint64_t end) { return random() % end; };
    const auto figure = [&](std::uint64_t bits) {
        return static_cast<std::uint32_t>(below(4) == 0 ? 0 : random() >> (63 - below(bits)));
    };
    DisplayDescription display;
    display.name = DisplayName("random");
    display.format = kPixelFormats[below(std::size(kPixelFormats))];
    display.slices = static_cast<std::uint32_t>(1 + below(300));
    display.cycles_per_second = 1.0 + static_cast<double>(below(100));
    display.plane_pitch_mm = 1.0;
    const auto groups = static_cast<std::uint16_t>(2 + below(4));
    const auto rows = static_cast<std::uint16_t>(2 * groups * (1 + below(3)));
    display.panels[0] = {.columns = static_cast<std::uint16_t>(1 + below(40)),
                         .rows = rows,
                         .column_pitch_mm = 1.0,
                         .row_pitch_mm = 1.0};
    switch (below(3)) {
        case 0: display.scan.driver = DriverChip::ShiftRegister595; break;
        case 1:
            display.scan.driver = DriverChip::Hub75;
            display.scan.row_groups = groups;
            break;
        default: display.scan.row_groups = groups; break;
    }
    const std::uint32_t clock_hz = figure(29);
    display.scan.pixel_clock_hz = clock_hz;
    display.scan.latch_ns = figure(14);
    display.scan.rise_ns = figure(14);
    display.scan.fall_ns = figure(14);
    display.scan.min_on_ns = figure(17);
    display.scan.bit_planes = static_cast<std::uint8_t>(below(2) * (1 + below(bits_per_channel(display.format))));
    return display;
}

}  // namespace

TEST_CASE("a cube whose first data leave no time for its least plane is refused, with what fits") {
    auto display = parse_display(R"(name = "edge"
kind = "stacked-planes"
format = "mono2"
slices = 2
cycles_per_second = 100.0
plane_pitch_mm = 5.0
[[panel]]
columns = 8
rows = 8
column_pitch_mm = 5.0
row_pitch_mm = 5.0
[scan]
driver = "74hc595"
pixel_clock_hz = 33_000
latch_ns = 1000
)",
                                 "edge.toml");
    REQUIRE_FALSE(display);
    CHECK_THAT(display.error().message,
               Catch::Matchers::Contains("at which a slice has 5 ms, but its scan needs 6.003 ms for 2"
                                         " bit planes; what fits: 1 bit plane, or 1 slices, or 83.2"
                                         " cycles a second"));
}

TEST_CASE("every plane of a valid display is lit, within the time of its slice") {
    for (const Preset& preset : presets()) {
        INFO(preset.name);
        const DisplayDescription display = load_display(std::string(preset.name)).value();
        if (!lit_by_planes(display)) continue;
        CHECK(of_a_slice(display).planes == shown_bit_planes(display));
    }
    std::size_t valid = 0;
    std::size_t refused_by_rate = 0;
    for (std::uint64_t seed = 0; seed < 20'000; ++seed) {
        std::mt19937_64 random(seed);
        const DisplayDescription display = random_display(random);
        const auto answer = validate_display(display);
        const device::Modulation slots = of_a_slice(display);
        const bool fits = slots.planes == shown_bit_planes(display) &&
                          static_cast<double>(slots.total_ns()) <= slice_time_ns(display);
        if (!answer) {
            // Not more than what does not fit is refused.
            if (answer.error().message.find("but its scan needs") == std::string::npos) continue;
            ++refused_by_rate;
            if (!fits) continue;
        } else {
            ++valid;
            if (fits) continue;
        }
        CAPTURE(seed, answer.has_value());
        FAIL_CHECK("valid and lit whole, or neither");
    }
    CHECK(valid > 1000);
    CHECK(refused_by_rate > 1000);
}

TEST_CASE("each plane gives half the light of the one before, whatever the LEDs' rise and fall") {
    for (const auto& [rise_ns, fall_ns] : {std::pair{0u, 0u}, {0u, 5000u}, {10u, 5001u}, {5000u, 0u}, {700u, 301u}}) {
        for (const std::uint32_t min_on_ns : {0u, 1u, 6000u}) {
            const device::ModulationConfig config{
                .row_groups = 2, .planes = 4, .rise_ns = rise_ns, .fall_ns = fall_ns, .min_on_ns = min_on_ns};
            device::Modulation shortest = device::modulate(config, 0);
            shortest.planes = config.planes;
            const std::uint64_t least_ns = shortest.total_ns();
            for (const std::uint64_t available_ns : {least_ns, least_ns + 101, least_ns * 3}) {
                const device::Modulation slots = device::modulate(config, available_ns);
                CAPTURE(rise_ns, fall_ns, min_on_ns, available_ns);
                REQUIRE(slots.planes == 4);
                for (std::uint32_t plane = 0; plane < 4; ++plane) {
                    // What an LED gives that has risen.
                    CHECK(slots.on_ns(plane) >= rise_ns);
                    const double light_ns = static_cast<double>(slots.on_ns(plane)) - rise_ns / 2.0 + fall_ns / 2.0;
                    const auto exact_ns = static_cast<double>(slots.unit_ns << (3 - plane));
                    CHECK(std::abs(light_ns - exact_ns) <= 0.5);
                }
            }
        }
    }
}
