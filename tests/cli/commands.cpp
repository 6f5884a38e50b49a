// What the program does when everything is right.
#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/cli/process.h"

using namespace xorvox::test;

namespace {

const std::string kDuck = std::string(XORVOX_SOURCE_DIR) + "/examples/duck.ply";

}  // namespace

TEST_CASE("every subcommand has help with an example", "[cli]") {
    CHECK_THAT(succeeds({"--help"}).out, Catch::Contains("voxelize") && Catch::Contains("Examples"));
    for (const std::string command :
         {"info", "voxelize", "show", "sim", "displays", "validate", "plan", "pattern", "control"}) {
        CHECK_THAT(succeeds({command, "--help"}).out, Catch::Contains("xorvox " + command));
    }
    CHECK_THAT(succeeds({"--version"}).out, Catch::StartsWith("xorvox "));
}

TEST_CASE("displays lists one preset a line, name first, without a heading", "[cli]") {
    const std::string out = succeeds({"displays"}).out;
    CHECK(out.starts_with("candle "));
    CHECK_THAT(out, Catch::Contains("\nvortex "));
}

TEST_CASE("info tells what a cube is", "[cli]") {
    const Folder folder;
    const std::string out = succeeds({"info", folder.file("cube.obj", cube_obj(2.0)), "--json"}).out;
    CHECK_THAT(out, Catch::Contains("\"vertices\": 8") && Catch::Contains("\"open_edges\": 0") &&
                        Catch::Contains("\"volume\": 8"));
}

TEST_CASE("equal bits give equal files, wherever they are written", "[cli]") {
    const Folder here;
    const Folder there;
    for (const std::string name : {"a.nrrd", "a.binvox", "a.bits"}) {
        succeeds({"voxelize", kDuck, "--size", "20", "-o", here.path(name)});
        succeeds({"voxelize", kDuck, "--size", "20", "-o", there.path(name)});
        CHECK(read_file(here.path(name)) == read_file(there.path(name)));
        CHECK_FALSE(read_file(here.path(name)).empty());
    }
}

TEST_CASE("a unit cube on an explicit grid sets exactly its voxels", "[cli]") {
    const Folder folder;
    const Outcome outcome = succeeds({"voxelize", folder.file("cube.obj", cube_obj(4.0)), "--grid", "9,7,5", "--origin",
                                      "-1,-1,-1", "--pitch", "1,1,2", "-o", folder.path("cube.nrrd"), "--json"});
    CHECK_THAT(outcome.out, Catch::Contains("\"set\": 32"));
    const std::string file = read_file(folder.path("cube.nrrd"));
    const std::string voxels = file.substr(file.find("\n\n") + 2);
    REQUIRE(voxels.size() == 9 * 7 * 5);
    for (int z = 0; z < 5; ++z) {
        for (int y = 0; y < 7; ++y) {
            for (int x = 0; x < 9; ++x) {
                const bool inside = x >= 1 && x < 5 && y >= 1 && y < 5 && z < 2 ? true : false;
                CHECK((voxels[static_cast<std::size_t>((z * 7 + y) * 9 + x)] == 1) == inside);
            }
        }
    }
}

TEST_CASE("with --hold a display stays lit until the host is interrupted", "[cli]") {
    Background display({"sim", "--display", "cube16-ws2812", "--listen", "tcp:0"});
    const std::string listening = display.line().value_or("");
    const std::string address = listening.substr(listening.rfind("tcp:"));
    Background host({"show", kDuck, "--display", "cube16-ws2812", "--to", address, "--hold"});
    CHECK_THAT(host.line().value_or(""), Catch::Contains(address) && Catch::Contains("Ctrl-C"));
    CHECK(display.line() == "client connected");
    CHECK_THAT(display.line().value_or(""), Catch::Contains("pixels lit"));
    CHECK(host.terminate() == 0);
    CHECK(display.line() == "client disconnected");
    CHECK_THAT(display.line().value_or(""), Catch::Contains("dark"));
    CHECK(display.terminate() == 0);
}

TEST_CASE("a display that refreshes once in 100 seconds is waited for", "[cli]") {
    const Folder folder;
    const std::string slow =
        folder.file("slow.toml",
                    "name = \"slow\"\nkind = \"stacked-planes\"\nformat = \"mono1\"\nslices = 4\n"
                    "plane_pitch_mm = 1.0\ncycles_per_second = 0.01\n[[panel]]\ncolumns = 4\nrows = 4\n"
                    "column_pitch_mm = 1.0\nrow_pitch_mm = 1.0\n");
    const Outcome outcome = succeeds({"show", folder.file("cube.obj", cube_obj(1.0)), "--display", slow, "--json"});
    CHECK_THAT(outcome.out, Catch::Contains("\"pixels_lit\": 64"));
}

TEST_CASE("info writes JSON without infinities", "[cli]") {
    const Folder folder;
    const std::string out = succeeds({"info", folder.file("huge.obj", cube_obj(1e200)), "--json"}).out;
    CHECK_THAT(out, Catch::Contains("\"volume\": null"));
}

TEST_CASE("a frame recorded to a file is the same every time", "[cli]") {
    const Folder folder;
    succeeds({"show", kDuck, "--display", "cube16-ws2812", "--to", "file:" + folder.path("a.bin")});
    succeeds({"show", kDuck, "--display", "cube16-ws2812", "--to", "file:" + folder.path("b.bin")});
    CHECK(read_file(folder.path("a.bin")).size() > 100);
    CHECK(read_file(folder.path("a.bin")) == read_file(folder.path("b.bin")));
    CHECK(folder.names() == std::vector<std::string>{"a.bin", "b.bin"});
}

TEST_CASE("a picture is drawn without OpenGL", "[cli]") {
    const Folder folder;
    succeeds({"show", kDuck, "--display", "vortex", "--view", "orthographic", "--png", folder.path("duck.png")});
    CHECK(read_file(folder.path("duck.png")).starts_with("\x89PNG"));
}

TEST_CASE("sim serves one client after another and ends when it is told to", "[cli]") {
    Background display({"sim", "--display", "cube16-ws2812", "--listen", "tcp:0"});
    const std::string listening = display.line().value_or("");
    REQUIRE_THAT(listening, Catch::StartsWith("cube16-ws2812: listening on tcp:127.0.0.1:"));
    const std::string address = listening.substr(listening.rfind("tcp:"));
    for (int client = 0; client < 3; ++client) {
        succeeds({"show", kDuck, "--display", "cube16-ws2812", "--to", address});
        CHECK(display.line() == "client connected");
        CHECK_THAT(display.line().value_or(""), Catch::Contains("pixels lit"));
        CHECK(display.line() == "client disconnected");
    }
    const Outcome refused = run_program({"show", kDuck, "--display", "vortex", "--to", address});
    CHECK(refused.status == 2);
    CHECK_THAT(refused.err, Catch::Contains("cube16-ws2812") && Catch::Contains("vortex"));
    CHECK(display.terminate() == 0);
}
