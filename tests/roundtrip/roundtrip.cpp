// What lit up equals the voxels sent: rebuilt from the places of the light, which the simulator works out on its own.
#include <string>
#include <vector>

#include "driver/display/lattice.h"
#include "driver/display/toml.h"
#include "tests/catch.h"
#include "tests/roundtrip/rig.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

constexpr PixelFormat kFormats[] = {PixelFormat::Mono1, PixelFormat::Rgb111, PixelFormat::Rgb332, PixelFormat::Rgb565,
                                    PixelFormat::Rgb888};

/// Rows that end within a byte, no symmetry, and every pose in use.
DisplayDescription odd_stack() {
    DisplayDescription display;
    display.name = std::string_view("odd-stack");
    display.slices = 7;
    display.plane_pitch_mm = 4.0;
    display.cycles_per_second = 50.0;
    display.panels[0].columns = 13;
    display.panels[0].rows = 9;
    display.panels[0].column_pitch_mm = 2.5;
    display.panels[0].row_pitch_mm = 3.0;
    return display;
}

DisplayDescription odd_rotor(bool clockwise) {
    DisplayDescription display;
    display.name = std::string_view("odd-rotor");
    display.kind = DisplayKind::RotatingPanel;
    display.slices = 50;
    display.cycles_per_second = 15.0;
    display.clockwise = clockwise;
    display.panel_count = 2;
    for (std::uint32_t p = 0; p < 2; ++p) {
        Panel& panel = display.panels[p];
        panel.columns = 21;
        panel.rows = 11;
        panel.column_pitch_mm = 2.0;
        panel.row_pitch_mm = 3.0;
        panel.offset_mm = 0.7;
        panel.shift_mm = 0.5;
        panel.angle_deg = 180.0 * p;
    }
    return display;
}

std::vector<DisplayDescription> displays() {
    std::vector<DisplayDescription> all{odd_stack(), odd_rotor(false), odd_rotor(true)};
    for (const Preset& preset : presets()) all.push_back(*load_display(std::string(preset.name)));
    return all;
}

void shows_what_was_voxelized(Rig::Over over) {
    for (DisplayDescription display : displays()) {
        const sim::DisplaySamples samples(display);
        for (const PixelFormat format : kFormats) {
            display.format = format;
            CAPTURE(std::string(display.name.view()), std::string(to_string(format)));
            const Picture picture = paint(display, lopsided(0));
            REQUIRE(picture.volume.count() > samples.size() / 50);
            Rig rig(display, over);
            REQUIRE(rig.show(picture.frame));
            const sim::Rebuilt rebuilt = samples.rebuild(rig.light());
            CHECK(rebuilt.outside == 0);
            CHECK((rebuilt == samples.faithful(picture.codes)));
        }
    }
}

}  // namespace

TEST_CASE("what lights up over loopback equals what was voxelized, for every display and format", "[roundtrip]") {
    shows_what_was_voxelized(Rig::Over::Loopback);
}

TEST_CASE("what lights up over tcp equals what was voxelized, for every display and format", "[roundtrip]") {
    shows_what_was_voxelized(Rig::Over::Tcp);
}

TEST_CASE("light has the colour that was asked for", "[roundtrip]") {
    DisplayDescription display = odd_stack();
    display.format = PixelFormat::Rgb888;
    const Picture picture = paint(display, lopsided(0));
    Rig rig(display, Rig::Over::Loopback);
    REQUIRE(rig.show(picture.frame));
    const DisplayExtent room = extent(display);
    const sim::LightField light = rig.light();
    REQUIRE_FALSE(light.flashes.empty());
    for (const sim::Flash& flash : light.flashes) {
        const glm::vec3 asked = Octants::color(glm::vec3((flash.place_mm - room.lower) / (room.upper - room.lower)));
        for (int channel = 0; channel < 3; ++channel)
            CHECK(flash.light[channel] == Approx(asked[channel]).margin(0.002));
    }
}

namespace {

struct NamedFault {
    const char* name;
    double transport::FaultOptions::*probability;
    std::uint64_t transport::FaultCounts::*count;
};

constexpr NamedFault kFaults[] = {
    {"drop", &transport::FaultOptions::drop, &transport::FaultCounts::dropped},
    {"repeat", &transport::FaultOptions::repeat, &transport::FaultCounts::repeated},
    {"reorder", &transport::FaultOptions::reorder, &transport::FaultCounts::reordered},
    {"cut", &transport::FaultOptions::cut, &transport::FaultCounts::cut},
    {"flip", &transport::FaultOptions::flip, &transport::FaultCounts::flipped},
};

/// Three frames, one after the other, over a link with one kind of fault. What is shown is always one of them, whole,
/// and in the end the last one. Gives the number of faults that were put in.
std::uint64_t survives(const DisplayDescription& display, const sim::DisplaySamples& samples, Rig::Over over,
                       const std::vector<Picture>& pictures, const NamedFault& fault) {
    transport::FaultOptions options;
    // A frame is taken whole or not at all. One of the large displays has hundreds of packets, one of the small ones
    // four.
    options.*fault.probability = frame_bytes(display) > 1'000'000 ? 0.005 : 0.25;
    options.seed = 7;
    Rig rig(display, over, options);
    for (const Picture& picture : pictures) {
        const bool shown = rig.show(picture.frame);
        INFO("session: " << rig.session().error().message);
        REQUIRE(shown);
        CHECK((samples.rebuild(rig.light()) == samples.faithful(picture.codes)));
    }
    CHECK(rig.whole());
    return rig.faults().*fault.count;
}

void survives_faults(Rig::Over over) {
    std::uint64_t faults[std::size(kFaults)] = {};
    for (DisplayDescription display : displays()) {
        const sim::DisplaySamples samples(display);
        for (const PixelFormat format : kFormats) {
            display.format = format;
            std::vector<Picture> pictures;
            for (const std::uint32_t turn : {0u, 1u, 2u}) pictures.push_back(paint(display, lopsided(turn)));
            for (std::size_t f = 0; f < std::size(kFaults); ++f) {
                CAPTURE(std::string(display.name.view()), std::string(to_string(format)), kFaults[f].name);
                faults[f] += survives(display, samples, over, pictures, kFaults[f]);
            }
        }
    }
    for (std::size_t f = 0; f < std::size(kFaults); ++f) {
        CAPTURE(kFaults[f].name);
        CHECK(faults[f] > 20);
    }
}

}  // namespace

TEST_CASE("under every fault of a loopback link the display shows whole frames only, and recovers",
          "[roundtrip][faults]") {
    survives_faults(Rig::Over::Loopback);
}

TEST_CASE("under every fault of a tcp link the display shows whole frames only, and recovers", "[roundtrip][faults]") {
    survives_faults(Rig::Over::Tcp);
}

TEST_CASE("a display that is put together wrongly does not show what was voxelized", "[roundtrip][misbuild]") {
    for (DisplayDescription display : displays()) {
        display.format = PixelFormat::Rgb332;
        const sim::DisplaySamples samples(display);
        const Picture picture = paint(display, lopsided(0));
        const auto rebuilt_with = [&](const sim::Misbuild& misbuild) {
            Rig rig(display, Rig::Over::Loopback, {}, misbuild);
            REQUIRE(rig.show(picture.frame));
            return samples.rebuild(rig.light());
        };
        CAPTURE(std::string(display.name.view()));
        const sim::Rebuilt truth = samples.faithful(picture.codes);
        const std::int32_t slices = static_cast<std::int32_t>(display.slices);
        CHECK((rebuilt_with({}) == truth));
        CHECK_FALSE((rebuilt_with({.swap_a = slices / 4, .swap_b = slices / 2}) == truth));
        CHECK_FALSE((rebuilt_with({.mirrored_panel = 0}) == truth));
        CHECK_FALSE((rebuilt_with({.phase_slices = 1}) == truth));
    }
}
