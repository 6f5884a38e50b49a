// What is lit is what was voxelized through every correction of light: mode × dithering × response × white ×
// brightness, in every pixel format.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "driver/host/calibration.h"
#include "driver/host/dither.h"
#include "driver/host/slice_map.h"
#include "driver/host/slices.h"
#include "tests/catch.h"
#include "tests/roundtrip/displays.h"
#include "tests/roundtrip/rig.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

constexpr std::array kModes{host::LightMode::Bright, host::LightMode::Uniform, host::LightMode::Even};
constexpr std::array kResponses{Light{Response::Linear, 2.2}, Light{Response::Gamma, 2.2}, Light{Response::Gamma, 4.0},
                                Light{Response::Srgb, 2.2}, Light{Response::Cie1931, 2.2}};

/// One of every kind, and the rotors whose samples crowd in different ways.
std::vector<DisplayFile> kinds() {
    constexpr std::array<std::string_view, 7> kNames{"uneven-stack", "sine",   "helix-2",         "points",
                                                     "odd-rotor",    "lifted", "turned-1-leaning"};
    std::vector<DisplayFile> chosen;
    for (DisplayFile& display : odd_displays()) {
        if (std::ranges::find(kNames, display.name.view()) != kNames.end()) chosen.push_back(std::move(display));
    }
    REQUIRE(chosen.size() == kNames.size());
    return chosen;
}

host::Calibration dim_led(const DisplayDescription& display) {
    const std::string unit = display.kind == DisplayKind::StackedPlanes ? "plane" : "panel";
    return host::Calibration::parse(unit + ",row,column,red,green,blue\n0,4,5,0.5,0.7,0.9\n0,5,6,0.9,0.6,1\n", display)
        .value();
}

/// The places of the samples that are to be lit, and how often each.
std::vector<std::uint64_t> places_of(const sim::DisplaySamples& samples, ConstBitVolumeView volume) {
    std::vector<std::uint64_t> places;
    for (std::uint32_t k = 0; k < volume.nz; ++k) {
        for (std::uint32_t y = 0; y < volume.ny; ++y) {
            for (std::uint32_t x = 0; x < volume.nx; ++x) {
                if (!volume.test(x, y, k)) continue;
                places.push_back(samples.place_of((std::uint64_t{k} * volume.ny + y) * volume.nx + x));
            }
        }
    }
    std::ranges::sort(places);
    return places;
}

/// The places of the flashes in the simulator.
std::vector<std::uint64_t> places_lit(const sim::DisplaySamples& samples, Rig& rig) {
    const sim::Rebuilt rebuilt = samples.rebuild(rig.light());
    REQUIRE(rebuilt.outside == 0);
    std::vector<std::uint64_t> places;
    for (const sim::SeenPlace& place : rebuilt.places) places.insert(places.end(), place.visits, place.sample);
    std::ranges::sort(places);
    return places;
}

BitVolume allowed(const DisplayDescription& display, host::LightMode mode, const Picture& picture) {
    BitVolume volume(DisplayLattice(display).view());
    std::ranges::copy(picture.volume.view().words, volume.view().words.begin());
    if (mode == host::LightMode::Uniform) {
        const DisplayLattice lattice(display);
        REQUIRE(host::SliceMap(display, lattice).thin(volume.view()) == Status::Ok);
    }
    return volume;
}

}  // namespace

TEST_CASE("what lights up equals what was voxelized, through every correction, in every format", "[roundtrip]") {
    for (const DisplayFile& native : kinds()) {
        const sim::DisplaySamples samples(native);
        for (const PixelFormat format : kPixelFormats) {
            DisplayFile display = in_format(native, format);
            const host::Calibration calibration = dim_led(display);
            const Picture picture = paint(display, lopsided(0));
            for (const host::LightMode mode : kModes) {
                const std::vector<std::uint64_t> truth = places_of(samples, allowed(display, mode, picture).view());
                REQUIRE(truth.size() > 50);
                for (const Light& response : kResponses) {
                    display.light = response;
                    display.scan.bit_planes = response.response == Response::Gamma ? std::uint8_t{1} : std::uint8_t{0};
                    CAPTURE(std::string(display.name.view()), std::string(to_string(format)), static_cast<int>(mode),
                            static_cast<int>(response.response));
                    Rig rig(display, Rig::Over::Loopback);
                    for (const float brightness : {1.0f, 0.04f}) {
                        host::LightSettings settings{.mode = mode,
                                                     .brightness = brightness,
                                                     .white = {1.0f, 0.7f, 0.4f},
                                                     .calibration = &calibration};
                        std::vector<std::byte> frame(frame_bytes(display));
                        const host::FramePainter exact(display, settings);
                        REQUIRE(exact.paint(picture.volume.view(), Octants(), frame) == Status::Ok);
                        REQUIRE(rig.show(frame));
                        CHECK((places_lit(samples, rig) == truth));

                        settings.dither = host::Dither::Ordered;
                        const host::FramePainter dithered(display, settings);
                        REQUIRE(dithered.paint(picture.volume.view(), Octants(), frame) == Status::Ok);
                        REQUIRE(rig.show(frame));
                        const std::vector<std::uint64_t> lit = places_lit(samples, rig);
                        CHECK(std::ranges::includes(truth, lit));
                    }
                }
            }
        }
    }
}

TEST_CASE("in the frames of one period of temporal dithering every set voxel is lit, and nothing else ever",
          "[roundtrip]") {
    std::size_t which = 0;
    for (const DisplayFile& native : kinds()) {
        const sim::DisplaySamples samples(native);
        for (const PixelFormat format : kPixelFormats) {
            DisplayFile display = in_format(native, format);
            const host::Calibration calibration = dim_led(display);
            display.light = kResponses[which % kResponses.size()];
            const host::LightMode mode = kModes[which++ % kModes.size()];
            CAPTURE(std::string(display.name.view()), std::string(to_string(format)), static_cast<int>(mode));
            const Picture picture = paint(display, lopsided(0));
            const std::vector<std::uint64_t> truth = places_of(samples, allowed(display, mode, picture).view());
            const host::FramePainter painter(display, {.mode = mode,
                                                       .dither = host::Dither::Temporal,
                                                       .white = {1.0f, 0.9f, 0.8f},
                                                       .calibration = &calibration});
            Rig rig(display, Rig::Over::Loopback);
            std::set<std::uint64_t> ever;
            std::vector<std::byte> frame(frame_bytes(display));
            for (std::uint32_t number = 0; number < host::kDitherPeriod; ++number) {
                REQUIRE(painter.paint(picture.volume.view(), Octants(), frame, number) == Status::Ok);
                REQUIRE(rig.show(frame));
                const std::vector<std::uint64_t> lit = places_lit(samples, rig);
                REQUIRE(std::ranges::includes(truth, lit));
                ever.insert(lit.begin(), lit.end());
            }
            CHECK(ever == std::set<std::uint64_t>(truth.begin(), truth.end()));
        }
    }
}
