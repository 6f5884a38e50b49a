#include "voxelizer/io/foreign_mesh.h"

#include <filesystem>

#include "tests/unit/io/contains.h"
#include "tests/unit/io/temp_folder.h"
#include "voxelizer/io/mesh_report.h"
#include "voxelizer/io/scene.h"

using namespace xorvox;
using namespace std::chrono_literals;

namespace {

const std::string kModels = "/usr/share/assimp/models/";

// The refusal of a file whose importer does as `word` says.
std::string refused(const TempFolder& folder, const std::string& word, const io::ImportLimits& limits = {}) {
    put(folder / "a.fbx", word);
    const auto model = io::import_foreign(folder / "a.fbx", "a.fbx", io::Wanted::Shape, XORVOX_FAKE_IMPORT, limits);
    REQUIRE_FALSE(model);
    CHECK(model.error().message.starts_with("a.fbx: "));
    CHECK(model.error().message.find('\n') == std::string::npos);
    return model.error().message;
}

struct Known {
    const char* file;
    std::size_t vertices;
    std::size_t faces;
    bool closed;
};

// Welded vertices and faces, counted with the models' own programs or by hand for the cubes; a cube of quadrilaterals
// has 6.
constexpr Known kKnown[] = {
    {"3DS/RotatingCube.3DS", 8, 12, true},
    {"3MF/box.3mf", 8, 12, true},
    {"AMF/test1.amf", 4, 4, true},
    {"ASE/ThreeCubesGreen.ASE", 24, 36, true},
    {"BLEND/BlenderDefault_248.blend", 8, 6, true},
    {"Collada/cube_triangulate.dae", 8, 12, true},
    {"Collada/duck.dae", 2108, 2144, true},
    {"COB/molecule.cob", 456, 512, true},
    {"DXF/wuson.dxf", 2117, 3732, false},
    {"FBX/phong_cube.fbx", 8, 6, true},
    {"FBX/box.fbx", 8, 12, true},
    {"LWO/LWO2/boxuv.lwo", 8, 6, true},
    {"LWS/move_x.lws", 8, 6, true},
    {"MD5/SimpleCube.md5mesh", 8, 12, true},
    {"MS3D/twospheres.ms3d", 124, 240, true},
    {"NFF/NFF/octahedron.nff", 6, 8, true},
    {"OFF/Cube.off", 8, 6, true},
    {"OpenGEX/Example.ogex", 16, 24, true},
    {"X/test.x", 8, 12, true},
    {"X3D/HelloX3dTrademark.x3d", 642, 1280, true},
};

}  // namespace

TEST_CASE("foreign: real files of many formats have their vertices, their faces, and their closedness") {
    if (!std::filesystem::exists(kModels)) XORVOX_SKIP("the models of the package assimp-testmodels are not here");
    for (const Known& known : kKnown) {
        INFO(known.file);
        const auto scene = io::read_scene(kModels + known.file, {.import_program = XORVOX_IMPORT});
        INFO((scene ? "" : scene.error().message));
        REQUIRE(scene);
        CHECK(scene->mesh.positions.size() == known.vertices);
        CHECK(scene->mesh.view().face_count() == known.faces);
        CHECK(io::report(scene->mesh.view()).closed_mod2 == known.closed);
    }
}

TEST_CASE("foreign: colours, images and notes come along") {
    if (!std::filesystem::exists(kModels)) XORVOX_SKIP("the models of the package assimp-testmodels are not here");
    const io::MeshReadOptions options{.import_program = XORVOX_IMPORT};
    const auto duck = io::read_scene(kModels + "Collada/duck.zae", options);
    REQUIRE(duck);
    CHECK(duck->colors.images.size() == 1);
    CHECK(duck->colors.corner_texcoords.size() == duck->mesh.indices.size());
    const auto cubes = io::read_scene(kModels + "BLEND/4Cubes4Mats_248.blend", options);
    REQUIRE(cubes);
    CHECK(cubes->colors.materials.size() == 4);
    CHECK(cubes->colors.face_materials.size() == cubes->mesh.view().face_count());
    const auto turning = io::read_scene(kModels + "3DS/RotatingCube.3DS", options);
    REQUIRE(turning);
    CHECK(turning->notes == std::vector<std::string>{"animations, which are not read from this format: 1"});
    // Beside the model there is no such image: the shape is read all the same.
    const auto bare = io::read_scene(kModels + "3DS/test1.3ds", options);
    REQUIRE(bare);
    CHECK(bare->colors.is_white());
    CHECK_THAT(bare->colors_fault, contains("names a file that it needs"));
    CHECK(io::read_mesh(kModels + "3DS/test1.3ds", options));
}

TEST_CASE("foreign: a file cut short at any length gives a mesh or one line") {
    if (!std::filesystem::exists(kModels)) XORVOX_SKIP("the models of the package assimp-testmodels are not here");
    const TempFolder folder;
    for (const char* model : {"3DS/RotatingCube.3DS", "FBX/phong_cube.fbx", "BLEND/BlenderDefault_248.blend",
                              "Collada/cube_triangulate.dae", "LWO/LWO2/boxuv.lwo", "X/test.x"}) {
        const std::string whole = contents(kModels + model);
        const std::string ending = std::filesystem::path(model).extension().string();
        for (const std::size_t percent : {0u, 1u, 7u, 20u, 35u, 50u, 65u, 80u, 95u, 99u}) {
            INFO(model << " cut at " << percent << " %");
            put(folder / ("cut" + ending), whole.substr(0, whole.size() * percent / 100));
            const auto mesh = io::read_mesh(folder / ("cut" + ending), {.import_program = XORVOX_IMPORT});
            if (!mesh) {
                CHECK(mesh.error().message.find('\n') == std::string::npos);
                CHECK_THAT(mesh.error().message, contains("cut" + ending + ": "));
            } else {
                CHECK(validate(mesh->view()) == Status::Ok);
            }
        }
    }
}

TEST_CASE("foreign: an importer can read files, and change nothing") {
    const TempFolder folder;
    CHECK_THAT(refused(folder, "sandbox"), contains("it could read; "));
    CHECK(contents(folder / "a.fbx") == "sandbox");
    CHECK(folder.names() == std::set<std::string>{"a.fbx"});
}

TEST_CASE("foreign: a model has files in its folder and below, and opens no others") {
    const TempFolder folder;
    const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    std::filesystem::create_directories(folder / "in/below");
    put(folder / "out.off", off);
    put(folder / "in/beside.off", off);
    put(folder / "in/below/it.off", off);
    std::filesystem::create_symlink(folder / "out.off", folder / "in/link.off");
    const auto faces = [&folder](const std::string& object) -> std::size_t {
        put(folder / "in/a.lws",
            "LWSC\n5\n\nFirstFrame 1\nLoadObjectLayer 1 10000000 " + object + "\nShowObject 7 -1 0 0 0\n");
        const auto mesh = io::read_mesh(folder / "in/a.lws", {.import_program = XORVOX_IMPORT});
        return mesh ? mesh->view().face_count() : 0;
    };
    CHECK(faces("beside.off") == 1);
    CHECK(faces("below/it.off") == 1);
    for (const std::string& object : {folder / "out.off", std::string("../out.off"), std::string("link.off")}) {
        CAPTURE(object);
        CHECK(faces(object) == 0);
    }
}

TEST_CASE("foreign: an importer that hangs, crashes, floods or talks nonsense is one clear line") {
    const TempFolder folder;
    CHECK_THAT(refused(folder, "hang", {.time = 100ms}),
               contains("its import took more than 0.1 s; repair the file, or convert it"));
    CHECK_THAT(refused(folder, "hang-silently"), contains("the importer crashed (signal 9"));
    CHECK_THAT(refused(folder, "crash"),
               contains("the importer crashed (signal 11, Segmentation fault)") || contains("status 1"));
    CHECK_THAT(refused(folder, "killed"), contains("signal 9"));
    CHECK_THAT(refused(folder, "fail"), contains("the importer ended with status 7"));
    CHECK_THAT(refused(folder, "flood", {.output_bytes = 1 << 20}),
               contains("its import gives more than 1048576 bytes"));
    CHECK_THAT(refused(folder, "garbage"), contains("the importer gives 21 bytes that are no model"));
    CHECK_THAT(refused(folder, "cut"), contains("bytes whose counts cannot be"));
    CHECK_THAT(refused(folder, "refuse"), contains("cannot be imported: no such\\x0aformat; "));
    CHECK_THAT(refused(folder, "nothing"), contains("the importer gives 0 bytes"));
    put(folder / "a.fbx", "triangle");
    const auto mesh = io::read_mesh(folder / "a.fbx", {.import_program = XORVOX_FAKE_IMPORT});
    REQUIRE(mesh);
    CHECK(mesh->positions.size() == 3);
}

TEST_CASE("foreign: files and importers that are not there are named") {
    const TempFolder folder;
    const auto refusal = [](const std::string& path, const std::string& program) {
        const auto mesh = io::read_mesh(path, {.import_program = program});
        return mesh ? std::string() : mesh.error().message;
    };
    CHECK_THAT(refusal(folder / "none.dae", XORVOX_FAKE_IMPORT), contains("none.dae: cannot be read: No such file"));
    std::filesystem::create_directory(folder / "b.dae");
    CHECK_THAT(refusal(folder / "b.dae", XORVOX_FAKE_IMPORT), contains("b.dae: is no regular file"));
    put(folder / "a.dae", "triangle");
    CHECK_THAT(refusal(folder / "a.dae", ""),
               contains("a.dae: .dae files are read by the program xorvox-import, which was not named"));
    CHECK_THAT(refusal(folder / "a.dae", folder / "gone"), contains("gone, which does not start: No such file"));
    CHECK_THAT(refusal(folder / "a.dae", folder / "a.dae"), contains("does not start: Permission denied"));
}
