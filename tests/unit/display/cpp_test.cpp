#include "driver/display/cpp.h"

#include <string>
#include <string_view>
#include <vector>

#include "all.h"  // Made by write_cpp_displays.
#include "driver/display/toml.h"
#include "tests/catch.h"
#include "tests/unit/display/cpp_samples.h"

using namespace xorvox;
using Catch::Matchers::Contains;

namespace {

/// What kCompiled was made from.
std::vector<DisplayFile> sources() {
    std::vector<DisplayFile> all;
    for (const Preset& preset : presets()) all.push_back(parse_display(preset.text, preset.name).value());
    for (const char* sample : test::kCppSamples) all.push_back(parse_display(sample, "sample").value());
    return all;
}

}  // namespace

TEST_CASE("a description as C++ is what was read, field for field, when it is compiled") {
    const auto all = sources();
    REQUIRE(std::size(kCompiled) == all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        const DisplayDescription& compiled = *kCompiled[i];
        INFO(all[i].name.view());
        CHECK(compiled.name.text == all[i].name.text);
        CHECK(geometry_digest(compiled) == geometry_digest(all[i]));
        CHECK(validate_display(compiled));
        CHECK(to_cpp(compiled) == to_cpp(all[i]));
    }
}

TEST_CASE("what a description is driven with survives C++") {
    static_assert(displays::kKreisel.sync.index_pulses == 1024);
    const DisplayDescription& kreisel = displays::kKreisel;
    const DisplayFile source = parse_display(test::kCppSamples[0], "sample").value();
    CHECK(kreisel.cycles_per_second == 25.1);
    CHECK(kreisel.sync.index == IndexSource::Encoder);
    CHECK(kreisel.sync.index_phase == 0.1);
    CHECK(kreisel.sync.slowest_cycles_per_second == 20.5);
    CHECK(kreisel.sync.fastest_cycles_per_second == 30.5);
    CHECK(kreisel.scan.driver == DriverChip::Hub75);
    CHECK(kreisel.scan.pixel_clock_hz == 20000000);
    CHECK(kreisel.scan.latch_ns == 11);
    CHECK(kreisel.scan.min_on_ns == 112);
    CHECK(kreisel.scan.rise_ns == 13);
    CHECK(kreisel.scan.fall_ns == 14);
    CHECK(kreisel.scan.row_groups == 4);
    CHECK(kreisel.scan.bit_planes == 3);
    CHECK_FALSE(kreisel.scan.msb_first);
    CHECK(kreisel.scan.color_order == std::array{'g', 'b', 'r'});
    CHECK(kreisel.light.response == Response::Gamma);
    CHECK(kreisel.light.gamma == 1.85);
    CHECK(displays::kSwept.light.response == Response::Cie1931);
    CHECK(displays::kHelix.light.response == Response::Linear);
    CHECK(kreisel.power.led_ma == 1.5);
    CHECK(kreisel.power.max_duty == 0.3);
    CHECK(kreisel.power.limit_ma == 123.456);
    CHECK(kreisel.panels[0].connector == 7);
    CHECK(kreisel.panels[1].chain_position == 1);
    CHECK(displays::kSwept.scan.planes_per_frame == 24);
    CHECK(displays::kUneven.scan.layers_first);
    CHECK(displays::kDisplay.scan.strings == 2);
    CHECK(displays::kDisplay.scan.serpentine);
}

TEST_CASE("the variable's name is made of the display's words") {
    CHECK(cpp_name("vortex") == "kVortex");
    CHECK(cpp_name("cube16-ws2812") == "kCube16Ws2812");
    CHECK(cpp_name("8 x 8") == "k8X8");
    CHECK(cpp_name("--") == "kDisplay");
    CHECK(cpp_name("Würfel") == "kWRfel");
}

TEST_CASE("a name cannot break out of its text in C++") {
    DisplayFile display = parse_display(test::kCppSamples[1], "sample").value();
    display.name = DisplayName("\"; int x; // \n\\");
    CHECK_THAT(to_cpp(display), Contains(R"(DisplayName("\"; int x; // \012\\");)"));
    CHECK_THAT(to_cpp(display), Contains(R"(// The display "\"; int x; // \012\\". Written)"));
}

TEST_CASE("the check of a digest is left out where compilers would give up counting") {
    DisplayFile display = parse_display(test::kCppSamples[5], "sample").value();
    CHECK_THAT(to_cpp(display), Contains("static_assert"));
    const std::vector<PointMm> many(1001);
    display.points = many;
    CHECK_THAT(to_cpp(display), !Contains("static_assert"));
}
