// The simulator in time: pulses, orders and strobes from event to event.
#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "driver/device/scan/pins.h"
#include "driver/display/toml.h"
#include "sim/make_sim.h"
#include "tests/catch.h"
#include "tests/unit/sim/displays.h"

namespace xorvox {
namespace {

using namespace test;
using sim::make_sim;
using sim::SeenStrobe;
using sim::SimRig;

constexpr std::uint64_t kSecond = 1'000'000'000;
constexpr std::uint64_t kMs = 1'000'000;

SimRig built(const sim::MakeSim& sim) {
    auto rig = sim.build();
    INFO((rig ? "" : rig.error().message));
    REQUIRE(rig.has_value());
    return std::move(*rig);
}

SimRig showing(const sim::MakeSim& sim) {
    SimRig rig = built(sim);
    rig.show(std::vector<std::byte>(frame_bytes(rig.display()), std::byte{0xff}));
    return rig;
}

std::uint32_t faults(const SimRig& rig) {
    return rig.simulator().device().faults();
}

/// 36 slices of 1388.9 µs: 20 turns a second.
sim::MakeSim small_rotor() {
    return make_sim().rotating(36).panel(12, 6);
}

TEST_CASE("a rotor that is heard is followed: dark at first, then every strobe in its slice") {
    const std::vector<sim::MakeSim> sims{small_rotor().rotor(),
                                         small_rotor().rotor().index_pulses(4),
                                         small_rotor().encoder(1024).rotor(),
                                         small_rotor().index_phase(0.3).rotor(),
                                         small_rotor().spin_up(8.0).index_phase(0.7),
                                         make_sim().swept(10).panel(8, 6).rotor(),
                                         make_sim().helix(12, 2).panel(8, 8).rotor()};
    for (std::size_t i = 0; i < sims.size(); ++i) {
        CAPTURE(i);
        SimRig rig = showing(sims[i]);
        rig.run_for(20 * kMs);
        CHECK(rig.strobes().empty());  // Five intervals have not passed.
        CHECK(rig.simulator().timing().timing().dark_ns[static_cast<int>(device::Dark::NotLocked)] == 20 * kMs);
        rig.run_for(10 * kSecond);
        rig.forget();
        rig.run_for(kSecond);
        CHECK(faults(rig) == 0);
        REQUIRE(rig.strobes().size() > 150);
        for (const SeenStrobe& strobe : rig.strobes()) REQUIRE(std::abs(strobe.slices_off) < 1e-3);
    }
}

TEST_CASE("a slice is lit when it begins and for as long as it lasts") {
    SimRig rig = showing(make_sim().stacked(4).panel(8, 8).cycles_per_second(50.0));
    rig.run_for(60 * kMs);
    REQUIRE(rig.strobes().size() >= 5);
    for (std::size_t i = 0; i < 5; ++i) {
        const SeenStrobe& strobe = rig.strobes()[i];
        CHECK(strobe.slice == i % 4);
        CHECK(strobe.on_ns == 20 * kMs + i * 5 * kMs);  // It was shown at the first boundary.
        CHECK(strobe.off_ns == 20 * kMs + (i + 1) * 5 * kMs);
        CHECK(strobe.cycles == Approx(1.125 + 0.25 * static_cast<double>(i)));
    }
}

TEST_CASE("strobes do not depend on how often the simulator is polled") {
    const auto strobes_of = [](std::uint64_t step_ns) {
        SimRig rig = showing(small_rotor().jitter(0.02).missed(0.05).doubled(0.05).noise(0.01));
        for (std::uint64_t at = 0; at < 2 * kSecond; at += step_ns) rig.run_for(step_ns);
        return rig.strobes();
    };
    const std::vector<SeenStrobe> strobes = strobes_of(kSecond / 2);
    REQUIRE(strobes.size() > 500);
    CHECK(strobes_of(kSecond / 2) == strobes);
    // Sixteen polls a millisecond; only packets and the watchdog depend on it.
    const std::vector<SeenStrobe> finely = strobes_of(62'500);
    CHECK(finely == strobes);
}

TEST_CASE("a rotor that stalls goes dark with a fault, and stays dark") {
    SimRig rig = showing(small_rotor().stall_at(2.0));
    rig.run_for(2 * kSecond);
    CHECK(faults(rig) == 0);
    CHECK_FALSE(rig.strobes().empty());
    const bool lost = rig.run_until([&] { return faults(rig) != 0; }, kSecond);
    CHECK(lost);
    CHECK((faults(rig) & (wire::fault_bit(wire::Fault::Stall) | wire::fault_bit(wire::Fault::LostIndex))) != 0);
    rig.run_for(2 * kMs);
    rig.forget();
    rig.run_for(10 * kSecond);
    CHECK(rig.strobes().empty());
    CHECK(rig.simulator().timing().timing().lost == 1);
}

TEST_CASE("a rotor too fast, too slow or never found lights nothing") {
    const auto seen = [](double speed) {
        SimRig rig = showing(small_rotor().speed(speed));
        rig.run_for(3 * kSecond);
        return std::pair(rig.strobes().size(), faults(rig));
    };
    CHECK(seen(1.4) == std::pair(std::size_t{0}, wire::fault_bit(wire::Fault::Overspeed)));
    CHECK(seen(0.4).first == 0);
    CHECK(seen(1.2).first > 500);
    CHECK(seen(0.6).first > 500);
}

TEST_CASE("where the index mark is at another phase, the display is that much further") {
    DisplayDescription marked = rotor_of(8, 4, 12);
    marked.sync = {.index = IndexSource::Pulses, .index_phase = 0.25};
    DisplayDescription described = marked;
    described.sync.index_phase = 0.0;
    sim::MakeSim sim = make_sim().display(described).built_like(marked);
    const bool heard = GENERATE(false, true);
    if (heard) sim.rotor();
    SimRig rig = showing(sim);
    rig.run_for(kSecond);
    REQUIRE(rig.strobes().size() > 100);
    for (const SeenStrobe& strobe : rig.strobes())
        REQUIRE(strobe.slices_off == Approx(2.5));  // 3 from middle to middle
    CHECK(rig.simulator().cycles_at(0) == 0.25);
}

TEST_CASE("nobody watches and no rotor: the display costs as much as its boundaries") {
    auto made = sim::Simulator::make(small_rotor().build().value().display(), Link{});
    REQUIRE(made.has_value());
    (void)made->poll(1'000'000 * kSecond);
    CHECK(made->next_boundary_ns() == 1'000'000 * kSecond + 50 * kMs);
    CHECK(made->cycles_at(1'000'000 * kSecond) == 2e7);
}

/// A cube of 74HC595, for which there are pins.
sim::MakeSim cube() {
    return make_sim().stacked(4).panel(8, 8).scan(
        {.driver = DriverChip::ShiftRegister595, .pixel_clock_hz = 1'000'000, .latch_ns = 1000, .min_on_ns = 1000});
}

TEST_CASE("pins are seen with edges only, and give the same strobes") {
    SimRig fast = showing(cube());
    SimRig exact = showing(cube().fidelity(sim::Fidelity::Edges));
    std::uint64_t changes[2] = {0, 0};
    fast.simulator().watch_pins([&](std::uint64_t, LineMask, LineMask) { ++changes[0]; });
    exact.simulator().watch_pins([&](std::uint64_t, LineMask, LineMask) { ++changes[1]; });
    fast.run_for(50 * kMs);
    exact.run_for(50 * kMs);
    CHECK(changes[0] == 0);
    CHECK(changes[1] > 1000);
    REQUIRE(fast.strobes().size() > 10);
    CHECK(exact.strobes() == fast.strobes());
}

TEST_CASE("a display without pins is refused where edges are asked for") {
    const auto rig = small_rotor().fidelity(sim::Fidelity::Edges).build();
    REQUIRE_FALSE(rig.has_value());
    CHECK(rig.error().message == sim::make_edge_scan(small_rotor().build().value().display(), {}, {}).error().message);
}

TEST_CASE("faults of the wiring are in the strobes") {
    const auto lit_in = [](const sim::MakeSim& sim) {
        SimRig rig = built(sim);
        std::vector<std::byte> page = dark_page(rig.display());
        set_pixel(rig.display(), page, {.column = 1}, 1);
        std::vector<unsigned> bytes;
        rig.watch(
            [&](const sim::Strobe& strobe) { bytes.push_back(std::to_integer<unsigned>(*strobe.panels[0].at(0, 0))); });
        rig.show(page);
        rig.run_for(30 * kMs);
        REQUIRE_FALSE(bytes.empty());
        return bytes[0];
    };
    CHECK(lit_in(cube()) == 0x02);
    CHECK(lit_in(cube().fault({.kind = sim::FaultKind::Mirrored})) == 0x40);
}

TEST_CASE("a sink that is set later begins with the next order, and an empty one ends it") {
    SimRig rig = showing(cube());
    rig.run_for(33 * kMs);
    std::size_t seen = 0;
    rig.simulator().watch([&](const sim::Strobe&) { ++seen; });
    rig.run_for(20 * kMs);
    CHECK(seen > 4);
    const std::size_t before = seen;
    rig.simulator().watch({});
    rig.run_for(20 * kMs);
    CHECK(seen == before);
}

}  // namespace
}  // namespace xorvox
