// Displays that really turn: with jitter, and pulses that are missed or come twice, they find the rotation, show what
// the host sent, and light it in its place.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "driver/display/toml.h"
#include "driver/host/session.h"
#include "sim/make_sim.h"
#include "tests/catch.h"
#include "tests/roundtrip/rig.h"

using namespace xorvox;
using namespace xorvox::test;
using sim::make_sim;
using sim::MakeSim;
using sim::SeenStrobe;
using sim::SimRig;

namespace {

constexpr std::uint64_t kSecond = 1'000'000'000;

/// How far the phase may be off, in intervals between pulses; tests/unit/device/rotation.cpp holds the tracker to it.
constexpr double kTolerance = 0.1;

/// As vortex is built: two HUB75 panels back to back, two bits a channel shown of the three on the wire.
MakeSim small_vortex() {
    return make_sim()
        .rotating(72)
        .panel(32, 16)
        .panel(32, 16)
        .cycles_per_second(10.0)
        .format(PixelFormat::Rgb332)
        .scan({.driver = DriverChip::Hub75,
               .pixel_clock_hz = 20'000'000,
               .latch_ns = 100,
               .min_on_ns = 500,
               .rise_ns = 50,
               .fall_ns = 50,
               .row_groups = 8,
               .bit_planes = 2});
}

/// Lit on its way up and down.
MakeSim small_sweep() {
    return make_sim()
        .swept(20, MotionProfile::Sine)
        .panel(15, 9)
        .format(PixelFormat::Rgb111)
        .change([](DisplayDescription& display) {
            display.motion.both_ways = true;
            display.motion.dead_zone = 0.1;
        });
}

std::vector<std::pair<std::string, MakeSim>> displays() {
    return {{"small vortex", small_vortex()},
            {"candle", make_sim().display(load_display("candle").value())},
            {"small sweep", small_sweep()}};
}

/// The bits of the strobes, by slice, row group and plane: those of all rows, one after the other.
using Bits = std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, std::set<std::vector<std::byte>>>;

/// A host that shows a mesh on a display, and all that was seen of it from then on.
class Showing {
public:
    explicit Showing(const MakeSim& sim)
        : rig(sim.build().value()),
          picture_(paint(rig.display(), lopsided(0))),
          session_(rig.host_end(), rig.display()) {
        rig.set_host([this](std::uint64_t now_ns) { (void)session_.poll(now_ns); });
        rig.watch([this](const sim::Strobe& strobe) { look(strobe); });
        REQUIRE(session_.submit(picture_.frame) == Status::Ok);
    }
    Showing(const Showing&) = delete;

    bool until_presented() {
        return rig.run_until([&] { return session_.last_presented() != 0; }, 4 * kSecond);
    }
    const host::Session& session() const { return session_; }
    const Picture& picture() const { return picture_; }
    const Bits& bits() const { return bits_; }
    std::uint32_t faults() const { return rig.simulator().device().faults(); }

    /// The most that a strobe was off its slice, in cycles.
    double worst() const {
        double most = 0.0;
        for (const SeenStrobe& strobe : rig.strobes()) most = std::max(most, std::abs(strobe.slices_off));
        const DisplayDescription& display = rig.display();
        const double sweeps =
            display.kind == DisplayKind::SweptPlane ? 0.5 * (1.0 - 2.0 * display.motion.dead_zone) : 1.0;
        return most * sweeps / display.slices;
    }
    double tolerance() const { return kTolerance / rig.display().sync.index_pulses; }

    SimRig rig;

private:
    void look(const sim::Strobe& strobe) {
        std::vector<std::byte> bits;
        const DisplayDescription& display = rig.display();
        for (std::uint32_t p = 0; p < display.panel_count; ++p) {
            const Panel& panel = display.panels[p];
            const bool levels = strobe.plane == sim::Strobe::kLevels;
            const std::size_t length = levels ? row_bytes(panel, display.format) : (panel.columns + 7u) / 8u;
            for (std::uint32_t row = 0; row < panel.rows; ++row) {
                if (strobe.row_group != sim::Strobe::kAllRows && row % display.scan.row_groups != strobe.row_group)
                    continue;
                for (std::uint32_t channel = 0; channel < (levels ? 1 : channel_count(display.format)); ++channel) {
                    const std::byte* first = strobe.panels[p].at(row, channel);
                    bits.insert(bits.end(), first, first + length);
                }
            }
        }
        bits_[{strobe.slice, strobe.row_group, strobe.plane}].insert(std::move(bits));
    }

    Picture picture_;
    host::Session session_;
    Bits bits_;
};

}  // namespace

TEST_CASE("with jitter, missed and doubled pulses a display shows the frame, every strobe within its tolerance",
          "[roundtrip][turning]") {
    const std::uint64_t seed = GENERATE(1u, 2u, 3u);
    for (auto& [name, sim] : displays()) {
        CAPTURE(name, seed);
        Showing steady(sim);
        REQUIRE(steady.until_presented());
        steady.rig.run_for(kSecond);
        CHECK(steady.worst() < 1e-9);

        Showing turning(sim.jitter(0.01).missed(0.05).doubled(0.05).noise(0.002).seed(seed));
        REQUIRE(turning.until_presented());
        turning.rig.run_for(6 * kSecond);
        CHECK(turning.faults() == 0);
        CHECK(turning.session().state() == host::SessionState::Ready);
        const sim::DisplaySamples samples(turning.rig.display());
        CHECK((samples.rebuild(turning.rig.simulator().light()) == samples.faithful(turning.picture().codes)));
        CHECK(turning.bits() == steady.bits());
        REQUIRE(turning.rig.strobes().size() > 1000);
        CHECK(turning.worst() < turning.tolerance());
        const sim::Timing& timing = turning.rig.simulator().timing().timing();
        CHECK(timing.presented == 1);
        CHECK(timing.locked == 1);
        CHECK(timing.lost == 0);
        CHECK(timing.torn == 0);
    }
}

TEST_CASE("a display that stalls is dark with a fault that its host hears of, and nothing is lit after it",
          "[roundtrip][turning]") {
    for (auto& [name, sim] : displays()) {
        CAPTURE(name);
        Showing stalling(sim.jitter(0.01).stall_at(3.0));
        REQUIRE(stalling.until_presented());
        stalling.rig.run_for(3 * kSecond - stalling.rig.now_ns());
        CHECK(stalling.faults() == 0);
        REQUIRE(stalling.rig.run_until([&] { return stalling.faults() != 0; }, kSecond));
        const std::uint64_t dark_ns = stalling.rig.now_ns();
        const std::uint32_t stands = wire::fault_bit(wire::Fault::Stall) | wire::fault_bit(wire::Fault::LostIndex);
        CHECK((stalling.faults() & stands) != 0);
        stalling.rig.run_for(3 * kSecond);
        for (const SeenStrobe& strobe : stalling.rig.strobes()) REQUIRE(strobe.off_ns <= dark_ns);
        CHECK((stalling.session().device_status().faults & stands) != 0);
        CHECK(stalling.rig.simulator().light().flashes.empty());
    }
}

TEST_CASE("two runs with one seed are equal strobe for strobe, with another one they are not", "[roundtrip][turning]") {
    for (auto& [name, sim] : displays()) {
        CAPTURE(name);
        const auto strobes = [&sim = sim](std::uint64_t seed) {
            Showing turning(sim.jitter(0.01).missed(0.05).doubled(0.05).seed(seed));
            turning.rig.run_for(3 * kSecond);
            return turning.rig.strobes();
        };
        const std::vector<SeenStrobe> first = strobes(1);
        REQUIRE(first.size() > 500);
        CHECK((strobes(1) == first));
        CHECK_FALSE((strobes(2) == first));
    }
}
