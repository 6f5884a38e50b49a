#include "sim/rebuild.h"

#include <algorithm>
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

/// The sample that a pixel is declared to be; driver/display/lattice.h.
std::uint64_t sample_of(const DisplayDescription& display, const DisplayLattice& owner, const Pixel& pixel) {
    const Lattice lattice = owner.view();
    const auto number = [&](std::uint32_t x, std::uint32_t y, std::uint32_t k) {
        return (std::uint64_t{k} * lattice.ny + y) * lattice.nx + x;
    };
    const std::uint32_t in_panel = pixel.row * display.panels[pixel.panel].columns + pixel.column;
    switch (display.kind) {
        case DisplayKind::StackedPlanes:
        case DisplayKind::SweptPlane: return number(pixel.column, pixel.row, pixel.slice);
        case DisplayKind::FreePoints: return in_panel;
        case DisplayKind::Helix: {
            const std::uint32_t turned = display.clockwise ? pixel.slice : lattice.nz - pixel.slice;
            return number(pixel.column, pixel.row, (owner.helix_k()[in_panel] + turned) % lattice.nz);
        }
        case DisplayKind::RotatingPanel: break;
    }
    std::uint32_t x = 0;
    for (std::uint32_t p = 0; p < pixel.panel; ++p) {
        const Panel& panel = display.panels[p];
        x += is_upright(display) ? upright_columns(panel) : std::uint32_t{panel.columns} * panel.rows;
    }
    if (!is_upright(display)) return number(x + in_panel, pixel.slice, 0);
    const UprightPixel upright = upright_pixel(display.panels[pixel.panel], pixel.column, pixel.row);
    return number(x + upright.column, pixel.slice, upright.row);
}

/// Codes for all pixels, about one in three lit, and the page that lights them.
struct Sent {
    std::vector<sim::SampleCode> codes;
    std::vector<std::byte> page;

    Sent(const DisplayDescription& display, unsigned seed) : page(dark_page(display)) {
        std::mt19937 random(seed);
        const DisplayLattice owner(display);
        const std::uint32_t largest = (1u << bits_per_pixel(display.format)) - 1u;
        Pixel pixel;
        for (pixel.slice = 0; pixel.slice < display.slices; ++pixel.slice) {
            for (pixel.panel = 0; pixel.panel < display.panel_count; ++pixel.panel) {
                const Panel& panel = display.panels[pixel.panel];
                for (pixel.row = 0; pixel.row < panel.rows; ++pixel.row) {
                    for (pixel.column = 0; pixel.column < panel.columns; ++pixel.column) {
                        if (random() % 3 != 0) continue;
                        const std::uint32_t code = 1 + static_cast<std::uint32_t>(random()) % largest;
                        codes.push_back({sample_of(display, owner, pixel), code});
                        set_pixel(display, page, pixel, code);
                    }
                }
            }
        }
    }
};

std::vector<DisplayDescription> rotors(PixelFormat format) {
    std::vector<DisplayDescription> all{rotor_of(8, 4, 10, format), rotor_of(9, 3, 7, format, 1)};
    DisplayDescription on_axis = rotor_of(7, 4, 12, format);  // column 3 is on the axis: one place all turn long
    for (Panel& panel : on_axis.panels) panel.offset_mm = 0.0;
    all.push_back(on_axis);
    DisplayDescription interleaved = rotor_of(6, 3, 9, format);
    interleaved.panels[1].shift_mm = 1.0;
    interleaved.panels[1].column_pitch_mm = 2.5;
    interleaved.clockwise = true;
    all.push_back(interleaved);
    DisplayDescription half_turn = rotor_of(6, 3, 9, format, 1);
    half_turn.sweep_deg = 180.0;
    half_turn.panels[0].offset_mm = 0.0;
    all.push_back(half_turn);
    DisplayDescription lifted = rotor_of(6, 5, 9, format);  // back to back, and two rows higher
    lifted.panels[1].lift_mm = 8.0;
    all.push_back(lifted);
    for (std::uint8_t turned = 0; turned < 4; ++turned) {
        for (const bool mirrored : {false, true}) {
            for (const double tilt_deg : {0.0, -20.0}) {
                DisplayDescription mounted = rotor_of(5, 4, 6, format);
                mounted.panels[0].turned = mounted.panels[1].turned = turned;
                mounted.panels[1].mirrored = mirrored;
                mounted.panels[0].tilt_deg = tilt_deg;
                mounted.panels[0].skew_mm = 0.7;
                mounted.panels[1].lift_mm = 3.0;
                mounted.panels[1].shift_mm = 0.3;
                mounted.clockwise = turned % 2 == 1;
                all.push_back(mounted);
            }
        }
    }
    DisplayDescription unlike = rotor_of(6, 3, 9, format);
    unlike.panels[1].rows = 5;
    all.push_back(unlike);
    return all;
}

std::vector<DisplayDescription> displays(PixelFormat format) {
    std::vector<DisplayDescription> all = rotors(format);
    all.push_back(stack_of(5, 4, 3, format));
    static constexpr double kHeights[] = {-5.0, 1.0, 2.5, 3.0};
    all.push_back(stack_of(5, 4, 4, format));
    all.back().plane_heights_mm = kHeights;
    for (const auto profile : {MotionProfile::Constant, MotionProfile::Sine, MotionProfile::Table}) {
        all.push_back(swept_of(5, 4, 7, profile, format));
        all.back().motion.dead_zone = 0.1;
        all.back().motion.both_ways = profile == MotionProfile::Sine;
    }
    for (const bool clockwise : {false, true}) {
        all.push_back(helix_of(6, 5, 8, 2, format));
        all.back().clockwise = clockwise;
        all.push_back(helix_of(5, 5, 4, 1, format));  // its diagonals meet the ends of the screen
        all.back().panels[0].row_pitch_mm = 2.0;
        all.back().clockwise = clockwise;
    }
    all.push_back(points_of(format));
    return all;
}

TEST_CASE("what lit up is rebuilt as it was sent, on every display and in every format") {
    const auto format = GENERATE(from_range(kPixelFormats));
    INFO(to_string(format));
    std::size_t number = 0;
    for (const DisplayDescription& display : displays(format)) {
        INFO(display.name.view() << " " << number++);
        const sim::DisplaySamples samples(display);
        const Sent sent(display, 1);
        REQUIRE_FALSE(sent.codes.empty());
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
        const auto rebuilt_with = [&](std::string_view fault) {
            return samples.rebuild(sim::expose(display, sent.page, 255, {{sim::parse_fault(fault).value()}}));
        };
        CHECK_FALSE((rebuilt_with("swapped-slices:slice=0,other=1") == truth));
        CHECK_FALSE((rebuilt_with("mirrored") == truth));
        CHECK_FALSE((rebuilt_with("phase:slices=1") == truth));
    }
}

TEST_CASE("one lost, added or recoloured voxel is seen") {
    const DisplayDescription display = rotor_of(8, 4, 10, PixelFormat::Rgb332);
    const sim::DisplaySamples samples(display);
    Sent sent(display, 3);
    const sim::Rebuilt rebuilt = samples.rebuild(sim::expose(display, sent.page, 255));
    CHECK((rebuilt == samples.faithful(sent.codes)));
    sent.codes[17].code = sent.codes[17].code == 0x80 ? 0x81 : 0x80;
    CHECK_FALSE((rebuilt == samples.faithful(sent.codes)));
    const std::uint64_t lost = sent.codes[17].sample;
    sent.codes.erase(sent.codes.begin() + 17);
    CHECK_FALSE((rebuilt == samples.faithful(sent.codes)));
    for (std::uint64_t sample = 0; sample < samples.size(); ++sample) {
        if (samples.place_of(sample) == samples.place_of(lost)) continue;
        sent.codes.push_back({sample, 1});
        break;
    }
    CHECK_FALSE((rebuilt == samples.faithful(sent.codes)));
}

TEST_CASE("the nearest place is found as by looking at all") {
    for (const DisplayDescription& display : displays(PixelFormat::Mono1)) {
        const sim::DisplaySamples samples(display);
        const Lattice lattice = samples.lattice();
        std::vector<glm::dvec3> places;
        for (std::uint32_t k = 0; k < lattice.nz; ++k) {
            for (std::uint32_t y = 0; y < lattice.ny; ++y) {
                for (std::uint32_t x = 0; x < lattice.nx; ++x) places.push_back(sample_position(lattice, x, y, k));
            }
        }
        std::mt19937 random(4);
        std::uniform_real_distribution<double> aside(-0.7 * samples.reach_mm(), 0.7 * samples.reach_mm());
        std::size_t within = 0;
        for (int i = 0; i < 300; ++i) {
            const glm::dvec3 wanted =
                places[random() % places.size()] + glm::dvec3(aside(random), aside(random), aside(random));
            double least = std::numeric_limits<double>::infinity();
            for (const glm::dvec3& place : places) least = std::min(least, glm::distance(wanted, place));
            const auto found = samples.place_near(wanted);
            REQUIRE(found.has_value() == (least <= samples.reach_mm()));
            if (!found) continue;
            ++within;
            CHECK(glm::distance(wanted, places[*found]) == Approx(least).margin(1e-12));
            CHECK(samples.place_of(*found) == *found);
        }
        CHECK(within > 100);
        CHECK(within < 300);
    }
}

TEST_CASE("every place goes by the lowest of the samples that stand there") {
    for (const DisplayDescription& display : displays(PixelFormat::Mono1)) {
        const sim::DisplaySamples samples(display);
        const Lattice lattice = samples.lattice();
        std::vector<glm::dvec3> places;
        std::size_t place_count = 0;
        for (std::uint64_t sample = 0; sample < samples.size(); ++sample) {
            const auto column = static_cast<std::uint32_t>(sample % lattice.column_count());
            const auto k = static_cast<std::uint32_t>(sample / lattice.column_count());
            places.push_back(sample_position(lattice, column % lattice.nx, column / lattice.nx, k));
            std::uint64_t lowest = 0;
            while (glm::distance(places[lowest], places[sample]) > 1e-9) ++lowest;
            REQUIRE(samples.place_of(sample) == lowest);
            place_count += lowest == sample;
        }
        CHECK(samples.place_count() == place_count);
    }
}

TEST_CASE("reach is a quarter of the smallest distance between parts") {
    const auto reach = [](const DisplayDescription& display) { return sim::DisplaySamples(display).reach_mm(); };
    CHECK(reach(stack_of(4, 4, 4)) == 0.5);  // columns are 2 mm apart
    DisplayDescription narrow = rotor_of(4, 4, 100);
    narrow.panels[1].row_pitch_mm = 0.4;
    CHECK(reach(narrow) == Approx(0.1));
    CHECK(reach(helix_of(4, 4, 100, 1)) == Approx(0.1));
    CHECK(reach(points_of()) == Approx(0.125));
    DisplayDescription one = points_of();
    constexpr PointMm kPoint[] = {{1.0, 2.0, 3.0}};
    one.panels[0].columns = one.panels[0].rows = 1;
    one.points = kPoint;
    CHECK(reach(one) == 0.5);
}

TEST_CASE("light further than a quarter pitch from every sample is outside") {
    const DisplayDescription display = stack_of(4, 4, 4);  // the smallest pitch is 2 mm
    const sim::DisplaySamples samples(display);
    CHECK(samples.reach_mm() == 0.5);
    const glm::dvec3 sample(1.0, 1.5, 3.5);
    sim::LightField field;
    for (const double away : {0.0, 0.49, -0.49, 0.51, 1.0}) {
        field.flashes.push_back({sample + glm::dvec3(away, 0.0, 0.0), 1, 0});
    }
    field.flashes.push_back({{0.0, 0.0, 400.0}, 1, 0});
    CHECK(samples.rebuild(field).outside == 3);
}

TEST_CASE("columns at one place are one group") {
    // Offset-free panels back to back: column c of one is column 7 − c of the other half a turn later, and of itself.
    DisplayDescription display = rotor_of(8, 2, 6);
    for (Panel& panel : display.panels) panel.offset_mm = 0.0;
    const sim::DisplaySamples samples(display);
    CHECK(samples.group_count() == 24);
    std::vector<int> columns(samples.group_count());
    for (std::size_t column = 0; column < 96; ++column) ++columns[samples.group_of(column)];
    CHECK(columns == std::vector<int>(24, 4));
}

}  // namespace
}  // namespace xorvox
