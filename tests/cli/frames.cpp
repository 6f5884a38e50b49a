// show beyond one still: even light, resampling, and frames that follow each other; bench displays.
#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/cli/process.h"

using namespace xorvox::test;

namespace {

const std::string kDuck = std::string(XORVOX_SOURCE_DIR) + "/examples/duck.ply";

}  // namespace

TEST_CASE("uniform light leaves out what bright light shows twice, and is more even", "[cli]") {
    const Folder folder;
    const std::string rotor = folder.file("rotor.toml", kSmallRotor);
    const std::string bright = succeeds({"show", kDuck, "--display", rotor, "--json"}).out;
    const std::string uniform = succeeds({"show", kDuck, "--display", rotor, "--light", "uniform", "--json"}).out;
    CHECK(number(uniform, "inside") == number(bright, "inside"));
    CHECK(number(uniform, "pixels_lit") < 0.9 * number(bright, "pixels_lit"));
    CHECK(number(uniform, "pixels_lit") > 0.1 * number(bright, "pixels_lit"));
    CHECK(number(uniform, "light_outside") == 0);
}

TEST_CASE("a model that is sampled from a grid of cubes is not quite the model on the display's own samples", "[cli]") {
    const Folder folder;
    const std::string rotor = folder.file("rotor.toml", kSmallRotor);
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
    const std::string rotor = folder.file("rotor.toml", kSmallRotor);
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
    const std::string rotor = folder.file("rotor.toml", kSmallRotor);
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

TEST_CASE("a display that leaves in the middle of a stream costs the rest, not the figures", "[cli]") {
    Background display({"sim", "--display", "cube8-595", "--listen", "tcp:0"});
    const std::string line = display.line().value_or("");
    const std::string address = line.substr(line.rfind("tcp:"));
    Background host({"show", kDuck, "--display", "cube8-595", "--spin", "30", "--seconds", "60", "--to", address});
    // Any three: where time is short a display passes frames over.
    for (int shown = 0; shown < 3;) {
        const std::optional<std::string> said = display.line();
        REQUIRE(said);
        if (said->starts_with("frame ")) ++shown;
    }
    CHECK(display.terminate() == 0);
    std::string figures;
    while (const std::optional<std::string> more = host.line()) figures += *more + "\n";
    CHECK_THAT(figures,
               Catch::Contains("inside at the end") && Catch::Contains("sent: ") && Catch::Contains("lateness: "));
    CHECK(host.terminate() == 2);
}

TEST_CASE("a model that turns into a file gives the same recording every time", "[cli]") {
    const Folder folder;
    const std::string rotor = folder.file("rotor.toml", kSmallRotor);
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

TEST_CASE("a display whose host fell silent says so when it is asked, and lights again for a host", "[cli]") {
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
    const std::string asked = succeeds({"control", "--display", "cube8-595", "--to", address}).out;
    CHECK_THAT(asked, Catch::Contains("fault 1: its host fell silent") && Catch::Contains("but is dark"));
    CHECK_THAT(succeeds({"control", "--display", "cube8-595", "--to", address, "--light", "--watchdog", "0"}).out,
               Catch::Contains("no fault"));
}

TEST_CASE("a display that is built otherwise than its file says shows its light elsewhere", "[cli]") {
    const Folder folder;
    const std::string rotor = folder.file("rotor.toml", kSmallRotor);
    const std::string mirrored = folder.file("mirrored.toml", kSmallRotor + "mirrored = true\nlift_mm = 7\n");
    const auto picture = [&](const std::string& name, const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"pattern", rotor,     "orientation", "--view",          "orthographic",
                                           "--frame", "display", "--png",       folder.path(name), "--json"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return succeeds(arguments).out;
    };
    const std::string right = picture("right.png", {});
    CHECK(picture("same.png", {"--built", rotor}).size() == right.size() - 1);
    const std::string wrong = picture("wrong.png", {"--built", mirrored});
    CHECK(read_file(folder.path("right.png")) == read_file(folder.path("same.png")));
    CHECK(read_file(folder.path("right.png")) != read_file(folder.path("wrong.png")));
    // The frame is the file's; the light is measured on what is built.
    CHECK(number(wrong, "pixels_lit") == number(right, "pixels_lit"));
    CHECK(number(wrong, "light_outside") == 0);
    // What moves takes it as well.
    const std::vector<std::string> spin{"show", kDuck,       "--display", rotor,   "--spin",
                                        "30",   "--seconds", "0.1",       "--json"};
    std::vector<std::string> as_built = spin;
    as_built.insert(as_built.end(), {"--built", mirrored});
    CHECK(number(succeeds(as_built).out, "light_outside") == 0);
}

TEST_CASE("a display that cannot be built as --built says is refused", "[cli]") {
    const Folder folder;
    const std::string rotor = folder.file("rotor.toml", kSmallRotor);
    const std::string points = folder.file("points.toml", R"(
name = "points"
kind = "free-points"
format = "rgb332"
cycles_per_second = 50
points = [[0, 0, 0], [30, 0, 0], [0, 30, 30]]

[[panel]]
columns = 3
rows = 1
)");
    const auto refused = [&](const std::vector<std::string>& more, const std::string& why) {
        std::vector<std::string> arguments{"show", kDuck, "--display", rotor};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = run_program(arguments);
        CAPTURE(outcome.err);
        CHECK(outcome.status == 2);
        CHECK_THAT(outcome.err, Catch::Contains(why));
    };
    refused({"--built", "cube8-595"}, "small-rotor cannot really be built like cube8-595: another kind");
    refused({"--built", "nothing"}, "--built: ");
    refused({"--built", rotor, "--to", "file:" + folder.path("out")}, "--to loopback");
    refused({"--frame", "display"}, "--png");
    refused({"--frame", "room", "--png", folder.path("x.png")}, "room");
    CHECK(folder.names() == std::vector<std::string>{"points.toml", "rotor.toml"});
    // Points that are borrowed from a file live as long as its display.
    const Outcome moved = run_program({"pattern", points, "all", "--built", points, "--json"});
    CAPTURE(moved.err);
    CHECK(moved.status == 0);
    CHECK(number(moved.out, "voxels_lit") == 3);
}

TEST_CASE("bench displays tells headroom and resampling for each display", "[cli]") {
    const Folder folder;
    const std::string rotor = folder.file("rotor.toml", kSmallRotor);
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
