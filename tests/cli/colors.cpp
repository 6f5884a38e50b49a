// What --color takes, in the program, and `bench color`.
#include <string>

#include "tests/catch.h"
#include "tests/cli/process.h"
#include "tests/unit/io/glb.h"

using namespace xorvox::test;
using Catch::Matchers::Contains;

namespace {

const std::string kExamples = XORVOX_SOURCE_DIR "/examples/";
const std::string kDuck = kExamples + "duck.ply";

Outcome show(const std::string& color) {
    return run_program({"show", kDuck, "--display", "cube16-ws2812", "--color", color, "--json"});
}

/// What is said of `color`, which is refused in one line.
std::string refusal(const std::string& color) {
    const Outcome outcome = show(color);
    CHECK(outcome.status == 2);
    CHECK(outcome.out.empty());
    CHECK(outcome.err.find('\n') == outcome.err.size() - 1);
    return outcome.err;
}

}  // namespace

TEST_CASE("a model is shown in its own colours where it has any, else in a gradient", "[cli]") {
    const Folder folder;
    const std::string red = folder.file("red.glb", moving_corner_glb());
    const auto sent = [&](const std::string& model, const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"show",          model,  "--display",
                                           "cube16-ws2812", "--to", "file:" + folder.path("out.packets")};
        arguments.insert(arguments.end(), more.begin(), more.end());
        succeeds(arguments);
        return read_file(folder.path("out.packets"));
    };
    CHECK(sent(red, {}) == sent(red, {"--color", "constant:red"}));
    CHECK(sent(red, {"--color", "own"}) == sent(red, {"--color", "constant:red"}));
    CHECK(sent(kDuck, {}) == sent(kDuck, {"--color", "gradient"}));
    const Outcome none = run_program({"show", kDuck, "--display", "cube16-ws2812", "--color", "own"});
    CHECK(none.status == 2);
    CHECK_THAT(none.err, Catch::Contains("duck.ply has no colours of its own"));
}

TEST_CASE("a row of files is shown in its own colours only if each of them has some", "[cli]") {
    const Folder folder;
    const std::string red = folder.file("red.glb", moving_corner_glb());
    const std::vector<std::string> row{"play", red, kDuck, "--display", "cube16-ws2812", "--fps", "20"};
    succeeds(row);
    std::vector<std::string> own = row;
    own.insert(own.end(), {"--color", "own"});
    const Outcome refused = run_program(own);
    CHECK(refused.status == 2);
    CHECK_THAT(refused.err, Catch::Contains("one of the files has no colours of its own"));
}

TEST_CASE("a model whose colours lack their picture is shown in a gradient, with a warning, and not as its own",
          "[cli]") {
    const Folder folder;
    const std::string model = folder.file("a.obj", "mtllib a.mtl\nusemtl m\n" + cube_obj(10));
    folder.file("a.mtl", "newmtl m\nmap_Kd gone.png\n");
    const Outcome missing = run_program({"show", model, "--display", "cube16-ws2812"});
    CHECK(missing.status == 0);
    CHECK_THAT(missing.err, Catch::Contains("warning") && Catch::Contains("gone.png"));
    const Outcome own = run_program({"show", model, "--display", "cube16-ws2812", "--color", "own"});
    CHECK(own.status == 2);
    CHECK_THAT(own.err, Catch::Contains("gone.png"));
    succeeds({"show", model, "--display", "cube16-ws2812", "--color", "gradient"});
}

TEST_CASE("show takes every kind of colour of docs/color.md", "[cli]") {
    const double lit = number(show("constant:white").out, "voxels_lit");
    REQUIRE(lit > 0);
    for (const std::string& color :
         {std::string("radial:white,gold,blue"), std::string("spherical:white,gold"), std::string("simplex:3"),
          "texture:" + kExamples + "swirl.nrrd", "texture:" + kExamples + "swirl.nrrd,#0000ff,gold",
          "texture:" + kExamples + "hues.nrrd", "labels:" + kExamples + "cells.nrrd",
          "labels:" + kExamples + "cells.nrrd,red,#00ff00", "spherical:" + kExamples + "globe.png"}) {
        INFO(color);
        const Outcome outcome = show(color);
        CHECK(outcome.err.empty());
        REQUIRE(outcome.status == 0);
        CHECK(number(outcome.out, "voxels_lit") == lit);
    }
}

TEST_CASE("colours from files that cannot be are refused in one line", "[cli]") {
    CHECK_THAT(refusal("texture:"), Contains("--color: texture: the name of a volume file is missing"));
    CHECK_THAT(refusal("texture:none.nrrd"), Contains("--color: none.nrrd: cannot be read: No such file"));
    CHECK_THAT(refusal("texture:" + kExamples + "hues.nrrd,red,blue"), Contains("has colours of its own"));
    CHECK_THAT(refusal("texture:" + kExamples + "swirl.nrrd,red"), Contains("two colours or more"));
    CHECK_THAT(refusal("labels:" + kExamples + "hues.nrrd"), Contains("has no labels"));
    CHECK_THAT(refusal("labels:" + kExamples + "cells.nrrd,rde"), Contains("unknown colour \"rde\""));
    CHECK_THAT(refusal("spherical:none.jpg"), Contains("none.jpg: cannot be read: No such file"));
    CHECK_THAT(refusal("rainbow"), Contains("allowed: constant:NAME") && Contains("labels:FILE") && Contains("own"));
    CHECK_THAT(refusal("noise\n"), Contains("noise\\x0a"));
}

TEST_CASE("pictures and volumes cut short or of absurd size are refused in one line", "[cli]") {
    const Folder folder;
    const std::string globe = read_file(kExamples + "globe.png");
    CHECK_THAT(refusal("spherical:" + folder.file("cut.png", globe.substr(0, globe.size() / 2))),
               Contains("cut.png: the picture cannot be read"));
    std::string huge = globe;
    huge[16] = '\x7f';
    CHECK_THAT(refusal("spherical:" + folder.file("huge.png", huge)), Contains("pixels are too many"));
    const std::string swirl = read_file(kExamples + "swirl.nrrd");
    CHECK_THAT(refusal("texture:" + folder.file("cut.nrrd", swirl.substr(0, swirl.size() / 2))), Contains("cut.nrrd"));
    CHECK_THAT(refusal("texture:" + folder.file("huge.nrrd",
                                                "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 16384 16384 16384\n"
                                                "encoding: raw\n\n0")),
               Contains("huge.nrrd"));
}

TEST_CASE("bench color measures painting and every function", "[cli]") {
    const Outcome outcome = succeeds({"bench", "color", kDuck, "--display", "cube16-ws2812", "--quick", "--json"});
    for (const char* name : {"constant:orange", "noise", "bit planes", "simplex", "texture of colours", "labels",
                             "spherical picture", "surface", "expr: hsv(0.5+0.5*noise(8*p), 1, z)"}) {
        CHECK_THAT(outcome.out, Contains("\"name\": \"" + std::string(name) + "\""));
    }
    CHECK(number(outcome.out, "items_per_second") > 0);
    CHECK(number(outcome.out, "over_copy") > 0);
    CHECK_THAT(succeeds({"bench", "color", kDuck, "--display", "cube8-595", "--quick"}).out,
               Contains("at most 4 times the copy") && Contains("at least 40 million/s"));
}
