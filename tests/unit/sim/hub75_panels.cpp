// HUB75 panels, by hand.
#include "sim/hub75_panels.h"

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/catch.h"
#include "tests/unit/sim/displays.h"
#include "tests/unit/sim/pins.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

constexpr std::uint32_t kClock = 0;
constexpr std::uint32_t kLatch = 1;
constexpr std::uint32_t kEnable = 2;
constexpr std::uint32_t kAddress = 3;
constexpr std::uint32_t kR1 = 8;
constexpr std::uint32_t kG1 = 9;
constexpr std::uint32_t kB1 = 10;
constexpr std::uint32_t kR2 = 11;
constexpr std::uint32_t kSecond = 6;  // From a line of connector 0 to that of connector 1.

DisplayDescription panel_of(std::uint16_t columns, std::uint16_t rows, std::uint16_t groups,
                            PixelFormat format = PixelFormat::Mono1, std::uint32_t panels = 1) {
    DisplayDescription display = rotor_of(columns, rows, 4, format, panels);
    display.scan.driver = DriverChip::Hub75;
    display.scan.row_groups = groups;
    return display;
}

/// Panels with a hand on their pins; output enable is high.
struct Bench {
    explicit Bench(const DisplayDescription& of)
        : display(of),
          model(of, device::Hub75Pins{},
                [this](const sim::Strobe& strobe) { strobes.push_back(lit_rows(display, strobe)); }),
          hand([this](std::uint64_t time_ns, LineMask levels,
                      LineMask changed) { model.on_pins(time_ns, levels, changed); },
               sim::line(kEnable)) {}

    /// Bits of one line, the first one first.
    void shift(std::uint32_t line, std::string_view bits) {
        for (const char bit : bits) {
            bit == '1' ? hand.high(line) : hand.low(line);
            hand.pulse(kClock);
        }
        hand.low(line);
    }
    void latch() { hand.pulse(kLatch); }
    std::vector<LitRows> flash() {
        hand.low(kEnable);
        hand.high(kEnable);
        return std::exchange(strobes, {});
    }
    /// The bits of the only strobe.
    std::string flash_bits() {
        const auto seen = flash();
        REQUIRE(seen.size() == 1);
        return seen[0].bits;
    }

    DisplayDescription display;
    std::vector<LitRows> strobes;
    sim::Hub75Panels model;
    Hand hand;
};

}  // namespace

TEST_CASE("a hub75 panel's first bit out is its first column", "[sim][hub75]") {
    Bench bench(panel_of(4, 2, 1));
    bench.shift(kR1, "1100");
    bench.latch();
    CHECK(bench.flash_bits() == "0.0:1100 0.1:0000");
}

TEST_CASE("a row of more columns than fit into bytes keeps its order", "[sim][hub75]") {
    Bench bench(panel_of(19, 2, 1));
    bench.shift(kR2, "1000000110000000101");
    bench.latch();
    CHECK(bench.flash_bits() == "0.0:0000000000000000000 0.1:1000000110000000101");
}

TEST_CASE("a shift without a latch changes nothing on a hub75 panel", "[sim][hub75]") {
    Bench bench(panel_of(4, 2, 1));
    bench.shift(kR1, "1111");
    CHECK(bench.flash_bits() == "0.0:0000 0.1:0000");
    bench.latch();
    bench.shift(kR1, "0000");
    CHECK(bench.flash_bits() == "0.0:1111 0.1:0000");
}

TEST_CASE("more bits than a register has go out at its end", "[sim][hub75]") {
    Bench bench(panel_of(4, 2, 1));
    bench.shift(kR1, "10110");
    bench.latch();
    CHECK(bench.flash_bits() == "0.0:0110 0.1:0000");
}

TEST_CASE("a hub75 panel takes the level that data had before the edge", "[sim][hub75]") {
    Bench bench(panel_of(4, 2, 1));
    bench.hand.set(sim::line(kR1) | sim::line(kClock), ~LineMask{0});
    bench.latch();
    CHECK(bench.flash_bits() == "0.0:0000 0.1:0000");
}

TEST_CASE("output enable high is dark on a hub75 panel", "[sim][hub75]") {
    Bench bench(panel_of(4, 2, 1));
    bench.shift(kR1, "1111");
    bench.latch();
    bench.shift(kR1, "1111");
    CHECK(bench.strobes.empty());
}

TEST_CASE("a strobe lasts from output enable's fall to its rise, while the next plane is shifted", "[sim][hub75]") {
    Bench bench(panel_of(4, 2, 1));
    bench.shift(kR1, "1010");
    bench.latch();
    bench.hand.low(kEnable);
    const std::uint64_t on = bench.hand.time_ns();
    bench.shift(kR1, "0101");
    CHECK(bench.strobes.empty());
    bench.hand.high(kEnable);
    REQUIRE(bench.strobes.size() == 1);
    CHECK(bench.strobes[0] == LitRows{on, bench.hand.time_ns(), 0, 0, 0, 0, "0.0:1010 0.1:0000"});
}

TEST_CASE("the latch is transparent while it is high", "[sim][hub75]") {
    Bench bench(panel_of(4, 2, 1));
    bench.hand.high(kLatch);
    bench.shift(kR1, "1100");
    CHECK(bench.flash_bits() == "0.0:1100 0.1:0000");
    bench.hand.low(kLatch);
    bench.shift(kR1, "0011");
    CHECK(bench.flash_bits() == "0.0:1100 0.1:0000");
}

TEST_CASE("bits that move through a transparent latch are seen on their way", "[sim][hub75]") {
    Bench bench(panel_of(4, 2, 1));
    bench.hand.high(kLatch);
    bench.hand.low(kEnable);
    bench.shift(kR1, "10");
    bench.hand.high(kEnable);
    REQUIRE(bench.strobes.size() == 3);
    CHECK(bench.strobes[0].bits == "0.0:0000 0.1:0000");
    CHECK(bench.strobes[1].bits == "0.0:0001 0.1:0000");
    CHECK(bench.strobes[2].bits == "0.0:0010 0.1:0000");
    CHECK(bench.strobes[0].off_ns == bench.strobes[1].on_ns);
}

TEST_CASE("a latch while a row is lit shows as a ghost", "[sim][hub75]") {
    Bench bench(panel_of(4, 2, 1));
    bench.shift(kR1, "1000");
    bench.latch();
    bench.shift(kR1, "0001");
    bench.hand.low(kEnable);
    const std::uint64_t on = bench.hand.time_ns();
    bench.hand.high(kLatch);
    const std::uint64_t latched = bench.hand.time_ns();
    bench.hand.high(kEnable);
    REQUIRE(bench.strobes.size() == 2);
    CHECK(bench.strobes[0] == LitRows{on, latched, 0, 0, 0, 0, "0.0:1000 0.1:0000"});
    CHECK(bench.strobes[1] == LitRows{latched, bench.hand.time_ns(), 0, 0, 0, 0, "0.0:0001 0.1:0000"});
}

TEST_CASE("a latch that takes the same bits again does not interrupt the light", "[sim][hub75]") {
    Bench bench(panel_of(4, 2, 1));
    bench.shift(kR1, "1000");
    bench.latch();
    bench.hand.low(kEnable);
    bench.latch();
    bench.hand.high(kEnable);
    CHECK(bench.strobes.size() == 1);
}

TEST_CASE("a change of the address while a row is lit shows as a ghost", "[sim][hub75]") {
    Bench bench(panel_of(4, 8, 4));
    bench.shift(kR1, "1001");
    bench.latch();
    bench.hand.low(kEnable);
    bench.hand.high(kAddress + 1);
    const std::uint64_t moved = bench.hand.time_ns();
    bench.hand.high(kEnable);
    REQUIRE(bench.strobes.size() == 2);
    CHECK(bench.strobes[0].row_group == 0);
    CHECK(bench.strobes[0].off_ns == moved);
    CHECK(bench.strobes[0].bits == "0.0:1001 0.4:0000");
    CHECK(bench.strobes[1].row_group == 2);
    CHECK(bench.strobes[1].on_ns == moved);
    CHECK(bench.strobes[1].bits == "0.2:1001 0.6:0000");
}

TEST_CASE("the address selects a row of each half, A its lowest bit", "[sim][hub75]") {
    Bench bench(panel_of(2, 16, 8));
    bench.shift(kR1, "10");
    bench.shift(kR2, "01");
    bench.latch();
    for (std::uint32_t address = 0; address < 8; ++address) {
        const LineMask lines = sim::line(kAddress) * 7;
        bench.hand.set(lines, sim::line(kAddress) * address);
        const auto seen = bench.flash();
        REQUIRE(seen.size() == 1);
        CHECK(seen[0].row_group == address);
        CHECK(seen[0].bits == "0." + std::to_string(address) + ":00 0." + std::to_string(address + 8) + ":01");
        bench.shift(kR2, "01");
    }
}

TEST_CASE("address lines that a panel has not are no matter to it", "[sim][hub75]") {
    Bench bench(panel_of(2, 8, 4));
    bench.hand.high(kAddress + 2);
    CHECK(bench.flash().at(0).row_group == 0);
}

TEST_CASE("an address that is no row group's lights nothing", "[sim][hub75]") {
    Bench bench(panel_of(2, 6, 3));
    bench.hand.set(sim::line(kAddress) * 3, sim::line(kAddress) * 3);
    CHECK(bench.flash().empty());
    bench.hand.low(kAddress);
    CHECK(bench.flash().at(0).row_group == 2);
}

TEST_CASE("rows that are lit together follow each other, the uppermost furthest", "[sim][hub75]") {
    Bench bench(panel_of(2, 8, 2));  // Each half has rows 0 and 2, or 1 and 3, in its register.
    bench.shift(kR2, "1101");
    bench.latch();
    CHECK(bench.flash_bits() == "0.0:00 0.2:00 0.4:11 0.6:01");
    bench.hand.high(kAddress);
    CHECK(bench.flash_bits() == "0.1:00 0.3:00 0.5:11 0.7:01");
}

TEST_CASE("the last panel of a chain has the first bits", "[sim][hub75]") {
    DisplayDescription display = panel_of(3, 2, 1, PixelFormat::Mono1, 2);
    display.panels[0].chain_position = 1;
    display.panels[1].columns = 2;
    Bench bench(display);
    bench.shift(kR1, "10001");
    bench.latch();
    CHECK(bench.flash_bits() == "0.0:100 0.1:000 1.0:01 1.1:00");
}

TEST_CASE("a chain that is shorter has the last bits", "[sim][hub75]") {
    DisplayDescription display = panel_of(4, 2, 1, PixelFormat::Mono1, 2);
    display.panels[1].connector = 1;
    display.panels[1].columns = 2;
    Bench bench(display);
    bench.shift(kR1 + kSecond, "1110");
    bench.latch();
    CHECK(bench.flash_bits() == "0.0:0000 0.1:0000 1.0:10 1.1:00");
}

TEST_CASE("colours are where the panel's wires are", "[sim][hub75]") {
    DisplayDescription display = panel_of(1, 2, 1, PixelFormat::Rgb111);
    const auto lit_by = [&](std::uint32_t line) {
        Bench bench(display);
        bench.shift(line, "1");
        bench.latch();
        return bench.flash_bits();
    };
    CHECK(lit_by(kG1) == "0.0:0 0.0:1 0.0:0 0.1:0 0.1:0 0.1:0");
    CHECK(lit_by(kR2) == "0.0:0 0.0:0 0.0:0 0.1:1 0.1:0 0.1:0");
    display.scan.color_order = {'b', 'r', 'g'};
    CHECK(lit_by(kR1) == "0.0:0 0.0:0 0.0:1 0.1:0 0.1:0 0.1:0");
    CHECK(lit_by(kG1) == "0.0:1 0.0:0 0.0:0 0.1:0 0.1:0 0.1:0");
    CHECK(lit_by(kB1) == "0.0:0 0.0:1 0.0:0 0.1:0 0.1:0 0.1:0");
}
