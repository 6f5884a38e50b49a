#include "driver/host/power_budget.h"

#include <algorithm>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "driver/device/config.h"
#include "driver/device/current.h"
#include "driver/host/slices.h"
#include "tests/catch.h"
#include "tests/displays.h"

using namespace xorvox;
using namespace xorvox::host;

namespace {

/// A stack of 16 × 16 × 4 LEDs, of 10 mA a channel, whose rows are lit two groups at a time.
DisplayDescription limited(double limit_ma) {
    DisplayDescription display;
    display.format = PixelFormat::Rgb888;
    display.slices = 4;
    display.cycles_per_second = 60.0;
    display.panels[0] = {.columns = 16, .rows = 16};
    display.scan.row_groups = 2;
    display.power = {.led_ma = 10.0, .limit_ma = limit_ma};
    return display;
}

/// The first `columns` columns of every row set.
BitVolume slab(const Lattice& lattice, std::uint32_t columns) {
    BitVolume volume(lattice);
    for (std::uint32_t k = 0; k < lattice.nz; ++k) {
        for (std::uint32_t y = 0; y < lattice.ny; ++y) {
            for (std::uint32_t x = 0; x < columns; ++x) volume.view().flip(x, y, k);
        }
    }
    return volume;
}

/// Frames of one programme, dimmed as the head of power_budget.h says.
class Dimmed {
public:
    explicit Dimmed(const DisplayDescription& display) : budget(display), meter(display), painter_(display) {
        frame_.resize(frame_bytes(display));
    }
    void show(std::uint32_t columns) {
        const BitVolume volume = slab(painter_.lattice().view(), columns);
        const auto white = parse_color("constant:white").value();
        tries = 0;
        do {
            ++tries;
            factor = budget.factor();
            painter_.set_brightness(factor);
            REQUIRE(painter_.paint(volume.view(), *white, frame_) == Status::Ok);
        } while (!budget.allows(frame_));
        ma = meter.most_ma(frame_);
    }

    PowerBudget budget;
    CurrentMeter meter;
    float factor = 0.0f;
    double ma = 0.0;
    int tries = 0;

private:
    FramePainter painter_;
    std::vector<std::byte> frame_;
};

}  // namespace

TEST_CASE("the host reckons the current as the device does") {
    std::mt19937 random(9);
    for (DisplayDescription display : test::odd_displays()) {
        for (const PixelFormat format : kPixelFormats) {
            for (std::uint8_t planes = 0; planes <= bits_per_channel(format); ++planes) {
                display.format = format;
                display.scan.bit_planes = planes;
                display.scan.row_groups = static_cast<std::uint16_t>(1 + random() % 4);
                display.scan.driver = random() % 2 == 0 ? DriverChip::Ws2812 : DriverChip::Direct;
                display.power.led_ma = 7.0;
                CAPTURE(std::string(display.name.view()), std::string(to_string(format)), int{planes});
                std::vector<std::byte> frame(frame_bytes(display));
                const FramePainter painter(display);
                BitVolume volume(painter.lattice().view());
                const Lattice lattice = painter.lattice().view();
                for (int i = 0; i < 400; ++i) {
                    volume.view().flip(static_cast<std::uint32_t>(random() % lattice.nx),
                                       static_cast<std::uint32_t>(random() % lattice.ny),
                                       static_cast<std::uint32_t>(random() % lattice.nz));
                }
                REQUIRE(painter.paint(volume.view(), *parse_color("gradient").value(), frame) == Status::Ok);
                const device::CurrentConfig config = device::current_config(display);
                const std::size_t lit = frame.size() / (display.slices / config.slices);
                std::uint64_t most_ua = 0;
                for (std::size_t at = 0; at < frame.size(); at += lit) {
                    most_ua = std::max(most_ua, device::current_ua(config, std::span(frame).subspan(at, lit)));
                }
                // The device rounds up each size of channel and the whole.
                const double ma = CurrentMeter(display).most_ma(frame);
                CHECK(ma <= static_cast<double>(most_ua) / 1000.0 + 1e-9);
                CHECK(ma == Approx(static_cast<double>(most_ua) / 1000.0).margin(0.0031));
                CHECK(most_ua > 0);
            }
        }
    }
}

TEST_CASE("a frame that draws too much is dimmed at once, and never shown as it was") {
    // White draws 16 · 16 · 3 · 10 / 2 = 3840 mA.
    Dimmed shown(limited(1000.0));
    shown.show(1);
    CHECK(shown.factor == 1.0f);
    CHECK(shown.ma == Approx(240.0));
    for (const std::uint32_t columns : {16u, 3u, 9u, 16u, 2u, 16u, 10u}) {
        shown.show(columns);
        CHECK(shown.ma <= 1000.0);
        CHECK(shown.tries <= 3);
    }
    shown.show(16);
    CHECK(shown.ma > 900.0);
}

TEST_CASE("light comes back slowly, by at most two percent a frame, and then fully") {
    Dimmed shown(limited(1000.0));
    shown.show(16);
    float before = shown.factor;
    CHECK(before < 0.27f);
    int frames = 0;
    while (shown.factor < 1.0f && frames < 200) {
        shown.show(2);
        CHECK(shown.factor <= before * PowerBudget::kRelease * 1.0001f);
        CHECK(shown.factor >= before);
        before = shown.factor;
        ++frames;
    }
    CHECK(frames > 60);
    CHECK(frames < 80);
}

TEST_CASE("the same frame again and again settles just below the limit and stays there") {
    Dimmed shown(limited(1500.0));
    for (int i = 0; i < 100; ++i) shown.show(13);
    const float settled = shown.factor;
    CHECK(shown.ma > 0.95 * 1500.0);
    for (int i = 0; i < 20; ++i) {
        shown.show(13);
        CHECK(shown.tries == 1);
        CHECK(shown.factor == Approx(settled).epsilon(0.001));
    }
}

TEST_CASE("without a limit nothing is dimmed, and where dimming cannot help it ends") {
    Dimmed unlimited(limited(0.0));
    unlimited.show(16);
    CHECK(unlimited.factor == 1.0f);
    CHECK(unlimited.tries == 1);

    DisplayDescription one_bit = limited(10.0);
    one_bit.format = PixelFormat::Mono1;
    Dimmed helpless(one_bit);
    helpless.show(16);
    CHECK(helpless.ma == Approx(16 * 16 * 10 / 2.0));
    CHECK(helpless.tries <= 3);

    DisplayDescription unknown = limited(10.0);
    unknown.power.led_ma = 0.0;
    Dimmed unmeasured(unknown);
    unmeasured.show(16);
    CHECK(unmeasured.tries == 1);
}

TEST_CASE("frames that dimming cannot help stay lit however many they are, and light comes back after them") {
    // At the faintest level white draws 3840 / 255 mA, or all of it where there is one level.
    for (const auto& [format, limit_ma] :
         {std::pair(PixelFormat::Rgb888, 10.0), std::pair(PixelFormat::Mono1, 300.0)}) {
        DisplayDescription display = limited(limit_ma);
        display.format = format;
        CAPTURE(std::string(to_string(format)));
        Dimmed shown(display);
        shown.show(16);
        const double least_ma = shown.ma;
        CHECK(least_ma > limit_ma);
        for (int i = 0; i < 1000; ++i) {
            shown.show(16);
            REQUIRE(shown.ma == least_ma);
            REQUIRE(shown.factor > 0.0f);
        }
        for (int i = 0; i < 400; ++i) shown.show(1);
        CHECK(shown.ma > 0.0);
        // One column white: 240 mA; of one LED a pixel 80 mA.
        CHECK(shown.factor > (format == PixelFormat::Mono1 ? 0.99f : 0.9f * 10.0f / 240.0f));
    }
}
