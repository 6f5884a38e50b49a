// The 74HC595, by its data sheet.
#include "sim/chain_595.h"

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sim/cube_595.h"
#include "tests/catch.h"
#include "tests/unit/sim/displays.h"
#include "tests/unit/sim/pins.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

constexpr std::uint32_t kData = 3;
constexpr std::uint32_t kClock = 0;
constexpr std::uint32_t kLatch = 1;
constexpr std::uint32_t kEnable = 2;
constexpr sim::Chain595::Pins kPins{kData, kClock, kLatch, kEnable};

/// Chips with a hand on their pins; output enable is low.
struct Bench {
    explicit Bench(std::size_t outputs) : chain(outputs, kPins), hand(feed(chain)) {}

    static std::function<void(std::uint64_t, LineMask, LineMask)> feed(sim::Chain595& chain) {
        return [&chain](std::uint64_t, LineMask levels, LineMask changed) { (void)chain.on_pins(levels, changed); };
    }
    void shift(std::string_view bits) {
        for (const char bit : bits) {
            bit == '1' ? hand.high(kData) : hand.low(kData);
            hand.pulse(kClock);
        }
    }
    std::string stages() const {
        std::string text;
        for (std::size_t i = 0; i < 8; ++i) text += chain.stage(i) ? '1' : '0';
        return text;
    }
    std::string outputs() const {
        std::string text;
        for (std::size_t i = 0; i < 8; ++i) text += chain.output(i) ? '1' : '0';
        return text;
    }

    sim::Chain595 chain;
    Hand hand;
};

/// A cube of 2 × 2 × 2 with a hand on its pins; outputs are disabled.
struct Cube {
    explicit Cube(bool msb_first = true, bool layers_first = false) {
        display = stack_of(2, 2, 2);
        display.scan.driver = DriverChip::ShiftRegister595;
        display.scan.msb_first = msb_first;
        display.scan.layers_first = layers_first;
        model.emplace(display, device::ShiftRegisterPins{},
                      [this](const sim::Strobe& strobe) { strobes.push_back(lit_rows(display, strobe)); });
        hand.emplace([this](std::uint64_t time_ns, LineMask levels,
                            LineMask changed) { model->on_pins(time_ns, levels, changed); },
                     sim::line(kEnable));
    }
    void send(std::string_view bits) {
        for (const char bit : bits) {
            bit == '1' ? hand->high(kData) : hand->low(kData);
            hand->pulse(kClock);
        }
        hand->pulse(kLatch);
    }
    /// What is lit while the outputs are enabled once.
    std::vector<LitRows> flash() {
        hand->low(kEnable);
        hand->high(kEnable);
        return std::exchange(strobes, {});
    }

    DisplayDescription display;
    std::vector<LitRows> strobes;
    std::optional<sim::Cube595> model;
    std::optional<Hand> hand;
};

}  // namespace

TEST_CASE("a 74hc595 shifts on the rising edge of its shift clock alone", "[sim][595]") {
    Bench bench(8);
    bench.hand.high(kData);
    CHECK(bench.stages() == "00000000");
    bench.hand.high(kClock);
    CHECK(bench.stages() == "10000000");
    bench.hand.low(kClock);
    CHECK(bench.stages() == "10000000");
    bench.hand.low(kData);
    bench.hand.high(kClock);
    CHECK(bench.stages() == "01000000");
}

TEST_CASE("a 74hc595 takes the level that its data had before the edge", "[sim][595]") {
    Bench bench(8);
    bench.hand.set(sim::line(kData) | sim::line(kClock), ~LineMask{0});
    CHECK(bench.stages() == "00000000");
}

TEST_CASE("lines that are high from the beginning are no edges", "[sim][595]") {
    sim::Chain595 chain(8, kPins);
    const LineMask all = sim::line(kData) | sim::line(kClock) | sim::line(kLatch);
    (void)chain.on_pins(all, ~LineMask{0});
    CHECK_FALSE(chain.stage(0));
}

TEST_CASE("a shift without a latch changes no output", "[sim][595]") {
    Bench bench(8);
    bench.shift("1");
    CHECK(bench.outputs() == "00000000");
    bench.hand.high(kLatch);
    CHECK(bench.outputs() == "10000000");
    bench.hand.low(kLatch);
    bench.shift("1");
    CHECK(bench.stages() == "11000000");
    CHECK(bench.outputs() == "10000000");
}

TEST_CASE("a latch that stays high keeps its outputs", "[sim][595]") {
    Bench bench(8);
    bench.shift("1");
    bench.hand.high(kLatch);
    bench.shift("0");
    CHECK(bench.outputs() == "10000000");
}

TEST_CASE("both clocks at once: the outputs get the stages of before", "[sim][595]") {
    Bench bench(8);
    bench.shift("1");
    bench.hand.high(kData);
    bench.hand.set(sim::line(kClock) | sim::line(kLatch), ~LineMask{0});
    CHECK(bench.stages() == "11000000");
    CHECK(bench.outputs() == "10000000");
}

TEST_CASE("output enable high is dark, and the storage is kept", "[sim][595]") {
    Bench bench(8);
    bench.shift("11");
    bench.hand.pulse(kLatch);
    bench.hand.high(kEnable);
    CHECK_FALSE(bench.chain.enabled());
    CHECK(bench.outputs() == "00000000");
    bench.hand.low(kEnable);
    CHECK(bench.outputs() == "11000000");
}

TEST_CASE("17 clocks on 16 registers push the first bit out at Q7S", "[sim][595]") {
    Bench bench(16);
    bench.shift("100000000000000");
    CHECK_FALSE(bench.chain.serial_out());
    bench.shift("0");
    CHECK(bench.chain.serial_out());  // It is in the last stage, where the next chip would take it.
    bench.shift("0");
    CHECK_FALSE(bench.chain.serial_out());
    for (std::size_t i = 0; i < 16; ++i) CHECK_FALSE(bench.chain.stage(i));
}

TEST_CASE("two chips in cascade are one of twice the length", "[sim][595]") {
    // The second one's serial input is the first one's Q7S, as it is before the edge.
    constexpr std::uint32_t kBetween = 4;
    sim::Chain595 whole(16, kPins);
    sim::Chain595 first(8, kPins);
    sim::Chain595 second(8, {kBetween, kClock, kLatch, kEnable});
    LineMask between = 0;
    LineMask was = 0;
    const auto feed = [&](std::uint64_t, LineMask levels, LineMask) {
        const LineMask all = levels | between;
        for (sim::Chain595* chain : {&second, &first, &whole}) (void)chain->on_pins(all, all ^ was);
        was = all;
        between = first.serial_out() ? sim::line(kBetween) : 0;
    };
    Hand hand(feed);
    for (std::uint32_t i = 0, bits = 0xc5a31; i < 40; ++i, bits = bits * 5 + 1) {
        (bits >> 7 & 1) != 0 ? hand.high(kData) : hand.low(kData);
        hand.pulse(kClock);
        for (std::size_t stage = 0; stage < 8; ++stage) {
            REQUIRE(whole.stage(stage) == first.stage(stage));
            REQUIRE(whole.stage(stage + 8) == second.stage(stage));
        }
    }
}

TEST_CASE("bits stand in a cube's registers as its scan says", "[sim][595]") {
    // Pixels 3 2 1 0 = 0011, layers 1 0 = 10: the upper row of the upper layer.
    const auto lit = [](bool msb_first, bool layers_first, std::string_view bits) {
        Cube cube(msb_first, layers_first);
        cube.send(bits);
        return cube.flash();
    };
    for (const auto& seen : {lit(true, false, "001110"), lit(false, false, "110001"), lit(true, true, "100011"),
                             lit(false, true, "011100")}) {
        REQUIRE(seen.size() == 1);
        CHECK(seen[0].slice == 1);
        CHECK(seen[0].row_group == 0);
        CHECK(seen[0].bits == "0.0:11 0.1:00");
    }
}

TEST_CASE("columns of a cube's row run from pixel 0 on", "[sim][595]") {
    Cube cube;
    cube.send(
        "0100"
        "01");  // Pixels 3 … 0, layers 1, 0.
    const auto seen = cube.flash();
    REQUIRE(seen.size() == 1);
    CHECK(seen[0].bits == "0.0:00 0.1:10");
}

TEST_CASE("the LEDs of a pixel follow each other in the order of their channels", "[sim][595]") {
    DisplayDescription display = stack_of(1, 2, 1, PixelFormat::Rgb111);
    display.scan.driver = DriverChip::ShiftRegister595;
    display.scan.color_order = {'g', 'b', 'r'};
    std::vector<LitRows> strobes;
    sim::Cube595 cube(display, device::ShiftRegisterPins{},
                      [&](const sim::Strobe& strobe) { strobes.push_back(lit_rows(display, strobe)); });
    Hand hand([&](std::uint64_t time_ns, LineMask levels, LineMask changed) { cube.on_pins(time_ns, levels, changed); },
              sim::line(kEnable));
    for (const char bit : std::string_view("1000101")) {  // Pixel 1: r b g, pixel 0: r b g, the layer.
        bit == '1' ? hand.high(kData) : hand.low(kData);
        hand.pulse(kClock);
    }
    hand.pulse(kLatch);
    hand.low(kEnable);
    hand.high(kEnable);
    REQUIRE(strobes.size() == 1);
    CHECK(strobes[0].bits == "0.0:0 0.0:0 0.0:1 0.1:1 0.1:0 0.1:0");
}

TEST_CASE("a cube of which no layer is selected is dark", "[sim][595]") {
    Cube cube;
    cube.send("111100");
    CHECK(cube.flash().empty());
}

TEST_CASE("several layers that are selected are lit together", "[sim][595]") {
    Cube cube;
    cube.send("100111");
    const auto seen = cube.flash();
    REQUIRE(seen.size() == 2);
    CHECK(seen[0].slice == 0);
    CHECK(seen[1].slice == 1);
    CHECK(seen[0].bits == seen[1].bits);
    CHECK(seen[0].on_ns == seen[1].on_ns);
    CHECK(seen[0].off_ns == seen[1].off_ns);
}

TEST_CASE("a strobe of a cube lasts from enable to disable, while the next data are shifted in", "[sim][595]") {
    Cube cube;
    cube.send("111101");
    cube.hand->low(kEnable);
    const std::uint64_t on = cube.hand->time_ns();
    for (int i = 0; i < 6; ++i) cube.hand->pulse(kClock);
    CHECK(cube.strobes.empty());
    cube.hand->high(kEnable);
    REQUIRE(cube.strobes.size() == 1);
    CHECK(cube.strobes[0].on_ns == on);
    CHECK(cube.strobes[0].off_ns == cube.hand->time_ns());
    CHECK(cube.strobes[0].bits == "0.0:11 0.1:11");
}

TEST_CASE("a latch while a cube is lit shows as a ghost", "[sim][595]") {
    Cube cube;
    cube.send("000101");
    cube.hand->low(kEnable);
    const std::uint64_t on = cube.hand->time_ns();
    cube.send("001010");
    const std::uint64_t latched = cube.hand->time_ns() - 10;
    cube.hand->high(kEnable);
    REQUIRE(cube.strobes.size() == 2);
    CHECK(cube.strobes[0] == LitRows{on, latched, 0, 0, 0, 0, "0.0:10 0.1:00"});
    CHECK(cube.strobes[1] == LitRows{latched, cube.hand->time_ns(), 0, 0, 1, 0, "0.0:01 0.1:00"});
}
