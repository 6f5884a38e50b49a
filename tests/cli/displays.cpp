// The commands `displays` and `validate`.
#include <string>
#include <string_view>

#include "driver/display/toml.h"
#include "tests/catch.h"
#include "tests/cli/process.h"

using namespace xorvox::test;
using Catch::Matchers::Contains;

namespace {

constexpr std::string_view kFine = R"(name = "mine"
kind = "helix"
format = "mono1"
slices = 4
cycles_per_second = 20
motion.stroke_mm = 30
panel = [{ columns = 4, rows = 4, column_pitch_mm = 1, row_pitch_mm = 1 }]
)";

constexpr std::string_view kWrong = R"(name = "mine"
kind = "helix"
format = "mono7"
slices = 0
cycles_per_second = 20
motion.stroke_mm = 30
panel = [{ columns = 4, rows = 4, column_pitch_mm = 1, row_pitch_mm = 1 }]
)";

}  // namespace

TEST_CASE("displays describes a preset in full and marks what is assumed", "[cli]") {
    const Outcome vortex = run_program({"displays", "vortex"});
    REQUIRE(vortex.status == 0);
    CHECK_THAT(vortex.out, Contains("vortex: two 128 x 64 LED panels") && Contains("panel 0\n") &&
                               Contains("panel 1\n") && Contains("5,898,240") && Contains("277.8 µs") &&
                               Contains("2 of 3"));
    const auto line_of = [&](std::string_view key) {
        const std::size_t at = vortex.out.find("  " + std::string(key) + " ");
        REQUIRE(at != std::string::npos);
        return vortex.out.substr(at, vortex.out.find('\n', at) - at);
    };
    CHECK_THAT(line_of("pixel_clock_hz"), Catch::EndsWith("assumed"));
    CHECK_THAT(line_of("offset_mm"), Catch::EndsWith("assumed"));
    CHECK_THAT(line_of("slices"), Catch::EndsWith("360"));
    CHECK_THAT(line_of("time of a slice"), Catch::EndsWith("277.8 µs"));
    CHECK_THAT(line_of("data rate"), Catch::EndsWith("58.98 MB/s raw"));
    CHECK_THAT(line_of("limit_ma"), Catch::EndsWith("none"));
    CHECK_THAT(run_program({"displays", "cube8-595"}).out,
               Contains("6.4 kB/s raw") && Contains("160 × 160 × 160 mm") && Contains("640 mA"));
    CHECK_THAT(run_program({"displays", "cube16-ws2812"}).out, Contains("time of a frame            16.67 ms"));
}

TEST_CASE("displays says of each preset how many values are assumed", "[cli]") {
    const std::string out = run_program({"displays"}).out;
    CHECK_THAT(out, Contains("24 slices a turn, 1 bit (10 values assumed)\n") && Contains("(3 values assumed)\n"));
}

TEST_CASE("displays says what light a code gives", "[cli]") {
    const Folder folder;
    std::string text(kFine);
    text += "light.response = \"gamma\"\n";
    const std::string file = folder.file("mine.toml", text);
    CHECK_THAT(run_program({"displays", file}).out, Contains("\nlight\n") &&
                                                        Contains("response                   gamma\n") &&
                                                        Contains("gamma                      2.2\n"));
    CHECK_THAT(run_program({"displays", file, "--json"}).out,
               Contains("\"light\": {\"response\": \"gamma\", \"gamma\": 2.2}"));
    CHECK_THAT(run_program({"displays", "vortex", "--json"}).out, Contains("\"light\": {\"response\": \"linear\"}"));
    CHECK_THAT(run_program({"displays", file, "--cpp"}).out, Contains("display.light.response = Response::Gamma;"));
}

TEST_CASE("what nobody knows of a display is null in JSON", "[cli]") {
    const std::string candle = run_program({"displays", "candle", "--json"}).out;
    CHECK_THAT(candle,
               Contains("\"limit_ma\": null") && Contains("\"pixel_clock_hz\": null") && Contains("\"led_ma\": 5"));
    CHECK_THAT(run_program({"displays", "depthcube", "--json"}).out,
               Contains("\"scan_time_ns\": null") && Contains("\"led_ma\": null"));
}

TEST_CASE("displays gives every preset as JSON and as C++", "[cli]") {
    for (const xorvox::Preset& preset : xorvox::presets()) {
        const std::string name(preset.name);
        INFO(name);
        CHECK_THAT(run_program({"displays", name, "--json"}).out,
                   Contains("\"name\": \"" + name + "\"") && Contains("\"assumed\": [\"") &&
                       Contains("\"geometry_digest\"") && Catch::EndsWith("}\n"));
        CHECK_THAT(run_program({"displays", name, "--cpp"}).out,
                   Contains("inline constexpr DisplayDescription k") && Contains("static_assert(geometry_digest("));
    }
    CHECK_THAT(run_program({"displays", "--json"}).out,
               Contains("{\"name\": \"vx1\"") && Contains("\"motion.profile\""));
}

TEST_CASE("displays refuses an unknown name with the presets", "[cli]") {
    const Outcome outcome = run_program({"displays", "vx2"});
    CHECK(outcome.status == 2);
    CHECK_THAT(outcome.err, Contains("unknown display \"vx2\"") && Contains("vortex, vx1"));
}

TEST_CASE("validate says what a display is when its file is fine", "[cli]") {
    const Folder folder;
    const std::string file = folder.file("mine.toml", std::string(kFine));
    const Outcome outcome = run_program({"validate", file});
    CHECK(outcome.status == 0);
    CHECK(outcome.err.empty());
    CHECK(outcome.out == file + ": fine: \"mine\", helix: 4 slices of mono1, 16 bytes a frame, 20 frames a second\n");
}

TEST_CASE("validate explains every mistake by its line and exits with 2", "[cli]") {
    const Folder folder;
    const std::string fine = folder.file("fine.toml", std::string(kFine));
    const std::string wrong = folder.file("wrong.toml", std::string(kWrong));
    const Outcome outcome = run_program({"validate", wrong, fine});
    CHECK(outcome.status == 2);
    CHECK_THAT(outcome.err, Contains(wrong + ": line 3: format: found the text \"mono7\"") &&
                                Contains(wrong + ": line 4: slices: found 0; allowed: a whole number from 1 to 4096"));
    CHECK_THAT(outcome.err,
               Catch::EndsWith(wrong + ": further mistakes may show once these are mended: what contradicts"
                                       " itself is looked for last\n"));
    CHECK_THAT(outcome.out, Contains(fine + ": fine"));

    const Outcome json = run_program({"validate", "--json", wrong, fine, folder.path("none.toml")});
    CHECK(json.status == 2);
    CHECK_THAT(json.out, Contains("\"valid\": false") && Contains("{\"line\": 3, \"message\": \"format: found") &&
                             Contains("\"valid\": true") && Contains("{\"line\": null, \"message\":"));
    CHECK_THAT(json.out, Contains("\"complete\": false, \"mistakes\": [{\"line\": 3") &&
                             Contains("\"complete\": true, \"mistakes\": []"));
}

TEST_CASE("validate has nothing to add where it has named what contradicts itself", "[cli]") {
    const Folder folder;
    std::string text(kFine);
    text += "power.limit_ma = 100\n";
    const std::string file = folder.file("mine.toml", text);
    const Outcome outcome = run_program({"validate", file});
    CHECK(outcome.status == 2);
    CHECK(outcome.err == "xorvox: " + file +
                             ": line 8: power.limit_ma: found 100, but it needs led_ma, or no current can be"
                             " reckoned\n");
}
