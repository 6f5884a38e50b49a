#include "sim/make_sim.h"

#include <string>
#include <utility>
#include <vector>

#include "driver/display/toml.h"
#include "tests/catch.h"
#include "tests/unit/sim/displays.h"

namespace xorvox {
namespace {

using namespace test;
using sim::make_sim;
using sim::SeenStrobe;
using sim::SimRig;

constexpr std::uint64_t kSecond = 1'000'000'000;

SimRig built(const sim::MakeSim& sim) {
    auto rig = sim.build();
    INFO((rig ? "" : rig.error().message));
    REQUIRE(rig.has_value());
    return std::move(*rig);
}

/// Every bit is set.
std::vector<std::byte> full_page(const SimRig& rig) {
    return std::vector<std::byte>(frame_bytes(rig.display()), std::byte{0xff});
}

TEST_CASE("one line makes a display of each kind that is valid and shows a page") {
    const sim::MakeSim sims[] = {make_sim().rotating(36).panel(12, 6), make_sim().stacked(5).panel(8, 8),
                                 make_sim().swept(10).panel(8, 6), make_sim().helix(12, 2).panel(8, 8),
                                 make_sim().rotating(36).panel(12, 6).panel(12, 6).format(PixelFormat::Rgb332)};
    for (const sim::MakeSim& sim : sims) {
        SimRig rig = built(sim);
        CAPTURE(static_cast<int>(rig.display().kind));
        CHECK(rig.strobes().empty());
        const std::uint32_t frame = rig.show(full_page(rig));
        CHECK(frame == 1);
        CHECK(rig.run_until([&] { return rig.simulator().device().shown().frame == frame; }, kSecond));
        rig.forget();
        rig.run_for(2 * cycle_ns(rig.display()));
        std::vector<int> lit(rig.display().slices);
        for (const SeenStrobe& strobe : rig.strobes()) {
            REQUIRE(strobe.frame == frame);
            REQUIRE(strobe.off_ns > strobe.on_ns);
            REQUIRE(strobe.slices_off == 0.0);
            ++lit.at(strobe.slice);
        }
        CHECK(*std::min_element(lit.begin(), lit.end()) >= 1);
        CHECK(rig.simulator().timing().timing().presented == 1);
    }
}

TEST_CASE("the panels of a rotor stand evenly about its axis") {
    const SimRig rig = built(make_sim().rotating(36).panel(12, 6, 3.0).panel(10, 6).panel(8, 6));
    CHECK(rig.display().panel_count == 3);
    CHECK(rig.display().panels[1].columns == 10);
    CHECK(rig.display().panels[2].angle_deg == Approx(240.0));
    CHECK(built(make_sim().rotating(36).panel(12, 6, 3.0).panel(12, 6)).display().panels[1].offset_mm == 3.0);
    for (std::uint16_t panels = 2; panels <= 8; ++panels) {
        sim::MakeSim sim = make_sim().rotating(36);
        for (std::uint16_t p = 0; p < panels; ++p) sim.panel(12, 6);
        CHECK(built(sim).display().panel_count == panels);
    }
    CHECK(built(make_sim().rotating(36).panel(12, 6)).display().panels[0].offset_mm == 0.0);
}

TEST_CASE("a display that cannot be made is refused in the words of its rules") {
    const auto refused = [](const sim::MakeSim& sim) {
        const auto rig = sim.build();
        REQUIRE_FALSE(rig.has_value());
        return rig.error().message;
    };
    CHECK_THAT(refused(make_sim()), Catch::Contains("slices"));
    CHECK_THAT(refused(make_sim().stacked(5)), Catch::Contains("columns"));
    CHECK_THAT(refused(make_sim().rotating(0).panel(8, 8)), Catch::Contains("slices"));
    CHECK_THAT(refused(make_sim().stacked(5).panel(8, 8).panel(8, 8)), Catch::Contains("panel"));
    CHECK_THAT(refused(make_sim().rotating(36).panel(8, 8).cycles_per_second(-1.0)),
               Catch::Contains("cycles_per_second"));
    auto too_many = make_sim().rotating(36);
    for (int i = 0; i < 9; ++i) too_many.panel(8, 8);
    CHECK_THAT(refused(too_many), Catch::Contains("9"));
    CHECK_THAT(refused(make_sim().rotating(36).panel(8, 8).built_like(rotor_of(8, 4, 36, PixelFormat::Mono1, 1))),
               Catch::Contains("rows 4 instead of 8"));
}

TEST_CASE("a description of one's own is taken as it is, and can be changed") {
    DisplayDescription display = rotor_of(8, 4, 12);
    const SimRig rig = built(make_sim().display(display).index_pulses(3).index_phase(0.5).change(
        [](DisplayDescription& made) { made.clockwise = true; }));
    display.clockwise = true;
    CHECK(geometry_digest(rig.display()) == geometry_digest(display));
    CHECK(rig.display().sync.index_pulses == 3);
    CHECK(rig.display().sync.index_phase == 0.5);
    CHECK(built(make_sim().display(display).encoder(512)).display().sync.index == IndexSource::Encoder);
}

TEST_CASE("a page of another size is not sent") {
    SimRig rig = built(make_sim().stacked(5).panel(8, 8));
    CHECK(rig.show({}) == 0);
    CHECK(rig.show(std::vector<std::byte>(41)) == 0);
}

TEST_CASE("a rig that shows a page is a host that never falls silent") {
    SimRig rig = built(make_sim().stacked(5).panel(8, 8));
    rig.show(full_page(rig));
    rig.run_for(5 * kSecond);
    CHECK(rig.simulator().device().faults() == 0);
    CHECK(rig.now_ns() == 5 * kSecond);
    rig.show(full_page(rig));
    rig.run_for(kSecond);
    CHECK(rig.simulator().device().shown().frame == 2);
}

TEST_CASE("a page larger than a packet and the link is sent whole") {
    SimRig rig = built(make_sim().stacked(64).panel(128, 128).format(PixelFormat::Rgb888).cycles_per_second(5.0));
    rig.show(full_page(rig));
    CHECK(rig.run_until([&] { return rig.simulator().device().shown().frame == 1; }, kSecond));
}

TEST_CASE("waiting ends when it is done, or in time") {
    SimRig rig = built(make_sim().stacked(5).panel(8, 8));
    CHECK(rig.run_until([&] { return rig.now_ns() >= 7'300'000; }, kSecond));
    CHECK(rig.now_ns() == 8'000'000);
    CHECK_FALSE(rig.run_until([] { return false; }, 1'500'000));
    CHECK(rig.now_ns() == 9'500'000);
}

TEST_CASE("how far off its slice a strobe is, is told in slices") {
    const DisplayDescription rotor = rotor_of(8, 4, 10);
    CHECK(sim::slices_off(rotor, 3, 7.3) == Approx(0.0).margin(1e-9));
    CHECK(sim::slices_off(rotor, 3, 7.35) == 0.0);
    CHECK(sim::slices_off(rotor, 3, 7.45) == Approx(0.5));
    CHECK(sim::slices_off(rotor, 3, 7.25) == Approx(-0.5));
    CHECK(sim::slices_off(rotor, 0, 6.95) == Approx(-0.5));
    CHECK(sim::slices_off(rotor, 9, 7.05) == Approx(0.5));

    DisplayDescription plane = swept_of(5, 4, 10, MotionProfile::Constant);
    plane.motion.dead_zone = 0.1;  // Of half a cycle: up from 0.05 to 0.45, a slice takes 0.04.
    CHECK(sim::slices_off(plane, 0, 3.07) == 0.0);
    CHECK(sim::slices_off(plane, 0, 3.03) == Approx(-0.5));
    CHECK(sim::slices_off(plane, 9, 3.57) != 0.0);
    plane.motion.both_ways = true;
    CHECK(sim::slices_off(plane, 9, 3.57) == 0.0);
    CHECK(sim::slices_off(plane, 9, 3.61) == Approx(0.5));
}

TEST_CASE("a rig can be moved while it runs") {
    SimRig first = built(make_sim().rotating(36).panel(12, 6));
    first.show(full_page(first));
    first.run_for(kSecond / 10);
    const std::size_t seen = first.strobes().size();
    SimRig second = std::move(first);
    second.run_for(kSecond / 10);
    CHECK(second.strobes().size() > seen);
}

}  // namespace
}  // namespace xorvox
