#include "voxelizer/io/node_motion.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "tests/unit/io/contains.h"
#include "tests/unit/io/glb.h"
#include "tests/unit/io/temp_folder.h"
#include "voxelizer/io/mesh_report.h"

using namespace xorvox;
using io::MotionChannel;

namespace {

constexpr double kHalf = 0.70710678118654752440;

// Two corners of glb.h, both at the origin; node 1 moves along x by accessor 3 at the times of accessor 2, and node 2,
// which hangs on it, turns.
std::string moving_glb(const std::string& channels, const std::string& more_nodes = "") {
    const std::string binary =
        corner_binary() + floats({0, 1, 3}) + floats({0, 0, 0, 10, 0, 0, 10, 0, 20}) +
        floats({0, 0, 0, 1, 0, 0, static_cast<float>(kHalf), static_cast<float>(kHalf), 0, 0, 1, 0});
    return glb(corner_json("'nodes':[{'mesh':0},{'children':[2]},{'mesh':0}" + more_nodes +
                               "],'scenes':[{'nodes':[0,1]}],'animations':[{'name':'walk','channels':[" + channels +
                               "],'samplers':[{'input':2,'output':3},{'input':2,'output':4},"
                               "{'input':2,'output':3,'interpolation':'STEP'},"
                               "{'input':2,'output':3,'interpolation':'CUBICSPLINE'}]}]",
                           ",{'buffer':0,'byteOffset':72,'byteLength':12},{'buffer':0,'byteOffset':84,'byteLength':36},"
                           "{'buffer':0,'byteOffset':120,'byteLength':48}",
                           ",{'bufferView':2,'componentType':5126,'count':3,'type':'SCALAR'},"
                           "{'bufferView':3,'componentType':5126,'count':3,'type':'VEC3'},"
                           "{'bufferView':4,'componentType':5126,'count':3,'type':'VEC4'}",
                           168),
               binary);
}

const std::string kMove = "{'sampler':0,'target':{'node':1,'path':'translation'}}";
const std::string kTurn = "{'sampler':1,'target':{'node':2,'path':'rotation'}}";

MotionChannel channel(MotionChannel::Target target, MotionChannel::Interpolation interpolation,
                      std::vector<double> times, std::vector<glm::dvec4> keys) {
    return {0, target, interpolation, std::move(times), std::move(keys)};
}

}  // namespace

TEST_CASE("motion: values lie on lines, steps or splines between their keys, and stay at the ends") {
    using Target = MotionChannel::Target;
    using Interpolation = MotionChannel::Interpolation;
    const auto line =
        channel(Target::Translation, Interpolation::Linear, {1, 2, 4}, {{0, 0, 0, 0}, {4, 0, 0, 0}, {4, 8, 0, 0}});
    CHECK(value_at(line, -5) == glm::dvec4(0));
    CHECK(value_at(line, 1.25).x == 1.0);
    CHECK(value_at(line, 3) == glm::dvec4(4, 4, 0, 0));
    CHECK(value_at(line, 99) == glm::dvec4(4, 8, 0, 0));
    auto step = line;
    step.interpolation = Interpolation::Step;
    CHECK(value_at(step, 1.999).x == 0.0);
    CHECK(value_at(step, 2).x == 4.0);
    // From 0 with slope 1 to 0 with slope 0, in 2 seconds: t - 2 t² + t³ times 2 in the middle.
    const auto spline = channel(Target::Scale, Interpolation::CubicSpline, {0, 2},
                                {{9, 0, 0, 0}, {0, 0, 0, 0}, {1, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {9, 0, 0, 0}});
    CHECK(value_at(spline, 1).x == Approx(0.25));
    CHECK(value_at(spline, 2).x == 0.0);
    // A quarter turn, half way: not the mean of the quaternions but the turn by 45 degrees; the short way round.
    const auto turn = channel(Target::Rotation, Interpolation::Linear, {0, 1}, {{0, 0, 0, 1}, {0, 0, -kHalf, -kHalf}});
    const glm::dvec4 q = value_at(turn, 0.5);
    CHECK(std::abs(q.z) == Approx(std::sin(std::acos(-1.0) / 8)));
    CHECK(std::abs(q.w) == Approx(std::cos(std::acos(-1.0) / 8)));
}

TEST_CASE("motion: the parts of a glTF move, and are welded each for itself") {
    const TempFolder folder;
    put(folder / "a.glb", moving_glb(kMove + "," + kTurn));
    const auto scene = io::read_scene(folder / "a.glb", {.scale = 100});
    REQUIRE(scene);
    REQUIRE(scene->motion);
    REQUIRE(scene->motion->animations().size() == 1);
    CHECK(scene->motion->animations()[0].name == "walk");
    CHECK(scene->motion->animations()[0].duration_seconds == 3.0);
    CHECK(scene->mesh.positions.size() == 8);
    std::vector<glm::dvec3> at(8);
    scene->motion->positions_at(0, 0.0, at);
    CHECK(at == scene->mesh.positions);
    // At 1 s: 10 along x, a quarter turn about z; y is up, so that z of the file is -y here.
    scene->motion->positions_at(0, 1.0, at);
    for (std::size_t v = 0; v < 4; ++v) CHECK(at[v] == scene->mesh.positions[v]);
    const auto near = [](glm::dvec3 a, glm::dvec3 b) { return glm::length(a - b) < 1e-3; };
    CHECK(near(at[4], {1000, 0, 0}));
    CHECK(near(at[5], {1000, 0, 100}));  // (1, 0, 0) of the file turns to (0, 1, 0).
    CHECK(near(at[7], {1000, -300, 0}));
    scene->motion->positions_at(0, 1e9, at);
    CHECK(near(at[4], {1000, -2000, 0}));
    Mesh moved = scene->mesh;
    moved.positions = at;
    CHECK(io::report(moved.view()).signed_volume == Approx(2e6));
}

TEST_CASE("motion: animations that move nothing to be seen are left out, with a note") {
    const TempFolder folder;
    put(folder / "a.glb", moving_glb("{'sampler':0,'target':{'node':3,'path':'translation'}}", ",{}"));
    const auto scene = io::read_scene(folder / "a.glb");
    REQUIRE(scene);
    CHECK_FALSE(scene->motion);
    CHECK(scene->notes == std::vector<std::string>{"animation 0, which moves nothing that is shown"});
}

TEST_CASE("motion: poses beyond a double leave their part at rest") {
    io::NodeMotion motion;
    motion.nodes.resize(2);
    motion.part_nodes = {0, 1};
    motion.about = {{"far", 1.0}};
    motion.channels = {
        {{0, MotionChannel::Target::Scale, MotionChannel::Interpolation::Linear, {0.0}, {{1e308, 1e308, 1e308, 0}}}}};
    motion.attach({{5, 0, 0}, {1e10, 1, 0}, {2, 0, 0}}, {0, 1, 2}, glm::dmat4(1.0));
    std::vector<glm::dvec3> at(3);
    motion.positions_at(0, 0.0, at);
    CHECK(at == std::vector<glm::dvec3>{{5, 0, 0}, {1e10, 1, 0}, {2, 0, 0}});
}

TEST_CASE("motion: key frames that cannot be are refused") {
    const TempFolder folder;
    const auto refused = [&folder](const std::string& file) {
        put(folder / "a.glb", file);
        const auto scene = io::read_scene(folder / "a.glb");
        return scene ? std::string() : scene.error().message;
    };
    CHECK_THAT(refused(moving_glb("{'sampler':9,'target':{'node':1,'path':'translation'}}")),
               contains("animation 0: sampler 9 of 4"));
    CHECK_THAT(refused(moving_glb("{'sampler':0,'target':{'node':9,'path':'translation'}}")),
               contains("animation 0: moves node 9 of a file with 3"));
    CHECK_THAT(refused(moving_glb("{'sampler':1,'target':{'node':1,'path':'translation'}}")),
               contains("accessor 4 (key frames)"));
    CHECK_THAT(refused(moving_glb("{'sampler':3,'target':{'node':1,'path':'translation'}}")),
               contains("3 values for 3 times"));
    std::string backward = moving_glb(kMove);
    backward.replace(backward.find(floats({0, 1, 3})), 12, floats({0, 4, 3}));
    CHECK_THAT(refused(backward), contains("its times are none, negative or not in order"));
}
