// Strobes by pins, and the pins themselves.
#include <algorithm>
#include <memory>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "driver/display/toml.h"
#include "sim/cube_595.h"
#include "sim/hub75_panels.h"
#include "sim/led_matrix.h"
#include "sim/scan_out.h"
#include "tests/catch.h"
#include "tests/unit/sim/displays.h"
#include "tests/unit/sim/orders.h"
#include "tests/unit/sim/pins.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

struct PinChange {
    std::uint64_t time_ns = 0;
    LineMask levels = 0;
    LineMask changed = 0;
};

constexpr LineMask kEnable = 0b100;

/// An edge scan with all that it gives.
struct Rig {
    explicit Rig(const DisplayDescription& of) : display(of) {
        auto made = sim::make_edge_scan(
            display, [this](const sim::Strobe& strobe) { strobes.push_back(lit_rows(display, strobe)); },
            [this](std::uint64_t time_ns, LineMask levels, LineMask changed) {
                pins.push_back({time_ns, levels, changed});
            });
        REQUIRE(made);
        scan = std::move(*made);
        page = random_page(display, 1);
    }
    void light(std::uint32_t slice, std::uint64_t begin_ns, std::uint64_t end_ns, std::uint32_t frame = 1) {
        scan->begin(lit_order(display, page, slice, begin_ns, end_ns), frame, begin_ns);
    }

    DisplayDescription display;
    std::vector<LitRows> strobes;
    std::vector<PinChange> pins;
    std::vector<std::byte> page;
    std::unique_ptr<sim::ScanOut> scan;
};

DisplayDescription small_cube() {
    DisplayDescription display = stack_of(3, 2, 4, PixelFormat::Mono2);
    display.scan.driver = DriverChip::ShiftRegister595;
    display.scan.pixel_clock_hz = 10'000'000;
    display.scan.latch_ns = 100;
    return display;
}

DisplayDescription small_panel() {
    DisplayDescription display = rotor_of(10, 8, 6, PixelFormat::Rgb111, 1);
    display.scan.driver = DriverChip::Hub75;
    display.scan.row_groups = 4;
    display.scan.pixel_clock_hz = 10'000'000;
    display.scan.latch_ns = 100;
    return display;
}

/// The bits that would be lit if output enable fell after all these changes.
std::string lit_when_enabled(const DisplayDescription& display, const std::vector<PinChange>& pins) {
    std::string bits;
    const auto sink = [&](const sim::Strobe& strobe) {
        std::istringstream rows(lit_rows(display, strobe).bits);
        for (std::string row; rows >> row;) bits += row.substr(row.find(':'));
    };
    std::unique_ptr<sim::PinModel> model;
    if (display.scan.driver == DriverChip::Hub75) {
        model = std::make_unique<sim::Hub75Panels>(display, device::Hub75Pins{}, sink);
    } else {
        model = std::make_unique<sim::Cube595>(display, device::ShiftRegisterPins{}, sink);
    }
    for (const PinChange& pin : pins) model->on_pins(pin.time_ns, pin.levels, pin.changed);
    bits.clear();
    const std::uint64_t after = pins.back().time_ns + 10;
    model->on_pins(after, pins.back().levels & ~kEnable, kEnable);
    model->on_pins(after + 10, pins.back().levels, kEnable);
    return bits;
}

}  // namespace

TEST_CASE("pins are told in the order of time, each change as one", "[sim][edges]") {
    Rig rig(small_panel());
    rig.light(0, 1000, 100'000);
    rig.light(1, 90'000, 200'000);
    rig.scan->run_until(300'000);
    REQUIRE(rig.pins.size() > 100);
    CHECK(rig.pins[0].changed == 0x3f1f);  // All that there are: two address lines, six of data.
    for (std::size_t i = 1; i < rig.pins.size(); ++i) {
        REQUIRE(rig.pins[i].time_ns >= rig.pins[i - 1].time_ns);
        REQUIRE((rig.pins[i].levels ^ rig.pins[i - 1].levels) == rig.pins[i].changed);
        REQUIRE(rig.pins[i].changed != 0);
    }
}

TEST_CASE("no strobe is told before its time", "[sim][edges]") {
    Rig rig(small_panel());
    rig.light(0, 0, 100'000);
    for (std::uint64_t now = 0; now < 110'000; now += 777) {
        rig.scan->run_until(now);
        if (!rig.strobes.empty()) REQUIRE(rig.strobes.back().off_ns <= now);
        if (!rig.pins.empty()) REQUIRE(rig.pins.back().time_ns <= now);
    }
    CHECK(rig.strobes.size() == 4);
}

TEST_CASE("however often it is asked, an edge scan does the same", "[sim][edges]") {
    Rig seldom(small_cube());
    Rig often(small_cube());
    for (Rig* rig : {&seldom, &often}) {
        rig->light(2, 50, 60'000);
        for (std::uint64_t now = 50; rig == &often && now < 60'000; now += 13) rig->scan->run_until(now);
        rig->scan->run_until(60'000);
    }
    CHECK(seldom.strobes == often.strobes);
    CHECK(std::ranges::equal(seldom.pins, often.pins, [](const PinChange& a, const PinChange& b) {
        return a.time_ns == b.time_ns && a.levels == b.levels;
    }));
}

TEST_CASE("strobes have the frame and the slice of the order that lit them", "[sim][edges]") {
    Rig rig(small_panel());
    rig.light(3, 0, 100'000, 7);
    rig.scan->run_until(50'000);
    rig.light(4, 50'000, 150'000, 8);  // In the middle of a strobe.
    rig.scan->run_until(200'000);
    REQUIRE(rig.strobes.size() > 4);
    for (const LitRows& strobe : rig.strobes) {
        const bool first = strobe.on_ns < 50'000;
        CHECK(strobe.slice == (first ? 3 : 4));
        CHECK(strobe.frame == (first ? 7 : 8));
        if (first) CHECK(strobe.off_ns <= 50'000);
    }
}

TEST_CASE("of a cube the slice is the layer that the pins select", "[sim][edges]") {
    Rig rig(small_cube());
    for (std::uint32_t slice = 0; slice < 4; ++slice) rig.light(slice, slice * 50'000, (slice + 1) * 50'000);
    rig.scan->run_until(300'000);
    REQUIRE(rig.strobes.size() == 8);
    for (std::uint32_t i = 0; i < 8; ++i) {
        CHECK(rig.strobes[i].slice == i / 2);
        CHECK(rig.strobes[i].plane == i % 2);
    }
}

TEST_CASE("a dark order ends light at once and leaves no row selected", "[sim][edges]") {
    for (const DisplayDescription& display : {small_cube(), small_panel()}) {
        Rig rig(display);
        rig.light(1, 0, 100'000);
        std::uint64_t middle = 0;
        while (rig.strobes.size() < 2) rig.scan->run_until(middle += 1000);
        middle = rig.strobes.back().off_ns + (rig.strobes.back().off_ns - rig.strobes.back().on_ns) / 2;
        rig.scan->run_until(middle);
        rig.scan->begin(dark_order(middle), 0, middle);
        const std::size_t seen = rig.strobes.size();
        rig.scan->run_until(middle + 1'000'000);
        CHECK(rig.strobes.size() == seen);
        CHECK(rig.strobes.back().off_ns <= middle);
        CHECK((rig.pins.back().levels & kEnable) != 0);
        CHECK(lit_when_enabled(display, rig.pins).find('1') == std::string::npos);
    }
}

TEST_CASE("models take whatever comes, and give strobes in order", "[sim][edges]") {
    DisplayDescription matrix = rotor_of(3, 6, 4, PixelFormat::Rgb111);
    matrix.scan.row_groups = 6;
    for (const DisplayDescription& display : {small_cube(), small_panel(), matrix}) {
        std::uint64_t last_on_ns = 0;
        std::size_t strobes = 0;
        const auto sink = [&](const sim::Strobe& strobe) {
            ++strobes;
            REQUIRE(strobe.off_ns > strobe.on_ns);
            REQUIRE(strobe.on_ns >= last_on_ns);
            REQUIRE(strobe.row_group < display.scan.row_groups);
            REQUIRE(strobe.slice < display.slices);
            (void)lit_rows(display, strobe);
            last_on_ns = strobe.on_ns;
        };
        std::unique_ptr<sim::PinModel> model;
        switch (display.scan.driver) {
            case DriverChip::Hub75:
                model = std::make_unique<sim::Hub75Panels>(display, device::Hub75Pins{}, sink);
                break;
            case DriverChip::ShiftRegister595:
                model = std::make_unique<sim::Cube595>(display, device::ShiftRegisterPins{}, sink);
                break;
            default: model = std::make_unique<sim::LedMatrix>(display, device::MatrixPins{}, sink);
        }
        std::mt19937_64 random(3);
        LineMask levels = random();
        model->on_pins(0, levels, ~LineMask{0});
        for (std::uint64_t step = 1; step < 20'000; ++step) {
            const LineMask next = random() % 2 == 0 ? random() : levels ^ (LineMask{1} << random() % 20);
            model->on_pins(step / 3, next, next ^ levels);
            levels = next;
        }
        CHECK(strobes > 100);
    }
}

TEST_CASE("pins have names", "[sim][edges]") {
    using Names = std::vector<std::string>;
    CHECK(sim::pin_names(small_cube()) == Names{"clock", "latch", "oe", "data"});
    CHECK(sim::pin_names(small_panel()) ==
          Names{"clock", "latch", "oe", "a", "b", "", "", "", "r1", "g1", "b1", "r2", "g2", "b2"});
    DisplayDescription matrix = rotor_of(2, 3, 4, PixelFormat::Mono1, 1);
    matrix.scan.row_groups = 3;
    CHECK(sim::pin_names(matrix) == Names{"row0", "row1", "row2", "col0", "col1"});
    CHECK(sim::pin_names(rotor_of(2, 3, 4)).empty());
}

TEST_CASE("displays without pins are refused in words", "[sim][edges]") {
    const auto refused = [](const DisplayDescription& display) {
        auto made = sim::make_edge_scan(display, {}, {});
        REQUIRE_FALSE(made);
        CHECK_THAT(made.error().message, Catch::Contains("has no pins that can be simulated: ") &&
                                             Catch::Contains("use the fidelity \"strobes\""));
        return made.error().message;
    };
    CHECK_THAT(refused(rotor_of(4, 4, 4)), Catch::Contains("every LED has its own wire"));

    DisplayDescription display = small_panel();
    display.light.response = Response::Gamma;
    CHECK_THAT(refused(display), Catch::Contains("its response is \"gamma\""));
    display = small_panel();
    display.scan.pixel_clock_hz = 3'000'000'000;
    CHECK_THAT(refused(display), Catch::Contains("3000000000 Hz"));
    display = small_panel();
    display.panels[0].rows = 128;
    display.scan.row_groups = 64;
    CHECK_THAT(refused(display), Catch::Contains("64 row groups"));
    display = small_panel();
    display.kind = DisplayKind::StackedPlanes;
    CHECK_THAT(refused(display), Catch::Contains("no pin selects the panel"));

    display = small_cube();
    display.scan.row_groups = 2;
    CHECK_THAT(refused(display), Catch::Contains("2 row groups"));
    display = rotor_of(4, 4, 4);
    display.scan.driver = DriverChip::ShiftRegister595;
    CHECK_THAT(refused(display), Catch::Contains("on a display that moves"));

    display = rotor_of(16, 10, 4);
    display.scan.row_groups = 5;
    CHECK_THAT(refused(display), Catch::Contains("69 lines"));
    display = stack_of(4, 4, 4);
    display.scan.row_groups = 4;
    CHECK_THAT(refused(display), Catch::Contains("no line selects the plane"));
}
