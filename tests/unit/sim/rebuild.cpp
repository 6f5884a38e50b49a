#include "sim/rebuild.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <glm/geometric.hpp>

#include "driver/display/lattice.h"
#include "tests/catch.h"
#include "tests/unit/sim/displays.h"

namespace xorvox {
namespace {

using namespace test;

/// The pixel that is declared to be sample (x, y, k) of the lattice; driver/display/lattice.h.
Pixel pixel_of(const DisplayDescription& display, std::uint32_t x, std::uint32_t y, std::uint32_t k) {
    if (display.kind == DisplayKind::StackedPlanes) return {.slice = k, .row = y, .column = x};
    Pixel pixel{.slice = y, .column = x};
    while (pixel.column >= display.panels[pixel.panel].columns) {
        pixel.column -= display.panels[pixel.panel].columns;
        ++pixel.panel;
    }
    pixel.row = display.panels[0].rows - 1u - k;
    return pixel;
}

/// Codes for all samples, about one in three lit, and the page that lights them.
struct Sent {
    std::vector<std::uint32_t> codes;
    std::vector<std::byte> page;

    Sent(const DisplayDescription& display, unsigned seed) : page(dark_page(display)) {
        std::mt19937 random(seed);
        const DisplayLattice owner(display);
        const Lattice lattice = owner.view();
        const std::uint32_t largest = (1u << bits_per_pixel(display.format)) - 1u;
        for (std::uint32_t k = 0; k < lattice.nz; ++k) {
            for (std::uint32_t y = 0; y < lattice.ny; ++y) {
                for (std::uint32_t x = 0; x < lattice.nx; ++x) {
                    codes.push_back(random() % 3 == 0 ? 1 + static_cast<std::uint32_t>(random()) % largest : 0);
                    set_pixel(display, page, pixel_of(display, x, y, k), codes.back());
                }
            }
        }
    }
};

std::vector<DisplayDescription> displays(PixelFormat format) {
    DisplayDescription on_axis = rotor_of(7, 4, 12, format);  // column 3 is on the axis: one place all turn long
    for (Panel& panel : on_axis.panels) panel.offset_mm = 0.0;
    DisplayDescription interleaved = rotor_of(6, 3, 9, format);
    interleaved.panels[1].shift_mm = 1.0;
    interleaved.panels[1].column_pitch_mm = 2.5;
    interleaved.clockwise = true;
    return {stack_of(5, 4, 3, format), rotor_of(8, 4, 10, format), rotor_of(9, 3, 7, format, 1), on_axis, interleaved};
}

TEST_CASE("what lit up is rebuilt as it was sent, on every display and in every format") {
    const auto format = GENERATE(PixelFormat::Mono1, PixelFormat::Rgb111, PixelFormat::Rgb332, PixelFormat::Rgb565,
                                 PixelFormat::Rgb888);
    INFO(to_string(format));
    for (const DisplayDescription& display : displays(format)) {
        INFO(display.name.view());
        const sim::DisplaySamples samples(display);
        const Sent sent(display, 1);
        REQUIRE(sent.codes.size() == samples.size());
        const sim::Rebuilt rebuilt = samples.rebuild(sim::expose(display, sent.page, 255));
        CHECK(rebuilt.outside == 0);
        CHECK((rebuilt == samples.faithful(sent.codes)));
    }
}

TEST_CASE("a display put together wrongly is not rebuilt as sent") {
    for (const DisplayDescription& display : displays(PixelFormat::Rgb332)) {
        INFO(display.name.view());
        const sim::DisplaySamples samples(display);
        const Sent sent(display, 2);
        const sim::Rebuilt truth = samples.faithful(sent.codes);
        const auto rebuilt_with = [&](const sim::Misbuild& misbuild) {
            return samples.rebuild(sim::expose(display, sent.page, 255, misbuild));
        };
        CHECK_FALSE((rebuilt_with({.swap_a = 0, .swap_b = 1}) == truth));
        CHECK_FALSE((rebuilt_with({.mirrored_panel = 0}) == truth));
        CHECK_FALSE((rebuilt_with({.phase_slices = 1}) == truth));
    }
}

TEST_CASE("one lost, added or recoloured voxel is seen") {
    const DisplayDescription display = rotor_of(8, 4, 10, PixelFormat::Rgb332);
    const sim::DisplaySamples samples(display);
    Sent sent(display, 3);
    const sim::Rebuilt rebuilt = samples.rebuild(sim::expose(display, sent.page, 255));
    sent.codes[17] ^= 0x80;
    CHECK_FALSE((rebuilt == samples.faithful(sent.codes)));
    sent.codes[17] = sent.codes[17] == 0 ? 1 : 0;
    CHECK_FALSE((rebuilt == samples.faithful(sent.codes)));
}

TEST_CASE("the nearest sample is found as by looking at all") {
    for (const DisplayDescription& display : displays(PixelFormat::Mono1)) {
        const sim::DisplaySamples samples(display);
        const DisplayLattice owner(display);
        const Lattice lattice = owner.view();
        std::mt19937 random(4);
        std::uniform_real_distribution<double> place(-20.0, 20.0);
        for (int i = 0; i < 300; ++i) {
            const glm::dvec3 wanted(place(random), place(random), place(random));
            double least = std::numeric_limits<double>::infinity();
            for (std::uint32_t k = 0; k < lattice.nz; ++k) {
                for (std::uint32_t y = 0; y < lattice.ny; ++y) {
                    for (std::uint32_t x = 0; x < lattice.nx; ++x) {
                        least = std::min(least, glm::distance(wanted, sample_position(lattice, x, y, k)));
                    }
                }
            }
            const sim::DisplaySamples::Nearest found = samples.nearest(wanted);
            const glm::dvec3 at =
                sample_position(lattice, found.column % lattice.nx, found.column / lattice.nx, found.k);
            CHECK(glm::distance(wanted, at) == Approx(least).margin(1e-12));
            CHECK(found.distance_mm == Approx(least).margin(1e-12));
        }
    }
}

TEST_CASE("light further than a quarter pitch from every sample is outside") {
    const DisplayDescription display = stack_of(4, 4, 4);  // the smallest pitch is 2 mm
    const sim::DisplaySamples samples(display);
    CHECK(samples.reach_mm() == 0.5);
    const glm::dvec3 sample(1.0, 1.5, 3.5);
    sim::LightField field;
    for (const double away : {0.0, 0.49, -0.49, 0.51, 1.0}) {
        field.flashes.push_back({sample + glm::dvec3(away, 0.0, 0.0), glm::vec3(1.0f), 1, 0});
    }
    field.flashes.push_back({{0.0, 0.0, 400.0}, glm::vec3(1.0f), 1, 0});
    CHECK(samples.rebuild(field).outside == 3);
}

TEST_CASE("columns at one place are one group") {
    // Offset-free panels back to back: column c of one is column 7 − c of the other half a turn later, and of itself.
    DisplayDescription display = rotor_of(8, 2, 6);
    for (Panel& panel : display.panels) panel.offset_mm = 0.0;
    const sim::DisplaySamples samples(display);
    CHECK(samples.column_count() == 96);
    CHECK(samples.group_count() == 24);
    std::size_t columns = 0;
    for (std::size_t group = 0; group < samples.group_count(); ++group) {
        CHECK(samples.columns_of(group).size() == 4);
        for (const std::uint32_t column : samples.columns_of(group)) CHECK(samples.group_of(column) == group);
        columns += samples.columns_of(group).size();
    }
    CHECK(columns == samples.column_count());
}

}  // namespace
}  // namespace xorvox
