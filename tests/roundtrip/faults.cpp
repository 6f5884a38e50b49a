// Under faults of the link, what is shown is always a whole frame, and in the end the last one.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/roundtrip/displays.h"
#include "tests/roundtrip/rig.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

struct NamedFault {
    const char* name;
    double transport::FaultOptions::*probability;
    std::uint64_t transport::FaultCounts::*count;
};

constexpr std::array<NamedFault, 5> kFaults = {{
    {"drop", &transport::FaultOptions::drop, &transport::FaultCounts::dropped},
    {"repeat", &transport::FaultOptions::repeat, &transport::FaultCounts::repeated},
    {"reorder", &transport::FaultOptions::reorder, &transport::FaultCounts::reordered},
    {"cut", &transport::FaultOptions::cut, &transport::FaultCounts::cut},
    {"flip", &transport::FaultOptions::flip, &transport::FaultCounts::flipped},
}};

/// Three frames, one after the other, over a link with one kind of fault. Gives the number of faults that were put in.
std::uint64_t survives(const DisplayDescription& display, const std::vector<Picture>& pictures,
                       const std::vector<sim::Rebuilt>& truths, const sim::DisplaySamples& samples, Rig::Over over,
                       const NamedFault& fault) {
    transport::FaultOptions options;
    // A frame is taken whole or not at all. One of the large displays has hundreds of packets, one of the small ones
    // four.
    options.*fault.probability = frame_bytes(display) > 1'000'000 ? 0.005 : 0.25;
    options.seed = 7;
    Rig rig(display, over, options);
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        const bool shown = rig.show(pictures[i].frame);
        INFO("session: " << rig.session().error().message);
        REQUIRE(shown);
        CHECK((samples.rebuild(rig.light()) == truths[i]));
    }
    CHECK(rig.whole());
    return rig.faults().*fault.count;
}

void survives_faults(const std::vector<DisplayFile>& displays, Rig::Over over) {
    std::array<std::uint64_t, kFaults.size()> faults{};
    for (const DisplayFile& native : displays) {
        const sim::DisplaySamples samples(native);
        for (const PixelFormat format : kPixelFormats) {
            if (format != native.format && samples.size() > kMiddling) continue;
            const DisplayFile display = in_format(native, format);
            std::vector<Picture> pictures;
            std::vector<sim::Rebuilt> truths;
            for (const std::uint32_t turn : {0u, 1u, 2u}) {
                pictures.push_back(paint(display, lopsided(turn)));
                truths.push_back(samples.faithful(pictures.back().codes));
            }
            for (std::size_t f = 0; f < kFaults.size(); ++f) {
                CAPTURE(std::string(display.name.view()), std::string(to_string(format)), kFaults[f].name);
                faults[f] += survives(display, pictures, truths, samples, over, kFaults[f]);
            }
        }
    }
    for (std::size_t f = 0; f < kFaults.size(); ++f) {
        CAPTURE(kFaults[f].name);
        CHECK(faults[f] > 20);
    }
}

}  // namespace

TEST_CASE("under every fault of a loopback link odd displays show whole frames only, and recover",
          "[roundtrip][faults]") {
    survives_faults(odd_displays(), Rig::Over::Loopback);
}

TEST_CASE("under every fault of a loopback link presets show whole frames only, and recover", "[roundtrip][faults]") {
    survives_faults(small_presets(), Rig::Over::Loopback);
}

TEST_CASE("under every fault of a tcp link odd displays show whole frames only, and recover", "[roundtrip][faults]") {
    survives_faults(odd_displays(), Rig::Over::Tcp);
}

TEST_CASE("under every fault of a tcp link presets show whole frames only, and recover", "[roundtrip][faults]") {
    survives_faults(small_presets(), Rig::Over::Tcp);
}
