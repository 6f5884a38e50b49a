#include "driver/display/panel_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "tests/catch.h"

using namespace xorvox;
using display::faces_cross;

namespace {

/// 10 mm wide and 8 mm high.
Panel panel() {
    return {.columns = 10, .rows = 4, .column_pitch_mm = 1, .row_pitch_mm = 2};
}

bool cross(const Panel& a, const Panel& b) {
    const bool crossing = faces_cross(a, b);
    CHECK(faces_cross(b, a) == crossing);
    return crossing;
}

}  // namespace

TEST_CASE("panels at one place cross, whatever their angle") {
    for (const double angle : {0.0, 37.0, 90.0, -123.456, 360.0}) {
        Panel a = panel();
        a.angle_deg = angle;
        CHECK(cross(a, a));
        Panel back = a;
        back.angle_deg += 180.0;
        CHECK(cross(a, back));  // Back to back needs an offset.
        back.offset_mm = 0.01;
        CHECK_FALSE(cross(a, back));
        back.offset_mm = 0.0;
        back.mirrored = true;
        back.turned = 2;
        CHECK(cross(a, back));
    }
}

TEST_CASE("panels in one plane cross where they overlap and not where edges touch") {
    const Panel a = panel();
    Panel b = a;
    b.shift_mm = 10.0;
    CHECK_FALSE(cross(a, b));
    b.shift_mm = 9.99;
    CHECK(cross(a, b));
    b.shift_mm = 0.0;
    b.lift_mm = -8.0;
    CHECK_FALSE(cross(a, b));
    b.lift_mm = -7.99;
    CHECK(cross(a, b));
    b.shift_mm = 10.0;
    CHECK_FALSE(cross(a, b));
}

TEST_CASE("touching edges stay apart with pitches that binary numbers round") {
    for (const double angle : {0.0, 0.1, 33.3, 90.0, 271.7}) {
        for (const double pitch : {0.1, 1.875, 0.3307, 7.7}) {
            Panel left{.columns = 63, .rows = 7, .column_pitch_mm = pitch, .row_pitch_mm = pitch};
            left.angle_deg = angle;
            left.offset_mm = 0.7;
            Panel right = left;
            left.shift_mm = -31.5 * pitch;
            right.shift_mm = 31.5 * pitch;
            CHECK_FALSE(cross(left, right));
            right.shift_mm -= 0.01 * pitch;
            CHECK(cross(left, right));
        }
    }
}

TEST_CASE("a quarter turn swaps width and height") {
    const Panel a = panel();
    Panel b = a;
    b.turned = 1;  // 8 mm wide, 10 mm high.
    b.shift_mm = 8.5;
    CHECK(cross(a, b));
    b.shift_mm = 9.1;
    CHECK_FALSE(cross(a, b));
    b.shift_mm = 0.0;
    b.lift_mm = 8.5;
    CHECK(cross(a, b));
    b.lift_mm = 9.1;
    CHECK_FALSE(cross(a, b));
}

TEST_CASE("panels at an angle cross where one passes through the other") {
    const Panel a = panel();
    Panel b = a;
    b.angle_deg = 90.0;
    CHECK(cross(a, b));  // Both through the axis.
    b.shift_mm = 5.0;    // Its edge on the other's face: a T.
    CHECK_FALSE(cross(a, b));
    b.shift_mm = 4.99;
    CHECK(cross(a, b));

    Panel c = a;
    c.shift_mm = 5.0;  // A star of panels whose inner edges meet on the axis.
    for (const double angle : {10.0, 60.0, 90.0, 120.0, 180.0}) {
        Panel d = c;
        d.angle_deg = angle;
        CHECK_FALSE(cross(c, d));
        d.shift_mm = 4.9;
        CHECK((cross(c, d) || angle < 180.0));
    }

    Panel side = a;  // A box of four panels around the axis.
    side.offset_mm = 5.0;
    Panel next = side;
    next.angle_deg = 90.0;
    CHECK_FALSE(cross(side, next));
    next.offset_mm = 4.9;  // Its edge on the other's face.
    CHECK_FALSE(cross(side, next));
    next.shift_mm = -0.01;
    CHECK(cross(side, next));
}

TEST_CASE("tilt and skew count") {
    Panel a = panel();
    Panel b = a;
    a.offset_mm = b.offset_mm = 1.0;
    b.angle_deg = 180.0;
    CHECK_FALSE(cross(a, b));
    a.tilt_deg = -20.0;  // Its upper edge leans back through the other: 4 mm · sin 20° > 1 mm, but not 2 mm.
    CHECK_FALSE(cross(a, b));
    b.tilt_deg = -20.0;
    CHECK(cross(a, b));

    Panel deep = panel();
    deep.skew_mm = 2.0;
    Panel front = panel();
    front.offset_mm = 1.0;
    CHECK(cross(deep, front));
    front.offset_mm = 2.1;
    CHECK_FALSE(cross(deep, front));
    deep.skew_mm = -2.0;
    front.offset_mm = 1.0;
    CHECK_FALSE(cross(deep, front));
    front.offset_mm = -1.0;
    CHECK(cross(deep, front));
}

namespace {

/// A panel's face as a corner and two edges, worked out here on its own.
struct Rectangle {
    glm::dvec3 corner, along, up;
};

Rectangle rectangle(const Panel& p) {
    const double radians = std::numbers::pi / 180.0;
    const double c = std::cos(p.angle_deg * radians);
    const double s = std::sin(p.angle_deg * radians);
    const double lean = std::sin(p.tilt_deg * radians);
    const double rise = std::cos(p.tilt_deg * radians);
    const auto place = [&](double a, double b) {
        const double out = p.offset_mm + b * lean;
        return glm::dvec3(c * (p.shift_mm + a) + s * out, s * (p.shift_mm + a) - c * out, p.lift_mm + b * rise);
    };
    const double w = p.columns * p.column_pitch_mm / 2.0;
    const double h = p.rows * p.row_pitch_mm / 2.0;
    return {place(-w, -h), place(w, -h) - place(-w, -h), place(-w, h) - place(-w, -h)};
}

/// Whether an edge of `a` goes through `b`; `margin` is set to how near a case it was.
bool pierces(const Rectangle& a, const Rectangle& b, double& margin) {
    const std::array starts{a.corner, a.corner, a.corner + a.up, a.corner + a.along};
    const std::array ways{a.along, a.up, a.along, a.up};
    const glm::dvec3 normal = glm::cross(b.along, b.up);
    bool any = false;
    for (std::size_t i = 0; i < 4; ++i) {
        const double step = glm::dot(ways[i], normal);
        const double t = glm::dot(b.corner - starts[i], normal) / step;
        const glm::dvec3 hit = starts[i] + t * ways[i] - b.corner;
        const double u = glm::dot(hit, b.along) / glm::dot(b.along, b.along);
        const double v = glm::dot(hit, b.up) / glm::dot(b.up, b.up);
        double inside = 1.0;  // How far within all bounds; negative: outside.
        for (const double x : {t, u, v}) inside = std::min({inside, x, 1.0 - x});
        margin = std::min(margin, std::abs(inside));
        any = any || inside > 0.0;
    }
    return any;
}

}  // namespace

TEST_CASE("panels anywhere cross exactly where an edge of one goes through the other") {
    std::uint64_t state = 1;
    const auto random = [&state](double low, double high) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        return low + (high - low) * static_cast<double>(state >> 11) / 9007199254740992.0;
    };
    const auto any_panel = [&] {
        Panel p{.columns = 10, .rows = 10};
        p.column_pitch_mm = random(0.1, 3.0);
        p.row_pitch_mm = random(0.1, 3.0);
        p.shift_mm = random(-12, 12);
        p.offset_mm = random(-12, 12);
        p.lift_mm = random(-8, 8);
        p.angle_deg = random(-360, 360);
        p.tilt_deg = random(-80, 80);
        return p;
    };
    int crossing = 0;
    int apart = 0;
    for (int i = 0; i < 20000; ++i) {
        const Panel a = any_panel();
        const Panel b = any_panel();
        double margin = 1.0;
        const bool expected_ab = pierces(rectangle(a), rectangle(b), margin);
        const bool expected_ba = pierces(rectangle(b), rectangle(a), margin);
        if (margin < 1e-4) continue;  // Touching, or nearly so.
        const bool expected = expected_ab || expected_ba;
        ++(expected ? crossing : apart);
        if (faces_cross(a, b) != expected) {
            INFO("pair " << i);
            CHECK(faces_cross(a, b) == expected);
        }
    }
    CHECK(crossing > 2000);
    CHECK(apart > 2000);
}
