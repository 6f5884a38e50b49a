// The command `uniformity`.
#include "tests/catch.h"
#include "tests/cli/process.h"

using namespace xorvox::test;
using Catch::Matchers::Contains;

TEST_CASE("uniformity measures presets and display files, as they come and corrected", "[cli]") {
    const Folder folder;
    const std::string file = folder.file("mine.toml", R"(name = "mine"
kind = "swept-plane"
format = "rgb888"
slices = 96
cycles_per_second = 20
motion = { stroke_mm = 30, profile = "sine" }
panel = [{ columns = 16, rows = 16, column_pitch_mm = 1, row_pitch_mm = 1 }]
)");
    const Outcome outcome = run_program({"uniformity", "candle", file, "--frames", "4"});
    REQUIRE(outcome.status == 0);
    const auto line_of = [&](const std::string& name) {
        const std::size_t at = outcome.out.find("\n" + name + " ");
        REQUIRE(at != std::string::npos);
        return outcome.out.substr(at + 1, outcome.out.find('\n', at + 1) - at - 1);
    };
    CHECK_THAT(outcome.out, Contains("over 4 frames"));
    CHECK_THAT(line_of("candle"), Contains("even when dithered: 1 bit a channel, whose first level is 1;"));
    CHECK_THAT(line_of("mine"), Catch::EndsWith("even when corrected"));
}

TEST_CASE("uniformity gives its numbers as JSON", "[cli]") {
    const Outcome outcome = run_program({"uniformity", "cube8-595", "--json", "--frames", "1"});
    REQUIRE(outcome.status == 0);
    CHECK_THAT(outcome.out, Contains("{\"display\": \"cube8-595\", \"samples\": 512, \"cells_a_side\": 2, \"cells\": 8,"
                                     " \"bright\": {\"ratio\": 1, ") &&
                                Contains("\"frames\": 1,") && Contains("\"even\": true}"));
}

TEST_CASE("uniformity refuses displays that there are not, and no frames", "[cli]") {
    const Outcome unknown = run_program({"uniformity", "vx2"});
    CHECK(unknown.status == 2);
    CHECK_THAT(unknown.err, Contains("unknown display \"vx2\""));
    CHECK(run_program({"uniformity", "candle", "--frames", "0"}).status == 2);
    CHECK(run_program({"uniformity", "candle", "--frames", "1025"}).status == 2);
}

TEST_CASE("uniformity refuses a display that does not fit into memory", "[cli]") {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    XORVOX_SKIP("a sanitizer's shadow memory does not fit into a limited address space");
#endif
    const Folder folder;
    const std::string huge = folder.file("huge.toml", R"(name = "huge"
kind = "stacked-planes"
format = "rgb888"
slices = 512
cycles_per_second = 20
plane_pitch_mm = 1
panel = [{ columns = 512, rows = 512, column_pitch_mm = 1, row_pitch_mm = 1 }]
)");
    const Outcome outcome = run_program({"uniformity", huge}, std::uint64_t{1} << 30);
    CHECK(outcome.status == 2);
    CHECK_THAT(outcome.err, Contains("the display huge needs ") && Contains("choose fewer voxels"));
}
