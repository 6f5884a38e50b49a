// An LED matrix on lines of its own, by hand.
#include "sim/led_matrix.h"

#include <utility>
#include <vector>

#include "tests/catch.h"
#include "tests/unit/sim/displays.h"
#include "tests/unit/sim/pins.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

/// Rows by lines, columns by lines.
struct Bench {
    explicit Bench(const DisplayDescription& of)
        : display(of),
          model(of, device::MatrixPins{},
                [this](const sim::Strobe& strobe) { strobes.push_back(lit_rows(display, strobe)); }),
          hand([this](std::uint64_t time_ns, LineMask levels, LineMask changed) {
              model.on_pins(time_ns, levels, changed);
          }) {}

    std::vector<LitRows> taken() { return std::exchange(strobes, {}); }

    DisplayDescription display;
    std::vector<LitRows> strobes;
    sim::LedMatrix model;
    Hand hand;
};

DisplayDescription matrix_of(std::uint16_t columns, std::uint16_t rows, std::uint16_t groups,
                             PixelFormat format = PixelFormat::Mono1, std::uint32_t panels = 1) {
    DisplayDescription display = rotor_of(columns, rows, 4, format, panels);
    display.scan.row_groups = groups;
    return display;
}

}  // namespace

TEST_CASE("a matrix lights a row group while its line is high", "[sim][matrix]") {
    Bench bench(matrix_of(3, 2, 2));
    bench.hand.high(2 + 1);
    CHECK(bench.strobes.empty());
    bench.hand.high(1);
    const std::uint64_t on = bench.hand.time_ns();
    bench.hand.low(1);
    const auto seen = bench.taken();
    REQUIRE(seen.size() == 1);
    CHECK(seen[0] == LitRows{on, bench.hand.time_ns(), 1, 0, 0, 0, "0.1:010"});
}

TEST_CASE("columns that change while a group is lit show as ghosts", "[sim][matrix]") {
    Bench bench(matrix_of(3, 2, 2));
    bench.hand.high(0);
    bench.hand.high(2);
    bench.hand.low(2);
    bench.hand.low(0);
    const auto seen = bench.taken();
    REQUIRE(seen.size() == 3);
    CHECK(seen[0].bits == "0.0:000");
    CHECK(seen[1].bits == "0.0:100");
    CHECK(seen[2].bits == "0.0:000");
    CHECK(seen[0].off_ns == seen[1].on_ns);
}

TEST_CASE("several groups that are selected show the same", "[sim][matrix]") {
    Bench bench(matrix_of(2, 3, 3));
    bench.hand.high(3);
    bench.hand.set(0b101, 0b101);
    bench.hand.set(0b101, 0);
    const auto seen = bench.taken();
    REQUIRE(seen.size() == 2);
    CHECK(seen[0].bits == "0.0:10");
    CHECK(seen[1].bits == "0.2:10");
}

TEST_CASE("a matrix has a line for each LED of a group: panels, rows, columns, channels", "[sim][matrix]") {
    DisplayDescription display = matrix_of(2, 4, 2, PixelFormat::Rgb111, 2);
    display.panels[1].columns = 1;
    display.scan.color_order = {'g', 'r', 'b'};
    Bench bench(display);
    const auto lit_by = [&](std::uint32_t column_line) {
        bench.hand.high(2 + column_line);
        bench.hand.high(1);
        bench.hand.set(sim::line(1) | sim::line(2 + column_line), 0);
        return bench.taken().at(0).bits;
    };
    const std::string panel_0 = "0.1:00 0.1:00 0.1:00 0.3:00 0.3:00 0.3:00";
    const std::string panel_1 = "1.1:0 1.1:0 1.1:0 1.3:0 1.3:0 1.3:0";
    CHECK(lit_by(0) == "0.1:00 0.1:10 0.1:00 0.3:00 0.3:00 0.3:00 " + panel_1);
    CHECK(lit_by(4) == "0.1:01 0.1:00 0.1:00 0.3:00 0.3:00 0.3:00 " + panel_1);
    CHECK(lit_by(8) == "0.1:00 0.1:00 0.1:00 0.3:00 0.3:00 0.3:10 " + panel_1);
    CHECK(lit_by(12) == panel_0 + " 1.1:0 1.1:1 1.1:0 1.3:0 1.3:0 1.3:0");
    CHECK(lit_by(17) == panel_0 + " 1.1:0 1.1:0 1.1:0 1.3:0 1.3:0 1.3:1");
}
