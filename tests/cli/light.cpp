// show: the options of light, from the command line to what a simulated display lights.
#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/cli/process.h"

using namespace xorvox::test;

namespace {

const std::string kDuck = std::string(XORVOX_SOURCE_DIR) + "/examples/duck.ply";

std::vector<std::string> show(const std::string& display, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"show", kDuck, "--display", display, "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

std::string shown(const std::string& display, const std::vector<std::string>& more) {
    return succeeds(show(display, more)).out;
}

void refused(const std::string& display, const std::vector<std::string>& more, const std::string& why) {
    const Outcome outcome = run_program(show(display, more));
    CAPTURE(outcome.err);
    CHECK(outcome.status == 2);
    CHECK(outcome.out.empty());
    CHECK(std::ranges::count(outcome.err, '\n') == 1);
    CHECK_THAT(outcome.err, Catch::Contains(why));
}

/// The small rotor with a supply of 2 A.
const std::string kRotor = kSmallRotor + R"(
[power]
led_ma = 20
limit_ma = 2000
)";

}  // namespace

TEST_CASE("light is told as it was chosen", "[cli]") {
    CHECK_THAT(
        shown("cube16-ws2812", {}),
        Catch::Contains("\"light_settings\": {\"mode\": \"bright\", \"dither\": \"none\", \"brightness_percent\": "
                        "100, \"white\": [1.0000, 1.0000, 1.0000], \"calibration\": null}, \"dimmed_to\": 1.0000"));
    const Folder folder;
    const std::string leds = folder.file("leds.csv", "plane,row,column,red,green,blue\n3,4,5,0.5,0.5,0.5\n");
    CHECK_THAT(
        shown("cube16-ws2812", {"--light", "even", "--dither", "ordered", "--brightness", "12.5", "--white",
                                "1,0.9,0.25", "--calibration", leds}),
        Catch::Contains("\"light_settings\": {\"mode\": \"even\", \"dither\": \"ordered\", \"brightness_percent\": "
                        "12.5, \"white\": [1.0000, 0.9000, 0.2500], \"calibration\": \"" +
                        leds + "\"}"));
    CHECK_THAT(shown("cube16-ws2812", {"--white", "2700"}), Catch::Contains("\"white\": [1.0000, 0."));
}

TEST_CASE("without dithering every set voxel is lit at any brightness, with it a part of them", "[cli]") {
    const double inside = number(shown("cube16-ws2812", {}), "inside");
    CHECK(number(shown("cube16-ws2812", {"--brightness", "0.01"}), "pixels_lit") == inside);
    CHECK(number(shown("cube16-ws2812", {"--brightness", "0"}), "pixels_lit") == 0);
    const std::string half =
        shown("cube8-595", {"--color", "constant:white", "--brightness", "50", "--dither", "ordered"});
    CHECK(number(half, "pixels_lit") > 0.3 * number(half, "inside"));
    CHECK(number(half, "pixels_lit") < 0.7 * number(half, "inside"));
    CHECK(number(half, "light_outside") == 0);
}

TEST_CASE("temporal dithering is for what moves", "[cli]") {
    refused("cube8-595", {"--dither", "temporal"}, "--dither ordered, --spin RPM, or xorvox play");
    const std::string spun = shown("cube8-595", {"--dither", "temporal", "--spin", "30", "--seconds", "0.2"});
    CHECK_THAT(spun, Catch::Contains("\"dither\": \"temporal\""));
    CHECK(number(spun, "light_outside") == 0);
}

TEST_CASE("light is dimmed to what the supply of a display gives", "[cli]") {
    const Folder folder;
    const std::string rotor = folder.file("rotor.toml", kRotor);
    const std::string white = shown(rotor, {"--color", "constant:white"});
    CHECK(number(white, "dimmed_to") < 0.9);
    CHECK(number(white, "pixels_lit") == number(white, "inside"));
    CHECK(number(shown(rotor, {"--color", "constant:#200000"}), "dimmed_to") == 1.0);
    CHECK_THAT(succeeds({"show", kDuck, "--display", rotor, "--color", "constant:white"}).out,
               Catch::Contains("so that it draws no more than the 2000 mA of the display's supply"));
}

TEST_CASE("options of light that are wrong are refused in one line", "[cli]") {
    const Folder folder;
    refused("cube8-595", {"--light", "dim"}, "dim");
    refused("cube8-595", {"--dither", "random"}, "random");
    for (const char* brightness : {"-1", "100.5", "nan", "full", "1,2"}) {
        refused("cube8-595", {"--brightness", brightness}, "not a number from 0 to 100");
    }
    for (const char* white : {"1,1", "1,1,2", "1,1,-1", "1499", "15001", "warm", "nan,1,1"}) {
        refused("cube8-595", {"--white", white}, "as in 5000");
    }
    refused("cube8-595", {"--calibration", "/nonexistent/leds.csv"}, "leds.csv: cannot be opened");
    const std::string wrong = folder.file("wrong.csv", "plane,row,column,red,green,blue\n0,0,9,1,1,1\n");
    refused("cube8-595", {"--calibration", wrong}, "wrong.csv: line 2: column 9: the display has 8");
}
