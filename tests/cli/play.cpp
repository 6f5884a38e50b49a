// play: keyframes, sequences of files, and what it says when nothing moves.
#include <cstdio>
#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/cli/process.h"
#include "tests/unit/io/glb.h"

using namespace xorvox::test;

namespace {

const std::string kDuck = std::string(XORVOX_SOURCE_DIR) + "/examples/duck.ply";

std::vector<std::string> with(std::vector<std::string> arguments, const std::vector<std::string>& more) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

std::string play_duck(const std::vector<std::string>& more) {
    return succeeds(with({"play", kDuck, "--display", "cube16-ws2812", "--json"}, more)).out;
}

void refused(const std::vector<std::string>& more, const std::string& message) {
    const Outcome outcome = run_program(with({"play", kDuck, "--display", "cube16-ws2812"}, more));
    CAPTURE(more, outcome.err);
    CHECK(outcome.status == 2);
    CHECK(outcome.out.empty());
    CHECK_THAT(outcome.err, Catch::Contains(message));
}

/// A box of 10 × 10 × `height`, standing on z = 0.
std::string box_obj(double height) {
    std::string obj = cube_obj(1.0);
    std::string tall;
    for (std::size_t at = 0; at < obj.size();) {
        const std::size_t end = obj.find('\n', at);
        std::string line = obj.substr(at, end - at);
        if (line.starts_with("v ")) {
            double x = 0, y = 0, z = 0;
            REQUIRE(std::sscanf(line.c_str(), "v %lf %lf %lf", &x, &y, &z) == 3);
            line = "v " + std::to_string(10 * x) + " " + std::to_string(10 * y) + " " + std::to_string(height * z);
        }
        tall += line + "\n";
        at = end + 1;
    }
    return tall;
}

}  // namespace

TEST_CASE("a model plays as long as its keyframes, a frame a cycle", "[cli]") {
    const std::string json = play_duck({"--motion", "at=0; at=0.5 turn=0,0,90"});
    CHECK(number(json, "frames_presented") == Approx(30).margin(2));
    CHECK(number(json, "frames_late") == 0);
    CHECK(number(json, "light_outside") == 0);
    CHECK(number(json, "inside") == number(json, "voxels_lit"));
}

TEST_CASE("a timeline file plays what typed keyframes play", "[cli]") {
    const Folder folder;
    const std::string file = folder.file("t.toml",
                                         "[[motion]]\nat = 0\n[[motion]]\nat = 0.2\nturn_deg = [0, 0, 90]\n"
                                         "[[camera]]\nat = 0\nzoom = 2\n");
    CHECK(play_duck({"--timeline", file}) ==
          play_duck({"--motion", "at=0; at=0.2 turn=0,0,90", "--camera", "at=0 zoom=2"}));
}

TEST_CASE("a model that a keyframe moves out of the display is gone", "[cli]") {
    const std::string json = play_duck({"--motion", "at=0 move=1000,0,0", "--seconds", "0.1"});
    CHECK(number(json, "inside") == 0);
    CHECK(number(json, "pixels_lit") == 0);
}

TEST_CASE("a camera that comes nearer shows less of the model, larger", "[cli]") {
    const double far = number(play_duck({"--camera", "at=0", "--seconds", "0.1"}), "inside");
    const double near = number(play_duck({"--camera", "at=0 zoom=2", "--seconds", "0.1"}), "inside");
    CHECK(near > 2 * far);
}

TEST_CASE("a half turn in four keyframed quarters is where a half turn is", "[cli]") {
    const std::string half = play_duck({"--motion", "at=0 turn=0,0,180", "--seconds", "0.1"});
    const std::string quarters =
        play_duck({"--motion", "at=0; at=0.01 turn=0,0,90; at=0.02 turn=0,0,180", "--seconds", "0.1"});
    CHECK(number(half, "inside") == number(quarters, "inside"));
    CHECK(number(half, "bytes_raw") == number(quarters, "bytes_raw"));
}

TEST_CASE("files that follow each other are shown in turn, in one scale", "[cli]") {
    const Folder folder;
    const std::string low = folder.file("low.obj", box_obj(5));
    const std::string high = folder.file("high.obj", box_obj(10));
    const auto inside = [&](const std::string& seconds) {
        return number(
            succeeds({"play", low, high, "--display", "cube16-ws2812", "--fps", "10", "--seconds", seconds, "--json"})
                .out,
            "inside");
    };
    const double shown_low = inside("0.1");
    const double shown_high = inside("0.2");
    CHECK(shown_high == Approx(2 * shown_low).epsilon(0.1));
    CHECK(inside("0.3") == shown_low);  // The sequence begins anew.
    const std::string json = succeeds({"play", low, high, "--display", "cube16-ws2812", "--fps", "10", "--json"}).out;
    CHECK(number(json, "frames_presented") == Approx(12).margin(1));
}

TEST_CASE("an animation of a file plays once, in its own time, and stays within the display", "[cli]") {
    const Folder folder;
    const std::string model = folder.file("slide.glb", moving_corner_glb());
    const auto play = [&](const std::vector<std::string>& more) {
        return succeeds(with({"play", model, "--display", "cube16-ws2812", "--json"}, more)).out;
    };
    const std::string whole = play({});
    CHECK(number(whole, "frames_presented") == Approx(120).margin(2));
    CHECK(number(whole, "inside") > 0);
    CHECK(play({"--animation", "slide"}) == whole);
    CHECK(play({"--animation", "0"}) == whole);
    // It is in the display at its beginning, too: both ends of its way fit.
    CHECK(number(play({"--seconds", "0.02"}), "inside") > 0);
    const Outcome unknown = run_program({"play", model, "--display", "cube16-ws2812", "--animation", "walk"});
    CHECK(unknown.status == 2);
    CHECK_THAT(unknown.err, Catch::Contains("slide.glb has no \"walk\"; it has 0 slide"));
}

TEST_CASE("volumes that follow each other are shown in turn", "[cli]") {
    const Folder folder;
    const std::string low = folder.path("low.nrrd");
    const std::string high = folder.path("high.nrrd");
    succeeds({"voxelize", folder.file("low.obj", box_obj(5)), "--grid", "12,12,12", "--origin", "-1,-1,-1", "--pitch",
              "1", "-o", low});
    succeeds({"voxelize", folder.file("high.obj", box_obj(10)), "--grid", "12,12,12", "--origin", "-1,-1,-1", "--pitch",
              "1", "-o", high});
    const auto inside = [&](const std::string& seconds) {
        return number(
            succeeds({"play", low, high, "--display", "cube16-ws2812", "--fps", "10", "--seconds", seconds, "--json"})
                .out,
            "inside");
    };
    CHECK(inside("0.2") == Approx(2 * inside("0.1")).epsilon(0.15));
    const Outcome mixed = run_program({"play", low, kDuck, "--display", "cube16-ws2812"});
    CHECK(mixed.status == 2);
    CHECK_THAT(mixed.err, Catch::Contains("a sequence has one kind"));
}

TEST_CASE("what cannot be played is refused with what to do", "[cli]") {
    refused({}, "nothing moves; give --spin, --motion");
    refused({"--loop", "--spin", "5"}, "a loop never ends; say how long with --seconds");
    refused({"--spin", "5"}, "spinning never ends; say how long with --seconds");
    refused({"--motion", "at=0; at=1 turn=0,0"}, "--motion: keyframe 2: found \"turn=0,0\"; allowed: turn=X,Y,Z");
    refused({"--camera", "at=0 move=0,0,0"}, "--camera: keyframe 1: found \"move=0,0,0\"");
    refused({"--timeline", "/nonexistent/t.toml"}, "--timeline: /nonexistent/t.toml: it cannot be opened");
    refused({"--timeline", kDuck}, "duck.ply: larger than 1 MiB, which no timeline is");
    refused({"--timeline", "/nonexistent/\x1b[2J"}, "--timeline: /nonexistent/\\x1b[2J: it cannot be opened");
    refused({"--fps", "0", "--spin", "1"}, "'0' is not a number above zero");
}
