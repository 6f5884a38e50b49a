// The instruments of an exposure: statistics, histogram.
#include <cstdint>
#include <string>
#include <vector>

#include "sim/exposed_voxels.h"
#include "sim/exposure.h"
#include "sim/exposure_statistics.h"
#include "sim/histogram.h"
#include "sim/scan_out.h"
#include "tests/catch.h"
#include "tests/unit/sim/displays.h"
#include "tests/unit/sim/perfect.h"

namespace xorvox {
namespace {

using namespace test;

struct Watched {
    sim::Faults faults;
    double ahead_slices = 0.0;
    std::uint8_t brightness = 255;
    std::uint32_t cycles = 1;
};

/// What a shutter sees of `lit` in a cycle.
sim::Exposure exposed(const DisplayDescription& display, std::span<const std::byte> lit, const Watched& watched = {}) {
    const TimeAt time_at = perfect_time(display);
    const auto cycles_at = [display, ahead = watched.ahead_slices](std::uint64_t time_ns) {
        return static_cast<double>(time_ns) * 1e-9 * display.cycles_per_second + ahead / display.slices;
    };
    sim::Exposure exposure(display, display, cycles_at, 0, time_at(watched.cycles * device::kCycle), watched.faults);
    const auto scan = sim::make_strobe_scan(display, [&](const sim::Strobe& strobe) { exposure.add(strobe); });
    scan_page(display, lit, watched.cycles, *scan, time_at, watched.brightness);
    return exposure;
}

DisplayDescription wide_rotor() {
    DisplayDescription display = rotor_of(32, 2, 20, PixelFormat::Mono4);
    return display;
}

std::vector<std::byte> page_of(const DisplayDescription& display, const std::vector<std::pair<Pixel, unsigned>>& lit) {
    std::vector<std::byte> page = dark_page(display);
    for (const auto& [pixel, code] : lit) set_pixel(display, page, pixel, code);
    return page;
}

TEST_CASE("what is lit as it was sent has no light lost, added or outside") {
    const DisplayDescription display = wide_rotor();
    const std::vector<std::byte> page =
        page_of(display, {{{.slice = 3, .column = 0}, 15}, {{.slice = 4, .panel = 1, .row = 1, .column = 31}, 5}});
    const sim::ExposureStatistics of = sim::measure(exposed(display, page), page, 255);
    CHECK(of.exposure_ms == Approx(40.0));
    CHECK(of.sent == 2);
    CHECK(of.lit == 2);
    CHECK(of.lost == 0);
    CHECK(of.extra == 0);
    CHECK(of.light == Approx(1.0));
    CHECK(of.outside == 0.0);
    CHECK(of.stray_mm < 0.01);
    CHECK(of.stray_slices < 0.001);
    CHECK(of.uniformity.least == Approx(1.0));
    CHECK(of.uniformity.mean == Approx(1.0));
    CHECK(of.uniformity.most == Approx(1.0));
    CHECK(of.uniformity.spread == Approx(0.0).margin(1e-6));
    const sim::ExposureStatistics dimmed = sim::measure(exposed(display, page, {.brightness = 51}), page, 51);
    CHECK(dimmed.light == Approx(1.0));
}

TEST_CASE("lost and extra voxels are told apart") {
    const DisplayDescription display = wide_rotor();
    const auto sent = page_of(display, {{{.slice = 3, .column = 0}, 15}, {{.slice = 4, .column = 1}, 15}});
    const auto lit =
        page_of(display, {{{.slice = 3, .column = 0}, 15}, {{.slice = 4, .column = 2}, 3}, {{.slice = 19}, 1}});
    const sim::ExposureStatistics of = sim::measure(exposed(display, lit), sent, 255);
    CHECK(of.sent == 2);
    CHECK(of.lit == 3);
    CHECK(of.lost == 1);
    CHECK(of.extra == 2);
    CHECK(of.light == Approx((15.0 + 3.0 + 1.0) / 30.0));
    CHECK(of.uniformity.least == 0.0);
    CHECK(of.uniformity.most == Approx(1.0));

    const sim::ExposureStatistics dark = sim::measure(exposed(display, lit), {}, 255);
    CHECK(dark.sent == 0);
    CHECK(dark.extra == 3);
}

TEST_CASE("light may be half a slice's way and the reach from its sample") {
    const DisplayDescription display = wide_rotor();  // A quarter of 2 mm; at the rim a slice is 9.7 mm wide.
    const auto page = page_of(display, {{{.slice = 3, .column = 31}, 15}, {{.slice = 7, .column = 31}, 15}});
    const sim::ExposureStatistics within = sim::measure(exposed(display, page, {.ahead_slices = 0.49}), page, 255);
    CHECK(within.outside == 0.0);
    CHECK(within.stray_slices == Approx(0.49).margin(1e-3));
    CHECK(within.stray_mm == Approx(0.49 * 2.0 * 3.14159265 * 31.14 / 20.0).epsilon(0.01));
    const sim::ExposureStatistics beyond = sim::measure(exposed(display, page, {.ahead_slices = 0.6}), page, 255);
    CHECK(beyond.outside == Approx(1.0));
    CHECK(beyond.lost == 0);

    sim::Faults faults;
    faults.list.push_back({.kind = sim::FaultKind::OffAxis, .panel = 0, .amount = 6.0});
    const auto both =
        page_of(display, {{{.slice = 3, .column = 16}, 15}, {{.slice = 3, .panel = 1, .column = 16}, 15}});
    const sim::ExposureStatistics off = sim::measure(exposed(display, both, {.faults = faults}), both, 255);
    CHECK(off.outside == Approx(0.5));  // The other panel stands as it should.
    CHECK(off.stray_mm == Approx(6.0));
}

TEST_CASE("light anywhere in its slice is not outside, however few slices there are") {
    for (const std::uint32_t slices : {1u, 2u, 3u, 5u, 9u}) {
        DisplayDescription display = rotor_of(16, 8, slices, PixelFormat::Rgb888);
        display.scan.driver = DriverChip::Hub75;
        display.scan.row_groups = 4;
        const std::vector<std::byte> white(frame_bytes(display), std::byte{0xff});
        CAPTURE(slices);
        CHECK(sim::measure(exposed(display, white), white, 255).outside == 0.0);
    }
}

TEST_CASE("a helix's light at its seam is where it should be") {
    const DisplayDescription display = helix_of(8, 6, 10, 1, PixelFormat::Mono1);
    const std::vector<std::byte> page(frame_bytes(display), std::byte{0xff});
    const sim::ExposureStatistics of = sim::measure(exposed(display, page, {.ahead_slices = 0.4}), page, 255);
    CHECK(of.outside == 0.0);
    CHECK(of.stray_mm == Approx(0.4 * 4.0));
}

TEST_CASE("spread is between voxels of equal code") {
    const DisplayDescription display = stack_of(8, 1, 2, PixelFormat::Mono4);
    const auto sent = page_of(display, {{{.column = 0}, 15}, {{.column = 1}, 15}, {{.column = 2}, 5}});
    CHECK(sim::measure(exposed(display, sent), sent, 255).uniformity.spread == Approx(0.0).margin(1e-6));
    const auto lit = page_of(display, {{{.column = 0}, 15}, {{.column = 1}, 5}, {{.column = 2}, 5}});
    // 15 and 5: 10 in the mean, 5 from it each.
    CHECK(sim::measure(exposed(display, lit), sent, 255).uniformity.spread == Approx(std::sqrt(2.0 * 0.25 / 3.0)));
}

/// What a shutter sees of so many cycles of a page that stays.
sim::Exposure open_for(const DisplayDescription& display, std::span<const std::byte> page, double cycles) {
    const TimeAt time_at = perfect_time(display);
    const auto to = static_cast<std::uint64_t>(cycles * 1e9 / display.cycles_per_second);
    sim::Exposure exposure(display, display, {}, 0, to);
    const auto scan = sim::make_strobe_scan(display, [&](const sim::Strobe& strobe) { exposure.add(strobe); });
    scan_page(display, page, static_cast<std::uint32_t>(cycles) + 2, *scan, time_at);
    return exposure;
}

TEST_CASE("light of no whole number of cycles is reckoned against what each slice was due") {
    DisplayDescription sweep = swept_of(5, 4, 9, MotionProfile::Sine, PixelFormat::Mono4);
    sweep.motion.both_ways = true;
    for (const DisplayDescription& display :
         {wide_rotor(), stack_of(8, 3, 10, PixelFormat::Mono4), sweep, helix_of(8, 6, 10, 1, PixelFormat::Mono1)}) {
        CAPTURE(display.name.view());
        const std::vector<std::byte> page(frame_bytes(display), std::byte{0xff});
        for (const double cycles : {0.33, 1.0, 2.5, 2.73}) {
            CAPTURE(cycles);
            const sim::ExposureStatistics of = sim::measure(open_for(display, page, cycles), page, 255);
            CHECK(of.cycles == Approx(cycles));
            CHECK(of.sent > 0);
            CHECK(of.lost == 0);
            CHECK(of.light == Approx(1.0).epsilon(1e-4));
            CHECK(of.uniformity.spread < 1e-4);
            CHECK(of.uniformity.least == Approx(1.0).epsilon(1e-4));
            CHECK(of.uniformity.most == Approx(1.0).epsilon(1e-4));
        }
    }
    // A slice that stays dark is lost, also of a part of a cycle.
    const DisplayDescription rotor = wide_rotor();
    const std::vector<std::byte> white(frame_bytes(rotor), std::byte{0xff});
    std::vector<std::byte> lit = white;
    const std::size_t slice_bytes = lit.size() / rotor.slices;
    std::fill_n(lit.begin() + static_cast<std::ptrdiff_t>(2 * slice_bytes), slice_bytes, std::byte{0});
    const sim::ExposureStatistics of = sim::measure(open_for(rotor, lit, 1.5), white, 255);
    CHECK(of.lost == of.sent / 20);
    CHECK(of.uniformity.least == 0.0);
    const sim::LightHistogram histogram = sim::make_histogram(open_for(rotor, white, 1.5), white, 255);
    CHECK(histogram.lit[50] == 64u * 2 * 20);
}

TEST_CASE("slices that light is away count what faults of place do") {
    const auto strays = [](const DisplayDescription& display, const sim::Fault& fault) {
        const std::vector<std::byte> page(frame_bytes(display), std::byte{0xff});
        sim::Faults faults;
        faults.list.push_back(fault);
        return sim::measure(exposed(display, page, {.faults = faults}), page, 255).stray_slices;
    };
    const DisplayDescription rotor = wide_rotor();
    CHECK(strays(rotor, {.kind = sim::FaultKind::Phase, .amount = 3.0}) == Approx(3.0).margin(0.01));
    CHECK(strays(rotor, {.kind = sim::FaultKind::Phase, .amount = 19.0}) == Approx(1.0).margin(0.01));
    CHECK(strays(rotor, {.kind = sim::FaultKind::SwappedSlices, .slice = 4, .other = 9}) == Approx(5.0).margin(0.01));
    const DisplayDescription stack = stack_of(8, 1, 10);
    CHECK(strays(stack, {.kind = sim::FaultKind::SwappedSlices, .slice = 1, .other = 9}) == 8.0);
    CHECK(strays(stack, {.kind = sim::FaultKind::OffAxis}) == 0.0);
}

TEST_CASE("exposure statistics are JSON, in one order") {
    const DisplayDescription display = stack_of(8, 1, 2);
    const auto page = page_of(display, {{{.column = 0}, 1}});
    CHECK(
        to_json(sim::measure(exposed(display, page), page, 255)) ==
        R"({"display": "stack", "exposure_ms": 10, "cycles": 1, "sent": 1, "lit": 1, "lost": 0, "extra": 0, "light": 1, )"
        R"("outside": 0, "stray_mm": 0, "stray_slices": 0, )"
        R"("uniformity": {"least": 1, "mean": 1, "most": 1, "spread": 0}})");
    CHECK(
        to_json(sim::measure(exposed(display, dark_page(display)), {}, 255)) ==
        R"({"display": "stack", "exposure_ms": 10, "cycles": 1, "sent": 0, "lit": 0, "lost": 0, "extra": 0, "light": null, )"
        R"("outside": 0, "stray_mm": 0, "stray_slices": 0, "uniformity": null})");
}

TEST_CASE("a histogram counts voxels by their light") {
    const DisplayDescription display = stack_of(8, 1, 2, PixelFormat::Mono4);
    const auto sent = page_of(display, {{{.column = 0}, 15}, {{.column = 1}, 15}, {{.column = 2}, 3}});
    const auto lit = page_of(display, {{{.column = 0}, 15}, {{.column = 2}, 3}, {{.column = 7}, 3}});
    const sim::LightHistogram histogram = sim::make_histogram(exposed(display, lit), sent, 255);
    CHECK(histogram.sent[50] == 2);
    CHECK(histogram.sent[10] == 1);
    CHECK(histogram.lit[50] == 1);
    CHECK(histogram.lit[10] == 2);
    CHECK(histogram.lost == 1);
    const std::string csv = to_csv(histogram);
    CHECK(csv.starts_with("from,to,sent,lit\n0.00,0.02,0,0\n"));
    CHECK(csv.find("\n0.20,0.22,1,2\n") != std::string::npos);
    CHECK(csv.find("\n1.00,1.02,2,1\n") != std::string::npos);
    CHECK(csv.ends_with("\n1.18,inf,0,0\n"));
}

TEST_CASE("the histogram's chart shows what was lit and what was sent, also of nothing") {
    sim::LightHistogram histogram{.display = "stack", .exposure_ms = 10.0};
    const sim::Image empty = draw_chart(histogram);
    REQUIRE(empty.width == 960);
    REQUIRE(empty.height == 540);
    histogram.lit[30] = 1000;
    histogram.sent[31] = 1'000'000;
    const sim::Image chart = draw_chart(histogram);
    CHECK(chart.rgb.size() == 3u * 960 * 540);
    const auto differ = [&](std::uint32_t column) {
        std::size_t count = 0;
        for (std::uint32_t row = 100; row < 464; ++row) {
            const std::size_t at = 3 * (std::size_t{row} * 960 + column);
            count += chart.rgb[at] == 86 && chart.rgb[at + 1] == 180;
        }
        return count;
    };
    CHECK(differ(96 + 832 * 61 / 120) > 100);  // In the middle of the bar.
    CHECK(differ(96 + 832 * 51 / 120) == 0);
}

}  // namespace
}  // namespace xorvox
