// What the program says of models with more than a shape, and of the formats that its importer reads.
#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/catch.h"
#include "tests/cli/process.h"
#include "tests/unit/io/glb.h"

using namespace xorvox::test;

namespace {

const std::string kModels = "/usr/share/assimp/models/";

}  // namespace

TEST_CASE("info tells colours and animations of a glTF", "[cli]") {
    const Folder folder;
    const std::string model = folder.file("a.glb", moving_corner_glb());
    const Outcome text = succeeds({"info", model});
    CHECK_THAT(text.out, Catch::Contains("colours             1 material\n") &&
                             Catch::Contains("animation           slide, 2 s\n") &&
                             Catch::Contains("closed              yes"));
    const Outcome json = succeeds({"info", model, "--json"});
    CHECK_THAT(json.out,
               Catch::Contains("\"animations\": [{\"name\": \"slide\", \"seconds\": 2}]") &&
                   Catch::Contains("\"materials\": 1, \"images\": 0, \"corner_colors\": false, \"fault\": null"));
}

TEST_CASE("a glTF is voxelized upright", "[cli]") {
    const Folder folder;
    const std::string model = folder.file("a.glb", moving_corner_glb());
    CHECK_THAT(succeeds({"info", model}).out, Catch::Contains("box                 0, -3, 0 to 1, 0, 2"));
    CHECK_THAT(succeeds({"info", model, "--up", "z"}).out, Catch::Contains("box                 0, 0, 0 to 1, 2, 3"));
    succeeds({"voxelize", model, "--size", "16", "-o", folder.path("a.nrrd")});
}

TEST_CASE("the rarer formats are read by the importer beside the program", "[cli]") {
    if (!std::filesystem::exists(kModels)) XORVOX_SKIP("the models of the package assimp-testmodels are not here");
    CHECK_THAT(succeeds({"info", kModels + "FBX/phong_cube.fbx"}).out, Catch::Contains("vertices            8\n"));
}

TEST_CASE("an importer that is not there, and one that reads nothing, are each one line", "[cli]") {
    const Folder folder;
    const std::string model = folder.file("a.fbx", "no such thing");
    const Outcome damaged = run_program({"info", model});
    CHECK(damaged.status == 2);
    CHECK_THAT(damaged.err, Catch::StartsWith("xorvox: ") && Catch::Contains("a.fbx: cannot be imported: "));
    CHECK(damaged.err.find('\n') == damaged.err.size() - 1);
    REQUIRE(::setenv("XORVOX_IMPORT", folder.path("gone").c_str(), 1) == 0);
    const Outcome missing = run_program({"info", model});
    REQUIRE(::unsetenv("XORVOX_IMPORT") == 0);
    CHECK(missing.status == 2);
    CHECK_THAT(missing.err, Catch::Contains("gone, which does not start: No such file"));
}
