#include <cmath>
#include <utility>

#include "driver/display/lattice.h"
#include "driver/display/toml.h"
#include "tests/catch.h"

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

/// The LED as description.h draws it, with the C library's functions.
glm::dvec3 drawn(const DisplayDescription& display, std::uint32_t slice, std::uint32_t p, std::uint32_t row,
                 std::uint32_t column) {
    const Panel& panel = display.panels[p];
    const double turn = 6.283185307179586;
    const double phase = turn * (slice + 0.5) / display.slices;
    const double theta = (display.clockwise ? -phase : phase) + panel.angle_deg / 360.0 * turn;
    const double along = panel.shift_mm + (column - (panel.columns - 1) / 2.0) * panel.column_pitch_mm;
    return {std::cos(theta) * along + std::sin(theta) * panel.offset_mm,
            std::sin(theta) * along - std::cos(theta) * panel.offset_mm,
            panel.lift_mm + ((panel.rows - 1) / 2.0 - row) * panel.row_pitch_mm};
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
                    const glm::dvec3 led = drawn(display, slice, x < 4 ? 0 : 1, row, x < 4 ? x : x - 4);
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
    for (const auto& display : {load_display("cube16-ws2812").value(), load_display("vortex").value(), two}) {
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
    CHECK(extent(load_display("vortex").value()).radius_mm == Approx(std::hypot(160.0, 5.0)));
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
