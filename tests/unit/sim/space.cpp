#include "sim/space.h"

#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "driver/display/lattice.h"
#include "sim/optics.h"
#include "tests/catch.h"
#include "tests/unit/sim/displays.h"

namespace xorvox {
namespace {

using namespace test;

/// What all samples of a display stand for together.
double total_mm3(const DisplayDescription& display) {
    const DisplayLattice owner(display);
    const Lattice lattice = owner.view();
    const sim::SampleVolumes volumes = sim::sample_volumes(display);
    double total = 0.0;
    for (std::uint32_t k = 0; k < lattice.nz; ++k) {
        for (std::uint32_t x = 0; x < lattice.nx; ++x) total += lattice.ny * volumes.at_x(x) * volumes.at_k(k);
    }
    return total;
}

TEST_CASE("the samples of a box fill it") {
    CHECK(total_mm3(stack_of(5, 4, 3)) == Approx(10.0 * 12.0 * 21.0));
    CHECK(total_mm3(helix_of(5, 4, 9, 2)) == Approx(10.0 * 12.0 * 40.0));
    for (const auto profile : {MotionProfile::Constant, MotionProfile::Sine, MotionProfile::Table}) {
        DisplayDescription swept = swept_of(5, 4, 16, profile);
        CHECK(total_mm3(swept) == Approx(10.0 * 12.0 * 60.0));
        swept.motion.dead_zone = 0.25;
        const double lit_mm = sim::plane_height_mm(swept, 15.5) - sim::plane_height_mm(swept, -0.5);
        CHECK(lit_mm < 59.0);
        CHECK(total_mm3(swept) == Approx(10.0 * 12.0 * lit_mm));
    }
    constexpr double kHeights[] = {0.0, 2.0, 8.0};
    DisplayDescription uneven = stack_of(5, 4, 3);
    uneven.plane_heights_mm = kHeights;
    CHECK(total_mm3(uneven) == Approx(10.0 * 12.0 * (2.0 + 4.0 + 6.0)));
}

TEST_CASE("the samples of a panel that turns once fill its cylinder twice") {
    const double disc = 2.0 * std::numbers::pi;
    for (const std::uint16_t columns : {std::uint16_t{8}, std::uint16_t{9}}) {
        DisplayDescription rotor = rotor_of(columns, 5, 7, PixelFormat::Mono1, 1);  // pixels of 2 mm by 4 mm
        CHECK(total_mm3(rotor) == Approx(disc * columns * columns * 20.0));
        CHECK(sim::spacing_of(rotor).slice_rad == Approx(disc / 7.0));
        rotor.sweep_deg = 180.0;
        CHECK(total_mm3(rotor) == Approx(disc / 2.0 * columns * columns * 20.0));
        CHECK(sim::spacing_of(rotor).slice_rad == Approx(disc / 14.0));
        rotor.panels[0].tilt_deg = -60.0;
        CHECK(total_mm3(rotor) == Approx(disc / 4.0 * columns * columns * 20.0));
        rotor.panels[0].tilt_deg = 0.0;
        rotor.panels[0].turned = 3;  // 5 columns 4 mm apart, as many rows of 2 mm as there were columns
        CHECK(total_mm3(rotor) == Approx(disc / 2.0 * 100.0 * 2.0 * columns));
    }
}

TEST_CASE("voxels of a picture are as far apart as the samples") {
    const sim::Spacing stack = sim::spacing_of(stack_of(5, 4, 3));
    CHECK(stack.across_mm == 2.0);
    CHECK(stack.along_mm == 3.0);
    CHECK(stack.up_mm == Approx(7.0));
    CHECK(sim::spacing_of(helix_of(5, 4, 8, 3)).up_mm == 5.0);
    CHECK(sim::spacing_of(swept_of(5, 4, 6, MotionProfile::Sine)).up_mm == Approx(10.0));
    // Two panels, each of which passes every place of its cylinder twice.
    DisplayDescription rotor = rotor_of(16, 4, 90);
    rotor.panels[0].offset_mm = rotor.panels[1].offset_mm = 0.0;
    CHECK(sim::spacing_of(rotor).times_covered == Approx(4.0));
    CHECK(sim::spacing_of(rotor).along_mm == Approx(16.0 * 2.0 * std::numbers::pi / 90.0));
}

TEST_CASE("free points are as far apart as if they filled their box, their sheet or their line evenly") {
    std::vector<PointMm> points;
    DisplayDescription display = points_of();
    const auto distance = [&] {
        display.panels[0].columns = static_cast<std::uint16_t>(points.size());
        display.panels[0].rows = 1;
        display.panels[0].column_pitch_mm = 7.0;
        display.points = points;
        return sim::spacing_of(display).across_mm;
    };
    points.push_back({1.0, 2.0, 3.0});
    CHECK(distance() == 7.0);
    for (int i = 1; i < 6; ++i) points.push_back({1.0 + 3.0 * i, 2.0, 3.0});
    CHECK(distance() == Approx(3.0));
    for (int i = 6; i < 36; ++i) points.push_back({1.0 + 3.0 * (i % 6), 2.0, 3.0 + 3.0 * (i / 6)});
    CHECK(distance() == Approx(3.0));
    for (int i = 36; i < 216; ++i)
        points.push_back({1.0 + 3.0 * (i % 6), 2.0 + 3.0 * (i / 36), 3.0 + 3.0 * (i / 6 % 6)});
    CHECK(distance() == Approx(3.0));
}

}  // namespace
}  // namespace xorvox
