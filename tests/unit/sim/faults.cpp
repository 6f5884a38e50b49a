#include "sim/faults.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/geometric.hpp>

#include "driver/display/toml.h"
#include "sim/conditions.h"
#include "sim/lossy_link.h"
#include "sim/optics.h"
#include "tests/catch.h"
#include "tests/unit/sim/displays.h"
#include "transport/loopback.h"

namespace xorvox {
namespace {

using namespace test;

std::string refusal(std::string_view text) {
    const Expected<sim::Fault> fault = sim::parse_fault(text);
    return fault ? "" : fault.error().message;
}

std::string refusal(const DisplayDescription& display, std::string_view text) {
    const Expected<void> possible = sim::check_faults(display, {{sim::parse_fault(text).value()}});
    return possible ? "" : possible.error().message;
}

std::string refusal_of_file(std::string_view toml) {
    const Expected<sim::Conditions> conditions = sim::parse_conditions(toml, "bench.toml");
    return conditions ? "" : conditions.error().message;
}

std::string refusal_of_rotor(std::string_view text) {
    const Expected<sim::RotorConditions> rotor = sim::parse_rotor(text);
    return rotor ? "" : rotor.error().message;
}

/// Where LEDs are with a fault, less where they are without: of a page with one pixel.
glm::dvec3 moved(const DisplayDescription& display, const Pixel& pixel, std::string_view fault) {
    std::vector<std::byte> page = dark_page(display);
    set_pixel(display, page, pixel, 1);
    const sim::LightField right = sim::expose(display, page, 255);
    const sim::LightField wrong = sim::expose(display, page, 255, {{sim::parse_fault(fault).value()}});
    REQUIRE(right.flashes.size() == 1);
    REQUIRE(wrong.flashes.size() == 1);
    return wrong.flashes[0].place_mm - right.flashes[0].place_mm;
}

void check_same(const glm::dvec3& found, double x, double y, double z) {
    INFO("found " << found.x << ", " << found.y << ", " << found.z);
    CHECK(glm::distance(found, glm::dvec3(x, y, z)) < 1e-12);
}

TEST_CASE("the example of every kind of fault is one of it") {
    for (const sim::FaultKindInfo& info : sim::fault_kinds()) {
        CAPTURE(std::string(info.name));
        const Expected<sim::Fault> fault = sim::parse_fault(info.example);
        REQUIRE(fault.has_value());
        CHECK(fault->kind == info.kind);
        CHECK(sim::to_string(info.kind) == info.name);
    }
}

TEST_CASE("a fault is read with its keys in any order, and panel 0 where none is given") {
    const sim::Fault fault = sim::parse_fault("row-order:other=4,line=1,panel=2").value();
    CHECK((fault.panel == 2 && fault.line == 1 && fault.other == 4));
    CHECK(sim::parse_fault("mirrored").value().panel == 0);
    CHECK(sim::parse_fault("tilted:deg=-2.5").value().amount == -2.5);
}

TEST_CASE("a fault that is none is refused with what is known") {
    CHECK(refusal("of-axis:mm=1") ==
          "unknown fault \"of-axis\"; the nearest one is \"off-axis\" of off-axis, shifted, shifted-plane, tilted, "
          "mirrored, swapped-panels, swapped-slices, dead-row, stuck-bit, row-order, phase, lost-packets");
    CHECK(refusal("off-axis:panel=1,m=1") == "off-axis: unknown key \"m\"; the nearest one is \"mm\" of panel, mm");
    CHECK(refusal("off-axis:panel=1") == "off-axis: the key mm is missing; as in off-axis:panel=1,mm=3");
    CHECK(refusal("off-axis:mm") == "off-axis: found \"mm\"; allowed: KEY=VALUE, with commas between them");
    CHECK(refusal("off-axis:mm=1,mm=2") == "off-axis: \"mm\" stands in it twice");
    CHECK(refusal("off-axis:mm=1x") == "off-axis: mm: found \"1x\"; allowed: a number from -1000000 to 1000000");
    CHECK(refusal("off-axis:mm=nan").starts_with("off-axis: mm: found nan"));
    CHECK(refusal("mirrored:panel=0.5").starts_with("mirrored: panel: found \"0.5\"; allowed: a whole number"));
    CHECK(refusal("lost-packets:part=1.5").starts_with("lost-packets: part: found 1.5; allowed: "));
    CHECK(refusal("stuck-bit:bit=1,value=2").starts_with("stuck-bit: value: found 2; allowed: "));
}

TEST_CASE("a fault that a display cannot have is refused with the reason") {
    const DisplayDescription rotor = rotor_of(6, 4, 8, PixelFormat::Rgb332);
    const DisplayDescription stack = stack_of(6, 4, 3);
    DisplayDescription dim = rotor;
    dim.scan.bit_planes = 2;
    CHECK(refusal(rotor, "off-axis:panel=2,mm=1") ==
          "fault off-axis cannot be on rotor, kind \"rotating-panel\": panel: found 2; allowed: 0 to 1");
    CHECK(refusal(stack, "off-axis:mm=1").ends_with("only panels that turn have an axis"));
    CHECK(refusal(stack, "tilted:deg=1").ends_with("only panels that turn can lean"));
    CHECK(refusal(stack, "shifted:mm=1").ends_with("of a stack try shifted-plane"));
    CHECK(refusal(rotor, "shifted-plane:plane=1,mm=1").ends_with("only stacks have planes that stand by themselves"));
    CHECK(refusal(stack, "shifted-plane:plane=3,mm=1").ends_with("plane: found 3; allowed: 0 to 2"));
    CHECK(refusal(rotor, "tilted:deg=120").ends_with("it would lean by 120 degrees; allowed: less than 90"));
    CHECK(refusal(stack, "swapped-panels:panel=0,other=1").ends_with("it has one panel"));
    CHECK(refusal(rotor, "swapped-panels:panel=1,other=1").ends_with("which is the same; allowed: another one"));
    CHECK(refusal(rotor, "swapped-slices:slice=1,other=8").ends_with("other: found 8; allowed: 0 to 7"));
    CHECK(refusal(points_of(), "swapped-slices:slice=1,other=9").empty());
    CHECK(refusal(rotor, "dead-row:row=4").ends_with("row: found 4; allowed: 0 to 3"));
    CHECK(refusal(rotor, "stuck-bit:bit=8,value=1").ends_with("bit: found 8; allowed: 0 to 7"));
    CHECK(refusal(dim, "stuck-bit:bit=5,value=1")
              .ends_with("bit: found 5 of rgb332, which is not shown: bit_planes is 2"));
    CHECK(refusal(rotor, "row-order:line=0,other=1").find("its rows do not take turns") != std::string::npos);
    CHECK(refusal(stack, "phase:slices=0.5").ends_with("planes and points are counted; allowed: whole numbers"));
    CHECK(refusal(rotor, "phase:slices=0.5").empty());
}

TEST_CASE("row lines are HUB75's addresses, or the row groups of a matrix") {
    DisplayDescription display = load_display("vortex").value();
    CHECK(refusal(display, "row-order:line=0,other=4").empty());
    CHECK(refusal(display, "row-order:line=0,other=5").ends_with("other: found 5; allowed: 0 to 4"));
    display.scan.driver = DriverChip::Direct;
    CHECK(refusal(display, "row-order:line=0,other=31").empty());
}

TEST_CASE("off the axis a panel stands further out along its normal, and the others where they were") {
    const DisplayDescription display = rotor_of(4, 3, 4);
    const double h = std::sqrt(0.5);
    check_same(moved(display, {.slice = 0, .row = 1, .column = 2}, "off-axis:mm=2"), 2 * h, -2 * h, 0.0);
    check_same(moved(display, {.slice = 0, .panel = 1, .row = 1}, "off-axis:panel=1,mm=2"), -2 * h, 2 * h, 0.0);
    check_same(moved(display, {.slice = 0, .panel = 1, .row = 1}, "off-axis:panel=0,mm=2"), 0.0, 0.0, 0.0);
}

TEST_CASE("a shifted panel stands further along its columns, a shifted image along x") {
    const double h = std::sqrt(0.5);
    check_same(moved(rotor_of(4, 3, 4), {.slice = 0}, "shifted:mm=2"), 2 * h, 2 * h, 0.0);
    check_same(moved(swept_of(4, 3, 4, MotionProfile::Sine), {.slice = 2}, "shifted:mm=2"), 2.0, 0.0, 0.0);
    CHECK(moved(helix_of(4, 3, 4, 1), {.slice = 2}, "shifted:mm=2").x == 2.0);
}

TEST_CASE("a plane that is shifted leaves those above and below it") {
    const DisplayDescription display = stack_of(4, 3, 4);
    check_same(moved(display, {.slice = 2}, "shifted-plane:plane=2,mm=-3"), -3.0, 0.0, 0.0);
    check_same(moved(display, {.slice = 1}, "shifted-plane:plane=2,mm=-3"), 0.0, 0.0, 0.0);
}

TEST_CASE("a tilted panel's upper edge stands out, its middle where it was") {
    const DisplayDescription display = rotor_of(4, 3, 4);
    check_same(moved(display, {.slice = 0, .row = 1}, "tilted:deg=30"), 0.0, 0.0, 0.0);
    const glm::dvec3 top = moved(display, {.slice = 0, .row = 0}, "tilted:deg=30");  // It was 4 mm above the middle.
    check_same(top, 2.0 * std::sqrt(0.5), -2.0 * std::sqrt(0.5), 4.0 * std::cos(std::acos(-1.0) / 6.0) - 4.0);
}

TEST_CASE("packets to the display are lost as a seed has it, packets from it are not") {
    const auto arrivals = [](double part, std::uint64_t seed) {
        auto [host_end, device_end] = transport::make_loopback();
        sim::LossyLink lossy;
        const Link link = lossy.over(device_end.get(), {{{.kind = sim::FaultKind::LostPackets, .amount = part}}, seed});
        std::array<std::byte, 64> buffer{};
        std::string arrived;
        for (int i = 0; i < 1000; ++i) {
            std::size_t size = 0;
            REQUIRE(host_end->send(std::span(buffer).first(7)) == Status::Ok);
            arrived += link.receive(buffer, size) == Status::Ok ? '1' : '0';
            REQUIRE(link.send(std::span(buffer).first(5)) == Status::Ok);
            REQUIRE(host_end->receive(buffer, size) == Status::Ok);
        }
        return arrived;
    };
    const std::string some = arrivals(0.3, 1);
    CHECK(std::ranges::count(some, '1') > 620);
    CHECK(std::ranges::count(some, '1') < 780);
    CHECK(arrivals(0.3, 1) == some);
    CHECK(arrivals(0.3, 2) != some);
    CHECK(arrivals(1.0, 1) == std::string(1000, '0'));
    CHECK(arrivals(0.0, 1) == std::string(1000, '1'));
}

TEST_CASE("a lossy link may outlive the link that it is over") {
    auto [host_end, device_end] = transport::make_loopback();
    sim::LossyLink lossy;
    const sim::Faults faults{{{.kind = sim::FaultKind::LostPackets, .amount = 0.5}}};
    const Link link = lossy.over(device_end.get(), faults);
    const std::array<std::byte, 8> packet{};
    while (link.send(packet) == Status::Ok) {
    }  // Until some wait in it.
    device_end.reset();
    CHECK_FALSE(lossy.over(Link{}, faults));
}

TEST_CASE("a file gives the rotor, the faults, and one seed for both") {
    const sim::Conditions conditions = sim::parse_conditions(R"(
seed = 7
[rotor]
speed = 1.1
jitter = 0.01
missed = 0.1
stall_s = 3
[[fault]]
kind = "off-axis"
panel = 1
mm = 1.5
[[fault]]
kind = "lost-packets"
part = 0.25
)",
                                                             "bench.toml")
                                           .value();
    CHECK(conditions.rotor->speed == 1.1);
    CHECK(conditions.rotor->jitter == 0.01);
    CHECK(conditions.rotor->missed == 0.1);
    CHECK(conditions.rotor->stall_s == 3.0);
    CHECK((conditions.rotor->seed == 7 && conditions.faults.seed == 7));
    REQUIRE(conditions.faults.list.size() == 2);
    CHECK(conditions.faults.list[0].panel == 1);
    CHECK(conditions.faults.list[0].amount == 1.5);
    CHECK(conditions.faults.lost_packets() == 0.25);
    CHECK(sim::parse_conditions("", "empty.toml").value().faults.empty());
    CHECK_FALSE(sim::parse_conditions("", "empty.toml").value().rotor.has_value());
}

TEST_CASE("a file with a mistake is refused with its line") {
    CHECK(refusal_of_file("[[fault]]\nkind = \"off-axs\"\nmm = 1")
              .starts_with("bench.toml: line 2: fault 1: kind: unknown fault \"off-axs\"; the nearest one is"));
    CHECK(refusal_of_file("[[fault]]\nkind = \"off-axis\"\nm = 1") ==
          "bench.toml: line 3: fault 1: unknown key \"m\"; the nearest one is \"mm\" of kind, panel, mm");
    CHECK(refusal_of_file("\n[[fault]]\nkind = \"off-axis\"") ==
          "bench.toml: line 2: fault 1: the required key \"mm\" is missing");
    CHECK(refusal_of_file("[[fault]]\npanel = 1") ==
          "bench.toml: line 1: fault 1: the required key \"kind\" is missing");
    CHECK(refusal_of_file("[[fault]]\nkind = \"phase\"\nslices = \"1\"")
              .starts_with("bench.toml: line 3: fault 1: slices: found the text \"1\"; allowed: a number"));
    CHECK(refusal_of_file("[[fault]]\nkind = \"mirrored\"\npanel = -1")
              .starts_with("bench.toml: line 3: fault 1: panel: found -1; allowed: "));
    CHECK(refusal_of_file("fault = 3").starts_with("bench.toml: line 1: fault: found 3; allowed: "));
    CHECK(refusal_of_file("[rotor]\njiter = 1").starts_with("bench.toml: line 2: unknown key \"rotor.jiter\""));
    CHECK(refusal_of_file("[rotor]\njitter = 1").starts_with("bench.toml: line 2: rotor.jitter: found 1; allowed: "));
    CHECK(refusal_of_file("[rotor\n").starts_with("bench.toml: line 1: not valid"));
    CHECK(refusal_of_file("seed = -1").starts_with("bench.toml: line 1: seed: found -1; allowed: "));
}

TEST_CASE("a rotor is read as text, times in seconds") {
    const sim::RotorConditions rotor = sim::parse_rotor("jitter=0.01,missed=0.1,speed=1.1,stall=3,seed=9").value();
    CHECK(rotor.jitter == 0.01);
    CHECK(rotor.missed == 0.1);
    CHECK(rotor.speed == 1.1);
    CHECK(rotor.stall_s == 3.0);
    CHECK(rotor.seed == 9);
    CHECK(sim::parse_rotor("spin_up=2").value().spin_up_s == 2.0);
    CHECK_FALSE(sim::parse_rotor("").value().stall_s.has_value());
    CHECK(refusal_of_rotor("jiter=1") ==
          "unknown key \"jiter\"; the nearest one is \"jitter\" of speed, spin_up, acceleration, jitter, missed, "
          "doubled, noise, stall, seed");
    CHECK(refusal_of_rotor("speed=0").starts_with("speed: found 0; allowed: "));
    CHECK(refusal_of_rotor("stall").starts_with("found \"stall\"; allowed: KEY=VALUE"));
}

}  // namespace
}  // namespace xorvox
