// A simulated display watched in time, as a person would: what --rotor, --fidelity, --exposure and the instruments do.
#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/cli/process.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

/// The small rotor on pins, with an index.
std::string panels_toml() {
    return kSmallRotor + R"(
[sync]
index = "pulses"

[scan]
driver = "hub75"
pixel_clock_hz = 20_000_000
latch_ns = 100
min_on_ns = 500
row_groups = 8
bit_planes = 2
)";
}

std::string in_time(const std::string& json) {
    const std::size_t at = json.find("\"in_time\": ");
    REQUIRE(at != std::string::npos);
    return json.substr(at + 11);
}

/// The same without what was asked for.
std::string measured(const std::string& json) {
    const std::string seen = in_time(json);
    return seen.substr(seen.find("\"exposure\": "));
}

void refused(const std::vector<std::string>& arguments, const std::string& fragment) {
    const Outcome outcome = run_program(arguments);
    CAPTURE(arguments, outcome.out, outcome.err);
    CHECK(outcome.status == 2);
    CHECK(outcome.err.find('\n') == outcome.err.size() - 1);
    CHECK_THAT(outcome.err, Catch::Contains(fragment));
}

struct Bench {
    Folder folder;
    std::string display = folder.file("panels.toml", panels_toml());
    std::string cube = folder.file("cube.obj", cube_obj(10.0));

    std::vector<std::string> show(const std::vector<std::string>& more) const {
        std::vector<std::string> all{"show", cube, "--display", display, "--json"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
};

}  // namespace

TEST_CASE("a display that is not watched in time says null, and one that is says what was lit of what was sent") {
    const Bench bench;
    CHECK(in_time(succeeds(bench.show({})).out).starts_with("null"));
    const std::string seen = in_time(succeeds(bench.show({"--fidelity", "strobes"})).out);
    CHECK(number(seen, "sent") > 1000);
    CHECK(number(seen, "lit") == number(seen, "sent"));
    CHECK(number(seen, "lost") == 0);
    CHECK(number(seen, "outside") == 0);
    CHECK(number(seen, "exposure_ms") == Approx(20.0));
}

TEST_CASE("strobes and edges see the same light, to the last digit that is told") {
    const Bench bench;
    for (const std::string rotor : {"speed=1", "jitter=0.01,missed=0.1,doubled=0.1,seed=5"}) {
        const std::string strobes = succeeds(bench.show({"--rotor", rotor, "--fidelity", "strobes"})).out;
        const std::string edges = succeeds(bench.show({"--rotor", rotor, "--fidelity", "edges"})).out;
        CHECK_THAT(in_time(strobes), Catch::StartsWith("{\"setup\": {\"fidelity\": \"strobes\""));
        CHECK_THAT(in_time(edges), Catch::StartsWith("{\"setup\": {\"fidelity\": \"edges\""));
        CHECK(measured(strobes) == measured(edges));
    }
}

TEST_CASE("a rotor that jitters is seen to stray, the same for a seed and otherwise for another one") {
    const Bench bench;
    const auto shaken = [&](const std::string& seed) {
        return succeeds(bench.show({"--rotor", "jitter=0.02,seed=" + seed})).out;
    };
    const double at_rest = number(in_time(succeeds(bench.show({"--rotor", "speed=1"})).out), "stray_mm");
    CHECK(number(in_time(shaken("1")), "stray_mm") > 1.05 * at_rest);
    CHECK(shaken("1") == shaken("1"));
    CHECK(measured(shaken("1")) != measured(shaken("2")));
    CHECK(measured(succeeds(bench.show({"--rotor", "jitter=0.02", "--seed", "2"})).out) == measured(shaken("2")));
}

TEST_CASE("a rotor that stops goes dark with a fault, and the shutter sees that it was less light") {
    const Bench bench;
    const std::string seen = in_time(succeeds(bench.show({"--rotor", "stall=0.5", "--exposure", "1"})).out);
    CHECK(number(seen, "exposure_ms") == Approx(1000.0));
    CHECK(number(seen, "light") < 0.6);
    CHECK(number(seen, "lost_index") + number(seen, "stall") >= 1);
}

TEST_CASE("the instruments write what they were asked for: trace, histogram, comparison") {
    const Bench bench;
    const std::string trace = bench.folder.path("pins.vcd");
    const std::string numbers = bench.folder.path("light.csv");
    const std::string chart = bench.folder.path("light.PNG");
    const std::string sides = bench.folder.path("sides.png");
    succeeds(bench.show({"--trace", trace, "--histogram", numbers}));
    succeeds(bench.show({"--histogram", chart, "--compare", sides, "--size", "96x96"}));
    CHECK(read_file(trace).starts_with("$version"));
    CHECK_THAT(read_file(trace), Catch::Contains("$var wire 1") && Catch::Contains("latch"));
    CHECK(read_file(numbers).starts_with("from,to,sent,lit\n"));
    CHECK(read_file(chart).substr(1, 3) == "PNG");
    CHECK(read_file(sides).substr(1, 3) == "PNG");
}

TEST_CASE("what cannot be watched is refused in one line, and leaves no file") {
    const Bench bench;
    const std::string trace = bench.folder.path("pins.vcd");
    const std::size_t files = bench.folder.names().size();
    refused(bench.show({"--rotor", "wobble=1"}), "--rotor: ");
    refused(bench.show({"--exposure", "61"}), "up to 60 s");
    refused(bench.show({"--trace", trace, "--fidelity", "strobes"}), "leave out one of them");
    refused(bench.show({"--histogram", "light.txt"}), ".csv");
    refused(bench.show({"--compare", "sides.gif"}), ".png");
    refused(bench.show({"--compare", "a.png", "--png", "a.png"}), "a.png is asked for twice");
    refused(bench.show({"--trace", bench.folder.path("nowhere/pins.vcd")}), "--trace");
    refused(bench.show({"--fidelity", "edges", "--to", "tcp:127.0.0.1:1"}), "--to loopback");
    refused({"show", bench.cube, "--display", "cube8-595", "--rotor", "stall=1"}, "at rest");
    refused({"show", bench.cube, "--display", "cube16-ws2812", "--trace", trace}, "cube16-ws2812");
    refused({"show", bench.cube, "--display", "vx1", "--fidelity", "edges"}, "vx1");
    CHECK(bench.folder.names().size() == files);
}

TEST_CASE("an exposure of what moves is of all its frames, from the first one on") {
    const Bench bench;
    const auto lit = [&](const std::string& exposure) {
        return number(succeeds({"play", bench.cube, "--display", bench.display, "--spin", "60", "--seconds", "0.5",
                                "--exposure", exposure, "--json"})
                          .out,
                      "pixels_lit");
    };
    CHECK(lit("0.4") > 1.05 * lit("0.02"));
}

TEST_CASE("a display of its own is watched from its first frame on") {
    const Bench bench;
    const std::string light = bench.folder.path("light.csv");
    Background sim({"sim", "--display", bench.display, "--listen", "tcp:0", "--exposure", "0.1", "--histogram", light});
    const std::string listening = sim.line().value();
    Background show(
        {"show", bench.cube, "--display", bench.display, "--to", listening.substr(listening.rfind(' ') + 1), "--hold"});
    std::string line;
    while (!line.starts_with("histogram")) line = sim.line().value();
    CHECK(read_file(light).starts_with("from,to,sent,lit\n"));
}

TEST_CASE("a display of its own tells, when it ends, what became of its frames") {
    const Bench bench;
    Background sim({"sim", "--display", bench.display, "--listen", "tcp:0", "--rotor", "jitter=0.01", "--json"});
    const std::string listening = sim.line().value();
    const std::size_t at = listening.find("tcp:");
    const std::string address = listening.substr(at, listening.find('"', at) - at);
    succeeds({"show", bench.cube, "--display", bench.display, "--to", address});
    REQUIRE(kill(sim.pid(), SIGTERM) == 0);
    std::string last;
    while (const auto line = sim.line()) last = *line;
    CHECK_THAT(last, Catch::Contains("\"event\": \"ended\""));
    CHECK(number(last, "presented") >= 1);
    CHECK(number(last, "torn") == 0);
}
