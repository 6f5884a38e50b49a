#include <cmath>
#include <utility>

#include "driver/display/lattice.h"
#include "driver/display/toml.h"
#include "driver/display/trigonometry.h"
#include "tests/catch.h"
#include "tests/displays.h"

using namespace xorvox;

namespace {

DisplayDescription rotor(std::uint32_t slices) {
    DisplayDescription display;
    display.kind = DisplayKind::RotatingPanel;
    display.slices = slices;
    display.cycles_per_second = 10;
    display.panels[0] = {.columns = 4, .rows = 3, .column_pitch_mm = 2, .row_pitch_mm = 5};
    return display;
}

void check_place(const glm::dvec3& place, double x, double y, double z) {
    CHECK(place.x == Approx(x).margin(1e-12));
    CHECK(place.y == Approx(y).margin(1e-12));
    CHECK(place.z == Approx(z).margin(1e-12));
}

}  // namespace

TEST_CASE("stacked planes are a regular lattice centred at the origin, plane 0 lowest") {
    DisplayDescription display;
    display.slices = 5;
    display.plane_pitch_mm = 10;
    display.cycles_per_second = 60;
    display.panels[0] = {.columns = 4, .rows = 3, .column_pitch_mm = 2, .row_pitch_mm = 3};
    const DisplayLattice lattice(display);
    const Lattice view = lattice.view();
    CHECK(view.is_regular());
    CHECK(view.nx == 4);
    CHECK(view.ny == 3);
    CHECK(view.nz == 5);
    check_place(sample_position(view, 0, 0, 0), -3, -3, -20);
    check_place(sample_position(view, 3, 1, 2), 3, 0, 0);
    check_place(sample_position(view, 1, 2, 4), -1, 3, 20);
    CHECK(validate(view) == Status::Ok);

    const DisplayExtent box = extent(display);
    check_place(box.lower, -4, -4.5, -25);
    check_place(box.upper, 4, 4.5, 25);
    CHECK(box.radius_mm == 0.0);
}

TEST_CASE("a rotating panel stands at the middle of each slice, row 0 on top") {
    const auto display = rotor(2);  // At a quarter and at three quarters of a turn.
    const DisplayLattice lattice(display);
    const Lattice view = lattice.view();
    CHECK(view.nx == 4);
    CHECK(view.ny == 2);
    CHECK(view.nz == 3);
    check_place(sample_position(view, 3, 0, 2), 0, 3, 5);    // Column 3 of the top row, along +y.
    check_place(sample_position(view, 3, 1, 0), 0, -3, -5);  // Half a turn later, bottom row.
    check_place(sample_position(view, 0, 0, 1), 0, -3, 0);
    CHECK(validate(view) == Status::Ok);
}

TEST_CASE("clockwise runs the other way") {
    auto display = rotor(2);
    display.clockwise = true;
    const DisplayLattice lattice(display);
    check_place(sample_position(lattice.view(), 3, 0, 1), 0, -3, 0);
    check_place(sample_position(lattice.view(), 3, 1, 1), 0, 3, 0);
}

TEST_CASE("shift, offset, lift and angle move a panel as drawn") {
    auto display = rotor(2);
    display.panels[0].shift_mm = 1;
    display.panels[0].offset_mm = 7;
    display.panels[0].lift_mm = 100;
    display.panels[0].angle_deg = -90;  // With the quarter turn of slice 0: in the xz plane, normal -y.
    const DisplayLattice lattice(display);
    check_place(sample_position(lattice.view(), 0, 0, 2), -2, -7, 105);
    check_place(sample_position(lattice.view(), 3, 0, 0), 4, -7, 95);
    check_place(sample_position(lattice.view(), 3, 1, 1), -4, 7, 100);
}

TEST_CASE("the back panel of a pair is the front one half a turn on") {
    const auto display = load_display("vortex").value();
    const DisplayLattice lattice(display);
    const Lattice view = lattice.view();
    REQUIRE(view.nx == 256);
    REQUIRE(view.ny == 360);
    REQUIRE(view.nz == 64);
    for (std::uint32_t slice = 0; slice < 180; ++slice) {
        for (std::uint32_t column = 0; column < 128; ++column) {
            const glm::dvec3 front = sample_position(view, column, slice + 180, 5);
            const glm::dvec3 back = sample_position(view, 128 + column, slice, 5);
            REQUIRE(std::abs(front.x - back.x) < 1e-11);
            REQUIRE(std::abs(front.y - back.y) < 1e-11);
        }
    }
}

TEST_CASE("sines, cosines and angles are those of the C library, but for the last bits") {
    for (int i = -1000; i <= 1000; ++i) {
        const double turns = i / 700.0;
        const glm::dvec2 place = display::direction(turns);
        REQUIRE(std::abs(place.x - std::cos(turns * 6.283185307179586)) < 4e-15);
        REQUIRE(std::abs(place.y - std::sin(turns * 6.283185307179586)) < 4e-15);
        const double angle = display::angle_turns(place * (1.0 + i * i));
        REQUIRE(angle >= 0.0);
        REQUIRE(angle < 1.0);
        const double off = turns - angle;
        REQUIRE(std::abs(off - std::round(off)) < 1e-15);
    }
    CHECK(display::angle_turns({0, 0}) == 0.0);
    CHECK(display::angle_turns({1, 0}) == 0.0);
    CHECK(display::angle_turns({0, 2}) == 0.25);
    CHECK(display::angle_turns({-3, 0}) == 0.5);
    CHECK(display::angle_turns({0, -1}) == 0.75);
    CHECK(display::angle_turns({2, 2}) == 0.125);
    CHECK(display::angle_turns({1, -1e-300}) == 0.0);
}

TEST_CASE("every display's lattice is valid, has one sample a pixel, and each is inside the extent's box") {
    for (const DisplayDescription& display : test::odd_displays()) {
        INFO(std::string(display.name.view()));
        const DisplayLattice lattice(display);
        const Lattice view = lattice.view();
        REQUIRE(validate(view) == Status::Ok);
        CHECK(view.sample_count() == frame_pixels(display));
        CHECK(view.column_count() == lattice_columns(display));
        const DisplayExtent box = extent(display);
        for (std::uint32_t y = 0; y < view.ny; ++y) {
            for (std::uint32_t x = 0; x < view.nx; ++x) {
                for (std::uint32_t k = 0; k < view.nz; ++k) {
                    const glm::dvec3 place = sample_position(view, x, y, k);
                    for (int axis = 0; axis < 3; ++axis) {
                        REQUIRE(place[axis] >= box.lower[axis]);
                        REQUIRE(place[axis] <= box.upper[axis]);
                    }
                }
            }
        }
    }
}

TEST_CASE("panels that are mounted on their side or in a mirror keep the display upright, tilted ones do not") {
    CHECK(is_upright(test::upright_rotor(false, true, 1)));
    CHECK(is_upright(test::upright_rotor(false, false, 2)));
    DisplayDescription display = test::upright_rotor(false, false, 0);
    display.panels[1].lift_mm += 1.0;
    CHECK_FALSE(is_upright(display));
    display = test::upright_rotor(false, false, 0);
    display.panels[1].tilt_deg = -1.0;
    CHECK_FALSE(is_upright(display));
    display = test::upright_rotor(false, false, 3);
    display.panels[0].skew_mm = 1.0;
    CHECK_FALSE(is_upright(display));
    display = test::upright_rotor(false, false, 0);
    display.panels[1].rows = 5;
    CHECK_FALSE(is_upright(display));
}

TEST_CASE("a sine sweep has its slices closer together at its ends, at constant speed they are a regular lattice") {
    for (const DisplayDescription& display : test::odd_displays()) {
        if (display.kind != DisplayKind::SweptPlane) continue;
        const DisplayLattice lattice(display);
        const Lattice view = lattice.view();
        CHECK(view.is_regular() == (display.motion.profile == MotionProfile::Constant));
        if (display.motion.profile != MotionProfile::Sine) continue;
        const double first = view.z[1] - view.z[0];
        const double middle = view.z[5] - view.z[4];
        CHECK(first < 0.6 * middle);
    }
}

TEST_CASE("every sample of every slice is where the drawing puts the LED") {
    for (const bool clockwise : {false, true}) {
        auto display = rotor(37);
        display.clockwise = clockwise;
        display.panel_count = 2;
        display.panels[0].offset_mm = 1.25;
        display.panels[1] = {.columns = 7, .rows = 3, .column_pitch_mm = 1.5, .row_pitch_mm = 5};
        display.panels[1].shift_mm = -0.75;
        display.panels[1].angle_deg = 123.25;
        const DisplayLattice lattice(display);
        const Lattice view = lattice.view();
        REQUIRE(view.nx == 11);
        for (std::uint32_t slice = 0; slice < 37; ++slice) {
            for (std::uint32_t x = 0; x < 11; ++x) {
                for (std::uint32_t row = 0; row < 3; ++row) {
                    const glm::dvec3 led = test::drawn(display, slice, x < 4 ? 0 : 1, row, x < 4 ? x : x - 4);
                    const glm::dvec3 sample = sample_position(view, x, slice, 2 - row);
                    REQUIRE(std::abs(led.x - sample.x) < 1e-12);
                    REQUIRE(std::abs(led.y - sample.y) < 1e-12);
                    REQUIRE(led.z == sample.z);
                }
            }
        }
    }
}

TEST_CASE("every sample is inside the extent's box, and the cylinder is what all panels sweep") {
    auto two = rotor(50);
    two.panel_count = 2;
    two.panels[1] = two.panels[0];
    two.panels[1].columns = 10;
    two.panels[1].offset_mm = 3;
    two.panels[0].lift_mm = two.panels[1].lift_mm = -7;
    const auto cube = load_display("cube16-ws2812").value();
    const auto vortex = load_display("vortex").value();
    for (const DisplayDescription& display : {DisplayDescription(cube), DisplayDescription(vortex), two}) {
        const DisplayLattice lattice(display);
        const Lattice view = lattice.view();
        const DisplayExtent box = extent(display);
        for (std::uint32_t y = 0; y < view.ny; ++y) {
            for (std::uint32_t x = 0; x < view.nx; ++x) {
                for (const std::uint32_t k : {0u, view.nz - 1}) {
                    const glm::dvec3 place = sample_position(view, x, y, k);
                    for (int axis = 0; axis < 3; ++axis) {
                        REQUIRE(place[axis] > box.lower[axis]);
                        REQUIRE(place[axis] < box.upper[axis]);
                    }
                }
            }
        }
    }
    const Panel& front = vortex.panels[0];
    CHECK(extent(vortex).radius_mm == Approx(std::hypot(64 * front.column_pitch_mm, front.offset_mm)));
    CHECK(extent(two).radius_mm == Approx(4.0));
    CHECK(extent(two).upper.x == Approx(std::hypot(10.0, 3.0)));
    CHECK(extent(two).lower.z == -7 - 7.5);
    CHECK(extent(two).upper.z == -7 + 7.5);
}

TEST_CASE("a view outlives a move of its lattice") {
    DisplayLattice lattice(rotor(8));
    const Lattice view = lattice.view();
    const glm::dvec3 before = sample_position(view, 1, 5, 2);
    const DisplayLattice moved = std::move(lattice);
    CHECK(sample_position(view, 1, 5, 2) == before);
    CHECK(moved.view().plan.data() == view.plan.data());
}
