// What lit up equals the voxels sent: rebuilt from the places of the light, which the simulator works out on its own.
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "driver/display/lattice.h"
#include "sim/faults.h"
#include "sim/pixel_light.h"
#include "tests/catch.h"
#include "tests/roundtrip/displays.h"
#include "tests/roundtrip/rig.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

void shows(const DisplayDescription& display, const sim::DisplaySamples& samples, const Picture& picture,
           Rig::Over over) {
    CAPTURE(std::string(display.name.view()), std::string(to_string(display.format)), over == Rig::Over::Tcp);
    Rig rig(display, over);
    REQUIRE(rig.show(picture.frame));
    const sim::Rebuilt rebuilt = samples.rebuild(rig.light());
    CHECK(rebuilt.outside == 0);
    CHECK((rebuilt == samples.faithful(picture.codes)));
}

void shows_in_every_format(const std::vector<DisplayFile>& displays) {
    for (const DisplayFile& native : displays) {
        const sim::DisplaySamples samples(native);
        for (const PixelFormat format : kPixelFormats) {
            const DisplayFile display = in_format(native, format);
            const Picture picture = paint(display, lopsided(0));
            REQUIRE(picture.codes.size() > samples.size() / 50);
            for (const Rig::Over over : {Rig::Over::Loopback, Rig::Over::Tcp}) shows(display, samples, picture, over);
        }
    }
}

/// Two slices of which one is lit where the other is not; of free points two points.
std::pair<std::uint32_t, std::uint32_t> unlike_slices(const DisplayDescription& display, const Picture& picture) {
    if (display.kind != DisplayKind::FreePoints) return {display.slices / 4, display.slices / 2};
    std::uint32_t dark = 0;
    while (std::ranges::count(picture.codes, std::uint64_t{dark}, &sim::SampleCode::sample) > 0) ++dark;
    return {static_cast<std::uint32_t>(picture.codes.front().sample), dark};
}

/// A fault of every kind that `display` can have, by more than a pitch where it is moved.
std::vector<sim::Fault> possible_faults(const DisplayDescription& display, const Picture& picture) {
    const auto [slice, other] = unlike_slices(display, picture);
    const Panel& panel = display.panels[0];
    const double mm = 2.6 * std::max(panel.column_pitch_mm, panel.row_pitch_mm);
    const std::uint32_t shown = sim::PixelLight(display).shown_bits();
    const auto highest_bit = static_cast<std::uint32_t>(std::bit_width(shown)) - 1;
    std::vector<sim::Fault> faults{
        {.kind = sim::FaultKind::OffAxis, .amount = mm},
        {.kind = sim::FaultKind::Shifted, .amount = mm},
        {.kind = sim::FaultKind::ShiftedPlane, .slice = other, .amount = mm},
        {.kind = sim::FaultKind::Tilted, .amount = 35.0},
        {.kind = sim::FaultKind::Mirrored},
        {.kind = sim::FaultKind::SwappedPanels, .other = 1},
        {.kind = sim::FaultKind::SwappedSlices, .slice = slice, .other = other},
        {.kind = sim::FaultKind::DeadRow, .row = panel.rows / 2u},
        {.kind = sim::FaultKind::StuckBit, .bit = highest_bit, .amount = 0.0},
        {.kind = sim::FaultKind::StuckBit, .bit = highest_bit, .amount = 1.0},
        {.kind = sim::FaultKind::RowOrder, .line = 0, .other = 1},
        {.kind = sim::FaultKind::Phase, .amount = 1.0},
    };
    std::erase_if(faults, [&](const sim::Fault& fault) { return !sim::check_faults(display, {{fault}}); });
    return faults;
}

void is_red_with_every_fault(const DisplayDescription& display, const sim::DisplaySamples& samples,
                             const Picture& picture) {
    CAPTURE(std::string(display.name.view()));
    const auto rebuilt_with = [&](const sim::Faults& faults) {
        Rig rig(display, Rig::Over::Loopback, {}, faults);
        REQUIRE(rig.show(picture.frame));
        return samples.rebuild(rig.light());
    };
    const sim::Rebuilt truth = samples.faithful(picture.codes);
    CHECK((rebuilt_with({}) == truth));
    const std::vector<sim::Fault> faults = possible_faults(display, picture);
    CHECK(faults.size() >= 6);
    for (const sim::Fault& fault : faults) {
        CAPTURE(std::string(sim::to_string(fault.kind)), fault.amount);
        CHECK_FALSE((rebuilt_with({{fault}}) == truth));
    }
    const double part = frame_bytes(display) > 1'000'000 ? 0.005 : 0.25;
    CHECK((rebuilt_with({{{.kind = sim::FaultKind::LostPackets, .amount = part}}}) == truth));
}

}  // namespace

TEST_CASE("what lights up equals what was voxelized: odd displays, every format, over loopback and tcp",
          "[roundtrip]") {
    shows_in_every_format(odd_displays());
}

TEST_CASE("what lights up equals what was voxelized: presets, every format, over loopback and tcp", "[roundtrip]") {
    shows_in_every_format(small_presets());
}

TEST_CASE("what lights up equals what was voxelized: the largest presets, in their own format", "[roundtrip]") {
    const std::vector<DisplayFile> displays = large_presets();
    CHECK(displays.size() == 3);
    for (const DisplayFile& display : displays) {
        const sim::DisplaySamples samples(display);
        const Picture picture = paint(display, hollow(0));
        REQUIRE(picture.codes.size() > samples.size() / 100);
        is_red_with_every_fault(display, samples, picture);
    }
}

TEST_CASE("what lights up in one colour equals what was voxelized", "[roundtrip]") {
    std::vector<DisplayFile> displays = odd_displays();
    std::ranges::move(small_presets(), std::back_inserter(displays));
    for (const DisplayFile& display : displays) {
        shows(display, sim::DisplaySamples(display), paint(display, lopsided(1), Plain()), Rig::Over::Loopback);
    }
}

TEST_CASE("a display with any fault does not show what was voxelized, but for packets that are lost and sent again",
          "[roundtrip][faults]") {
    std::vector<DisplayFile> displays = odd_displays();
    std::ranges::move(small_presets(), std::back_inserter(displays));
    for (const DisplayFile& display : displays) {
        is_red_with_every_fault(display, sim::DisplaySamples(display), paint(display, lopsided(0)));
    }
}

TEST_CASE("light has the colour that was asked for", "[roundtrip]") {
    for (DisplayFile display : odd_displays()) {
        CAPTURE(std::string(display.name.view()));
        display.format = PixelFormat::Rgb888;
        const Picture picture = paint(display, lopsided(0));
        Rig rig(display, Rig::Over::Loopback);
        REQUIRE(rig.show(picture.frame));
        const DisplayExtent room = extent(display);
        const sim::LightField light = rig.light();
        REQUIRE_FALSE(light.flashes.empty());
        for (const sim::Flash& flash : light.flashes) {
            const glm::vec3 asked =
                Octants::color(glm::vec3((flash.place_mm - room.lower) / (room.upper - room.lower)));
            for (int channel = 0; channel < 3; ++channel) {
                REQUIRE(light.light(flash)[channel] == Approx(asked[channel]).margin(0.002));
            }
        }
    }
}
