// show beyond one still: even light, resampling, and frames that follow each other; bench displays.
#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/cli/process.h"

using namespace xorvox::test;

namespace {

const std::string kDuck = std::string(XORVOX_SOURCE_DIR) + "/examples/duck.ply";

Outcome succeeds(const std::vector<std::string>& arguments) {
    Outcome outcome = run_program(arguments);
    CAPTURE(arguments, outcome.out, outcome.err);
    REQUIRE(outcome.status == 0);
    REQUIRE(outcome.err.empty());
    return outcome;
}

/// The number behind "key": in a JSON text.
double number(const std::string& json, const std::string& key) {
    const std::size_t at = json.find("\"" + key + "\": ");
    CAPTURE(json, key);
    REQUIRE(at != json.npos);
    return std::stod(json.substr(at + key.size() + 4));
}

/// A rotor that is small enough to be simulated in an instant.
const std::string kRotor = R"(
name = "small-rotor"
kind = "rotating-panel"
format = "rgb332"
slices = 60
cycles_per_second = 50

[[panel]]
columns = 33
rows = 16
column_pitch_mm = 2
row_pitch_mm = 2
)";

}  // namespace

TEST_CASE("uniform light leaves out what bright light shows twice, and is more even", "[cli]") {
    const Folder folder;
    const std::string rotor = folder.file("rotor.toml", kRotor);
    const std::string bright = succeeds({"show", kDuck, "--display", rotor, "--json"}).out;
    const std::string uniform = succeeds({"show", kDuck, "--display", rotor, "--light", "uniform", "--json"}).out;
    CHECK(number(uniform, "inside") == number(bright, "inside"));
    CHECK(number(uniform, "pixels_lit") < 0.9 * number(bright, "pixels_lit"));
    CHECK(number(uniform, "pixels_lit") > 0.1 * number(bright, "pixels_lit"));
    CHECK(number(uniform, "light_outside") == 0);
}

TEST_CASE("a model that is sampled from a grid of cubes is not quite the model on the display's own samples", "[cli]") {
    const Folder folder;
    const std::string rotor = folder.file("rotor.toml", kRotor);
    const double native = number(succeeds({"show", kDuck, "--display", rotor, "--json"}).out, "inside");
    const double sampled =
        number(succeeds({"show", kDuck, "--display", rotor, "--sampling", "cartesian", "--json"}).out, "inside");
    CHECK(sampled != native);
    CHECK(sampled == Approx(native).epsilon(0.2));
    // On a cube of LEDs both are the same.
    const std::string cube = succeeds({"show", kDuck, "--display", "cube16-ws2812", "--json"}).out;
    CHECK(succeeds({"show", kDuck, "--display", "cube16-ws2812", "--sampling", "cartesian", "--json"}).out == cube);
}

TEST_CASE("a model that turns is shown once a cycle, none late, in simulated time", "[cli]") {
    const Folder folder;
    const std::string rotor = folder.file("rotor.toml", kRotor);
    const std::string json =
        succeeds({"show", kDuck, "--display", rotor, "--spin", "30", "--seconds", "1", "--json"}).out;
    CHECK(number(json, "frames_presented") == Approx(50).margin(2));
    CHECK(number(json, "frames_late") == 0);
    CHECK(number(json, "frames_dropped") == 0);
    CHECK(number(json, "rate_hz") == Approx(50).epsilon(0.02));
    CHECK(number(json, "max") == 0);
    CHECK_THAT(json, Catch::Contains("\"simulated_time\": true"));
    const std::string text = succeeds({"show", kDuck, "--display", rotor, "--spin", "30", "--seconds", "0.2"}).out;
    CHECK_THAT(text, Catch::Contains("lateness: p50") && Catch::Contains("of simulated time"));
}

TEST_CASE("a model that turns reaches a display in another program, and every frame is accounted for", "[cli]") {
    const Folder folder;
    const std::string rotor = folder.file("rotor.toml", kRotor);
    Background display({"sim", "--display", rotor, "--listen", "tcp:0"});
    const std::string line = display.line().value_or("");
    const std::string address = line.substr(line.rfind("tcp:"));
    const std::string json =
        succeeds({"show", kDuck, "--display", rotor, "--spin", "30", "--seconds", "0.5", "--to", address, "--json"})
            .out;
    CHECK(number(json, "frames_presented") > 0);
    CHECK(number(json, "frames_sent") == number(json, "frames_presented") + number(json, "frames_given_up"));
    CHECK_THAT(json, Catch::Contains("\"simulated_time\": false"));
}

TEST_CASE("a model that turns into a file gives the same recording every time", "[cli]") {
    const Folder folder;
    const std::string rotor = folder.file("rotor.toml", kRotor);
    for (const std::string name : {"a", "b"}) {
        succeeds({"show", kDuck, "--display", rotor, "--spin", "30", "--seconds", "0.2", "--to",
                  "file:" + folder.path(name)});
    }
    CHECK(read_file(folder.path("a")) == read_file(folder.path("b")));
    CHECK(read_file(folder.path("a")).size() > 10'000);
}

TEST_CASE("a distant display tells how it is, and does what it is told", "[cli]") {
    Background display({"sim", "--display", "cube8-595", "--listen", "tcp:0"});
    const std::string line = display.line().value_or("");
    const std::string address = line.substr(line.rfind("tcp:"));
    const auto control = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"control", "--display", "cube8-595", "--to", address};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_program(arguments);
    };
    CHECK_THAT(control({}).out, Catch::Contains("no frame yet") && Catch::Contains("no fault"));
    succeeds({"show", kDuck, "--display", "cube8-595", "--to", address});
    const std::string told = control({"--brightness", "7", "--blank", "--watchdog", "0", "--json"}).out;
    CHECK(number(told, "brightness") == 7);
    CHECK(number(told, "watchdog_ms") == 0);
    CHECK(number(told, "frame") == 1);
    CHECK_THAT(told, Catch::Contains("\"blank\": true"));
    CHECK_THAT(control({"--light", "--clear-fault", "4", "--json"}).out, Catch::Contains("\"blank\": false"));
    CHECK(control({"--clear-fault", "0"}).status == 2);
    CHECK(control({"--clear-fault", "8"}).status == 2);
    CHECK(control({"--brightness", "256"}).status == 2);
    CHECK(control({"--blank", "--light"}).status == 2);
    CHECK(run_program({"control", "--display", "cube8-595", "--to", "file:x"}).status == 2);
}

TEST_CASE("a display whose host fell silent says so, and the next host clears that fault", "[cli]") {
    Background display({"sim", "--display", "cube8-595", "--listen", "tcp:0"});
    const std::string line = display.line().value_or("");
    const std::string address = line.substr(line.rfind("tcp:"));
    succeeds({"control", "--display", "cube8-595", "--to", address, "--watchdog", "20"});
    succeeds({"show", kDuck, "--display", "cube8-595", "--to", address});
    std::string said;
    while (said.find("dark: the host fell silent") == said.npos) {
        const std::optional<std::string> more = display.line();
        REQUIRE(more.has_value());
        said = *more;
    }
    CHECK_THAT(succeeds({"control", "--display", "cube8-595", "--to", address}).out, Catch::Contains("no fault"));
}

TEST_CASE("bench displays tells headroom and resampling for each display", "[cli]") {
    const Folder folder;
    const std::string rotor = folder.file("rotor.toml", kRotor);
    const std::string json =
        succeeds({"bench", "displays", kDuck, "--display", rotor, "--display", "cube16-ws2812", "--quick", "--json"})
            .out;
    CHECK(number(json, "headroom") > 0);
    CHECK(number(json, "samples_per_second") > 0);
    CHECK_THAT(json, Catch::Contains("\"small-rotor\"") && Catch::Contains("\"cube16-ws2812\""));
    const std::string text = succeeds({"bench", "displays", kDuck, "--display", rotor, "--quick"}).out;
    CHECK_THAT(text, Catch::Contains("headroom") && Catch::Contains("wrong"));
}

TEST_CASE("options of show that do not go together are refused", "[cli]") {
    const auto refused = [](const std::vector<std::string>& more, const std::string& why) {
        std::vector<std::string> arguments{"show", kDuck, "--display", "cube16-ws2812"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = run_program(arguments);
        CAPTURE(outcome.err);
        CHECK(outcome.status == 2);
        CHECK_THAT(outcome.err, Catch::Contains(why));
    };
    refused({"--seconds", "3"}, "--spin");
    refused({"--spin", "0"}, "above zero");
    refused({"--spin", "fast"}, "'fast'");
    refused({"--light", "dim"}, "dim");
    refused({"--sampling", "polar"}, "polar");
}
