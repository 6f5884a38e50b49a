#include "driver/host/timeline.h"

#include <cmath>
#include <string>

#include <glm/geometric.hpp>

#include "tests/catch.h"

using namespace xorvox;
using namespace xorvox::host;

namespace {

Keyframe key(double at, double x, Ease ease = Ease::Linear) {
    Keyframe frame;
    frame.at_seconds = at;
    frame.place_mm.x = x;
    frame.ease = ease;
    return frame;
}

double x_at(const std::vector<Keyframe>& track, double seconds) {
    return frame_at(track, seconds).place_mm.x;
}

glm::dvec3 shown(const Timeline& timeline, double seconds, const glm::dvec3& point,
                 const glm::dvec3& middle = glm::dvec3(0.0)) {
    return glm::dvec3(pose_at(timeline, seconds, middle) * glm::dvec4(point, 1.0));
}

void is_near(const glm::dvec3& a, const glm::dvec3& b) {
    CAPTURE(a.x, a.y, a.z, b.x, b.y, b.z);
    CHECK(glm::distance(a, b) < 1e-9);
}

std::vector<Keyframe> track(std::string_view text, TrackKind kind = TrackKind::Motion) {
    const auto read = parse_track(text, kind);
    CAPTURE(text, read ? "" : read.error().message);
    REQUIRE(read);
    return *read;
}

void is_refused(const Expected<std::vector<Keyframe>>& read, const std::string& message) {
    REQUIRE(!read);
    CHECK(read.error().message == message);
}

std::string timeline_error(std::string_view toml) {
    const auto read = parse_timeline(toml, "t.toml");
    REQUIRE(!read);
    return read.error().message;
}

}  // namespace

TEST_CASE("between keyframes a value goes evenly, smoothly, on a curve or at once") {
    CHECK(x_at({key(0, 0), key(2, 10)}, 0.5) == 2.5);
    CHECK(x_at({key(0, 0), key(2, 10, Ease::Smooth)}, 1.0) == 5.0);
    CHECK(x_at({key(0, 0), key(2, 10, Ease::Smooth)}, 0.1) < 0.1);
    CHECK(x_at({key(0, 0), key(2, 10, Ease::Step)}, 1.999) == 0.0);
    CHECK(x_at({key(0, 0), key(2, 10, Ease::Step)}, 2.0) == 10.0);
}

TEST_CASE("before the first keyframe and after the last one a track stands still") {
    CHECK(x_at({key(1, 3), key(2, 10)}, 0.0) == 3.0);
    CHECK(x_at({key(1, 3), key(2, 10)}, 7.0) == 10.0);
    CHECK(x_at({}, 7.0) == 0.0);
}

TEST_CASE("a curve passes through its keyframes without a jump in speed") {
    const std::vector<Keyframe> curve{key(0, 0), key(1, 4, Ease::Curve), key(3, 2, Ease::Curve),
                                      key(4, 9, Ease::Curve)};
    for (const Keyframe& k : curve) CHECK(x_at(curve, k.at_seconds) == Approx(k.place_mm.x).margin(1e-12));
    constexpr double kStep = 1e-5;
    for (const double at : {1.0, 3.0}) {
        const double before = (x_at(curve, at) - x_at(curve, at - kStep)) / kStep;
        const double after = (x_at(curve, at + kStep) - x_at(curve, at)) / kStep;
        CHECK(before == Approx(after).margin(1e-3));
    }
}

TEST_CASE("a curve through even keyframes on a parabola is the parabola between the inner ones") {
    const auto square = [](double t) { return key(t, t * t, Ease::Curve); };
    const std::vector<Keyframe> curve{square(0), square(1), square(2), square(3)};
    CHECK(x_at(curve, 1.3) == Approx(1.69));
    CHECK(x_at(curve, 1.8) == Approx(3.24));
}

TEST_CASE("a curve does not run away after keyframes that follow each other fast") {
    const std::vector<Keyframe> curve{key(0, 0), key(1e-3, 100, Ease::Curve), key(1000, 100, Ease::Curve)};
    for (double t = 0.0; t < 1000.0; t += 0.7) CHECK(std::abs(x_at(curve, t)) < 120.0);
}

TEST_CASE("sizes multiply: half way from 1 to 4 is 2") {
    Keyframe large = key(2, 0);
    large.size = 4.0;
    CHECK(frame_at(std::vector{key(0, 0), large}, 1.0).size == Approx(2.0));
}

TEST_CASE("the model is scaled and turned about the middle of the display, then moved") {
    Timeline timeline;
    timeline.motion = track("at=0 turn=0,0,90 scale=2 move=1,2,3");
    is_near(shown(timeline, 0.0, {11, 5, 5}, {10, 5, 5}), {11, 9, 8});
}

TEST_CASE("turns go about x first, then y, then z") {
    Timeline timeline;
    timeline.motion = track("at=0 turn=90,0,90");
    is_near(shown(timeline, 0.0, {0, 1, 0}), {0, 0, 1});
    timeline.motion = track("at=0 turn=90,90,0");
    is_near(shown(timeline, 0.0, {0, 1, 0}), {1, 0, 0});
}

TEST_CASE("angles are numbers: from 0 to 720 is two turns") {
    Timeline timeline;
    timeline.motion = track("at=0; at=4 turn=0,0,720");
    is_near(shown(timeline, 1.0, {1, 0, 0}), {-1, 0, 0});
    is_near(shown(timeline, 2.0, {1, 0, 0}), {1, 0, 0});
    is_near(shown(timeline, 3.0, {1, 0, 0}), {-1, 0, 0});
}

TEST_CASE("what the camera stands at is in the middle of the display, magnified") {
    Timeline timeline;
    timeline.camera = track("at=0 center=10,0,0 turn=0,0,90 zoom=3", TrackKind::Camera);
    is_near(shown(timeline, 0.0, {10, 0, 0}), {0, 0, 0});
    is_near(shown(timeline, 0.0, {10, 1, 0}), {3, 0, 0});  // it looks along +y: what is there is on its +x
}

TEST_CASE("a loop begins anew at its end, and everything else stays") {
    Timeline timeline;
    timeline.motion = track("at=0; at=2 move=10,0,0");
    is_near(shown(timeline, 5.0, {0, 0, 0}), {10, 0, 0});
    timeline.loop = true;
    is_near(shown(timeline, 5.0, {0, 0, 0}), {5, 0, 0});
    timeline.seconds = 4.0;
    is_near(shown(timeline, 5.0, {0, 0, 0}), {5, 0, 0});
    is_near(shown(timeline, 7.0, {0, 0, 0}), {10, 0, 0});
}

TEST_CASE("a timeline that ends before its last keyframe stays as it is then, or begins anew") {
    Timeline timeline;
    timeline.motion = track("at=0; at=2 move=10,0,0");
    timeline.camera = track("at=0; at=4 center=0,4,0", TrackKind::Camera);
    timeline.seconds = 1.0;
    is_near(shown(timeline, 0.5, {0, 0, 0}), {2.5, -0.5, 0});
    is_near(shown(timeline, 3.5, {0, 0, 0}), {5, -1, 0});
    timeline.loop = true;
    is_near(shown(timeline, 3.5, {0, 0, 0}), {2.5, -0.5, 0});
}

TEST_CASE("a typed keyframe keeps what it does not name") {
    const auto read = track(" at=0 move=1,2,3 scale=2;at=1 turn=0,90,0 ; at=2 ease=curve scale=1e-3");
    REQUIRE(read.size() == 3);
    CHECK(read[1].place_mm == glm::dvec3(1, 2, 3));
    CHECK(read[1].size == 2.0);
    CHECK(read[2].turn_deg == glm::dvec3(0, 90, 0));
    CHECK(read[2].size == 1e-3);
    CHECK(read[2].ease == Ease::Curve);
}

TEST_CASE("a typed track is refused by keyframe, with what is allowed") {
    const auto motion = [](std::string_view text) { return parse_track(text, TrackKind::Motion); };
    is_refused(motion(""), "no keyframe; allowed: as in \"at=0; at=4 turn=0,0,360\"");
    is_refused(motion("at=0; turn=0,0,360"),
               "keyframe 2: it has no time; allowed: at=SECONDS in each, as in \"at=0; at=4 turn=0,0,360\"");
    is_refused(motion("at=0 move=1,2"), "keyframe 1: found \"move=1,2\"; allowed: move=X,Y,Z in millimetres");
    is_refused(motion("at=0 move=1,2,3,4"), "keyframe 1: found \"move=1,2,3,4\"; allowed: move=X,Y,Z in millimetres");
    is_refused(motion("at=0 at=1"), "keyframe 1: at stands in it twice; is a semicolon missing between two keyframes?");
    is_refused(motion("at=0 zoom=1"), "keyframe 1: found \"zoom=1\"; allowed: at=, move=, turn=, scale= and ease=");
    is_refused(motion("at=1; at=1"),
               "keyframe 2: at: found 1 after 1; allowed: keyframes in the order of time, no two "
               "at once");
    is_refused(motion("at=-1"), "keyframe 1: at: found -1; allowed: 0 to 1000000 seconds");
    is_refused(motion("at=nan"), "keyframe 1: found \"at=nan\"; allowed: at=SECONDS");
    is_refused(motion("at=0 scale=0"), "keyframe 1: scale: found 0; allowed: 0.001 to 100");
    is_refused(motion("at=0 ease=fast"),
               "keyframe 1: found \"ease=fast\"; allowed: ease=linear, ease=smooth, ease=curve or ease=step");
}

TEST_CASE("a timeline file holds what can be typed") {
    const auto timeline = parse_timeline(R"(
seconds = 9
loop = true
[[motion]]
at = 0
[[motion]]
at = 4
turn_deg = [0, 0, 360]
move_mm = [0, 0, 10.5]
ease = "smooth"
[[camera]]
at = 1.5
center_mm = [1, 2, 3]
zoom = 2
)",
                                         "t.toml");
    REQUIRE(timeline);
    CHECK(timeline->seconds == 9.0);
    CHECK(timeline->loop);
    const auto motion = track("at=0; at=4 turn=0,0,360 move=0,0,10.5 ease=smooth");
    REQUIRE(timeline->motion.size() == 2);
    CHECK(timeline->motion[1].turn_deg == motion[1].turn_deg);
    CHECK(timeline->motion[1].place_mm == motion[1].place_mm);
    CHECK(timeline->motion[1].ease == motion[1].ease);
    REQUIRE(timeline->camera.size() == 1);
    CHECK(timeline->camera[0].size == 2.0);
    CHECK(timeline->camera[0].place_mm == glm::dvec3(1, 2, 3));
}

TEST_CASE("a timeline file is refused by line") {
    CHECK(timeline_error("loop = true") == "t.toml: nothing moves: it has neither [[motion]] nor [[camera]] keyframes");
    CHECK(timeline_error("[[motion]]\nat = 0\n[[motion]]\nat = 0\n") ==
          "t.toml: line 4: motion 2: at: found 0 after 0; allowed: keyframes in the order of time, no two at once");
    CHECK(timeline_error("[[motion]]\nmove_mm = [1, 2, 3]\n") ==
          "t.toml: line 1: motion 1: the required key \"at\" is missing");
    CHECK(timeline_error("[[camera]]\nat = 0\ncenter_mm = [1, 2]\n") ==
          "t.toml: line 3: camera 1: center_mm: found 2 numbers; allowed: three");
    CHECK(timeline_error("seconds = 0\n[[camera]]\nat = 0\n") ==
          "t.toml: line 1: seconds: found 0; allowed: above 0, at most 1000000");
    CHECK(
        timeline_error("[[camera]]\nat = 0\nease = \"fast\"\n").find("\"linear\", \"smooth\", \"curve\" or \"step\"") !=
        std::string::npos);
    CHECK(timeline_error("[motion]\nat = 0\n").find("one [[motion]] table for each keyframe") != std::string::npos);
    CHECK(timeline_error("[[motion]]\nat = 0\nscale = inf\n") ==
          "t.toml: line 3: motion 1: scale: found inf; allowed: 0.001 to 100");
    CHECK(timeline_error("x = 1\n").find("unknown key \"x\"") != std::string::npos);
    CHECK(timeline_error("=").find("t.toml: line 1: ") == 0);
}
