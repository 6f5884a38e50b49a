// Faults on purpose, as a person would ask for them, and the gallery that shows each.
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/faults.h"
#include "tests/catch.h"
#include "tests/cli/process.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

const std::filesystem::path kRoot = XORVOX_SOURCE_DIR;

double lit(const std::vector<std::string>& arguments) {
    const std::string out = succeeds(arguments).out;
    return number(out.substr(out.find("\"light\": ")), "pixels_lit");
}

void refused(const std::vector<std::string>& arguments, const std::string& fragment) {
    const Outcome outcome = run_program(arguments);
    CAPTURE(arguments, outcome.out, outcome.err);
    CHECK(outcome.status == 2);
    CHECK(outcome.err.find('\n') == outcome.err.size() - 1);
    CHECK_THAT(outcome.err, Catch::Contains(fragment));
}

}  // namespace

TEST_CASE("a fault on the command line is in the light, one from a file as well, and several together") {
    const Folder folder;
    const std::string display = folder.file("rotor.toml", kSmallRotor);
    const std::vector<std::string> all{"pattern", display, "all", "--json"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.begin(), all.begin(), all.end());
        return more;
    };
    CHECK(lit(all) == 60 * 33 * 16);
    CHECK(lit(with({"--fault", "dead-row:row=3"})) == 60 * 33 * 15);
    CHECK(lit(with({"--fault", "dead-row:row=3", "--fault", "dead-row:row=4"})) == 60 * 33 * 14);
    const std::string file = folder.file("bench.toml", "[[fault]]\nkind = \"dead-row\"\nrow = 3\n");
    CHECK(lit(with({"--sim", file})) == 60 * 33 * 15);
    CHECK(lit(with({"--sim", file, "--fault", "dead-row:row=4"})) == 60 * 33 * 14);
    CHECK(number(succeeds(all).out, "light_outside") == 0);
    CHECK(number(succeeds(with({"--fault", "off-axis:mm=9"})).out, "light_outside") > 1000);
}

TEST_CASE("show and share take faults, and a stuck bit lights what nobody asked for") {
    const Folder folder;
    const std::string display = folder.file("rotor.toml", kSmallRotor);
    const std::string cube = folder.file("cube.obj", cube_obj(10.0));
    const std::vector<std::string> show{"show", cube, "--display", display, "--json"};
    std::vector<std::string> stuck = show;
    stuck.insert(stuck.end(), {"--fault", "stuck-bit:bit=7,value=1"});
    CHECK(lit(show) < 60 * 33 * 16);
    CHECK(lit(stuck) == 60 * 33 * 16);
    CHECK_THAT(succeeds({"share", "--help"}).out, Catch::Contains("--fault") && Catch::Contains("--sim"));
    CHECK_THAT(succeeds({"play", "--help"}).out, Catch::Contains("--fault") && Catch::Contains("--sim"));
}

TEST_CASE("a display at the other end of a link can have a fault") {
    const Folder folder;
    const std::string display = folder.file("rotor.toml", kSmallRotor);
    Background sim({"sim", "--display", display, "--listen", "tcp:0", "--fault", "dead-row:row=3"});
    const std::string listening = sim.line().value();
    const std::string address = listening.substr(listening.rfind(' ') + 1);
    succeeds({"pattern", display, "all", "--to", address});
    std::string line;
    while (line.find("pixels lit") == std::string::npos) line = sim.line().value();
    CHECK_THAT(line, Catch::Contains("29,700 pixels lit"));
}

TEST_CASE("packets that are lost are sent again, and where all are the command says so") {
    const Folder folder;
    const std::string display = folder.file("rotor.toml", kSmallRotor);
    CHECK(lit({"pattern", display, "all", "--json", "--fault", "lost-packets:part=0.2"}) == 60 * 33 * 16);
    const Outcome lossy =
        succeeds({"pattern", display, "lines", "--seconds", "2", "--json", "--fault", "lost-packets:part=0.1"});
    CHECK(number(lossy.out, "slots_missed") > 0);
    refused({"pattern", display, "all", "--fault", "lost-packets:part=1"}, "no answer from a display");
}

TEST_CASE("a rotor from a file turns the display: one that stands is told, one that trembles shows the picture") {
    const Folder folder;
    const std::string stalled = folder.file("stalled.toml", "[rotor]\nstall_s = 0\n");
    const std::string trembling = folder.file("trembling.toml", "seed = 3\n[rotor]\njitter = 0.02\n");
    refused({"pattern", "vortex", "index", "--sim", stalled}, "does it turn?");
    CHECK(lit({"pattern", "vortex", "index", "--json", "--sim", trembling}) > 1000);
}

TEST_CASE("faults that are none, cannot be, or have no display here are refused") {
    const Folder folder;
    const std::string display = folder.file("rotor.toml", kSmallRotor);
    const auto pattern = [&display](std::vector<std::string> more) {
        more.insert(more.begin(), {"pattern", display, "all"});
        return more;
    };
    refused(pattern({"--fault", "off-axs:mm=1"}),
            "--fault: unknown fault \"off-axs\"; the nearest one is \"off-axis\"");
    refused(pattern({"--fault", "off-axis:panel=0"}), "--fault: off-axis: the key mm is missing");
    refused(pattern({"--fault", "swapped-panels:panel=0,other=1"}), "it has one panel");
    refused(pattern({"--fault", "mirrored", "--to", "tcp:127.0.0.1:9"}), "needs --to loopback");
    refused(pattern({"--sim", folder.path("none.toml")}), "cannot open the file for --sim");
    refused(pattern({"--sim", folder.file("a.toml", "\n[[fault]]\nkind = 3\n")}), "a.toml: line 3: fault 1: kind: ");
    refused({"sim", "--display", display, "--listen", "tcp:0", "--fault", "tilted"}, "the key deg is missing");
    refused({"sim", "--display", display, "--listen", "tcp:0", "--fault", "row-order:line=0,other=1"},
            "its rows do not take turns");
}

TEST_CASE("every kind of fault has its command and its pictures in the gallery") {
    const std::string page = read_file((kRoot / "docs/bring-up.md").string());
    for (const sim::FaultKindInfo& info : sim::fault_kinds()) {
        const std::string kind(info.name);
        CAPTURE(kind);
        const std::size_t begin = page.find("\n### " + kind + "\n");
        REQUIRE(begin != std::string::npos);
        const std::string section = page.substr(begin, page.find("\n### ", begin + 1) - begin);
        CHECK_THAT(section, Catch::Contains("--fault " + kind) && Catch::Contains(" --png " + kind + ".png\n"));
        std::vector<std::string> pictures;
        for (std::size_t at = 0; (at = section.find("(images/", at)) != std::string::npos;) {
            pictures.push_back(section.substr(at + 1, section.find(')', at) - at - 1));
            ++at;
        }
        REQUIRE(pictures.size() == 2);
        CHECK(pictures[0] == "images/faults/" + kind + ".png");
        std::vector<std::string> bytes;
        for (const std::string& picture : pictures) bytes.push_back(read_file((kRoot / "docs" / picture).string()));
        CHECK(bytes[0] != bytes[1]);
    }
}

TEST_CASE("one command makes the pictures of the gallery") {
    const Folder folder;
    const std::string command =
        "'" + (kRoot / "tools/gallery.sh").string() + "' '" + XORVOX_PROGRAM + "' '" + folder.path("") + "' ";
    REQUIRE(std::system((command + "swapped-slices").c_str()) == 0);
    CHECK(folder.names() == std::vector<std::string>{"right-cube8-595-stairs.png", "swapped-slices.png"});
    CHECK(read_file(folder.path("swapped-slices.png")) != read_file(folder.path("right-cube8-595-stairs.png")));
    CHECK(std::system((command + "no-such-fault 2>/dev/null").c_str()) != 0);
}
