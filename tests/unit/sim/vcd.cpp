// Traces of pins.
#include "sim/vcd.h"

#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/unit/sim/vcd_reader.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

using Changes = std::vector<Vcd::Change>;

/// A writer into a text.
struct Trace {
    explicit Trace(std::vector<std::string> names, const sim::VcdOptions& options = {})
        : writer(std::move(names), options, [this](std::string_view bytes) -> Expected<void> {
              text += bytes;
              return {};
          }) {}
    Vcd finished(std::uint64_t end_ns) {
        REQUIRE(writer.finish(end_ns));
        return read_vcd(text);
    }

    std::string text;
    sim::VcdWriter writer;
};

}  // namespace

TEST_CASE("a trace has the bytes that the standard wants", "[sim][vcd]") {
    Trace trace({"clock", "latch"}, {.scope = "cube8-595"});
    trace.writer.on_pins(5, 0b10, ~LineMask{0});
    trace.writer.on_pins(17, 0b01, 0b11);
    REQUIRE(trace.writer.finish(30));
    CHECK(trace.text ==
          "$version xorvox $end\n$timescale 1 ns $end\n$scope module cube8_595 $end\n"
          "$var wire 1 ! clock $end\n$var wire 1 \" latch $end\n$upscope $end\n$enddefinitions $end\n"
          "#5\n$dumpvars\n0!\n1\"\n$end\n#17\n1!\n0\"\n#30\n");
}

TEST_CASE("a trace holds every change, and no other level", "[sim][vcd]") {
    Trace trace({"a", "b", "c"});
    trace.writer.on_pins(0, 0b100, ~LineMask{0});
    trace.writer.on_pins(10, 0b101, 0b001);
    trace.writer.on_pins(20, 0b110, 0b011);
    trace.writer.on_pins(20, 0b010, 0b100);
    const Vcd vcd = trace.finished(20);
    CHECK(vcd.timescale == "1 ns");
    CHECK(vcd.wires == std::vector<std::string>{"a", "b", "c"});
    CHECK(vcd.initial == std::map<std::string, bool>{{"a", false}, {"b", false}, {"c", true}});
    CHECK(vcd.changes == Changes{{10, "a", true}, {20, "a", false}, {20, "b", true}, {20, "c", false}});
    CHECK(vcd.end == 20);
    CHECK(trace.writer.changes() == 4);
}

TEST_CASE("lines without a name are not in a trace", "[sim][vcd]") {
    Trace trace({"a", "", "c"});
    trace.writer.on_pins(0, 0, ~LineMask{0});
    trace.writer.on_pins(3, 0b1110, 0b1110);
    trace.writer.on_pins(4, 0b1100, 0b0010);
    const Vcd vcd = trace.finished(9);
    CHECK(vcd.wires == std::vector<std::string>{"a", "c"});
    CHECK(vcd.changes == Changes{{3, "c", true}});
    CHECK(vcd.end == 9);
}

TEST_CASE("64 lines have codes of their own", "[sim][vcd]") {
    std::vector<std::string> names;
    for (int i = 0; i < 64; ++i) names.push_back("n" + std::to_string(i));
    Trace trace(names);
    trace.writer.on_pins(0, 0, ~LineMask{0});
    for (std::uint64_t i = 0; i < 64; ++i) trace.writer.on_pins(i + 1, LineMask{1} << i, LineMask{1} << i);
    const Vcd vcd = trace.finished(100);
    REQUIRE(vcd.changes.size() == 64);
    for (std::size_t i = 0; i < 64; ++i) CHECK(vcd.changes[i] == Vcd::Change{i + 1, names[i], true});
}

TEST_CASE("a trace ends whole before the change that is too many, and says when", "[sim][vcd]") {
    Trace trace({"a", "b"}, {.most_changes = 3});
    trace.writer.on_pins(0, 0, ~LineMask{0});
    trace.writer.on_pins(10, 0b01, 0b01);
    trace.writer.on_pins(20, 0b00, 0b01);
    CHECK_FALSE(trace.writer.ended_early_ns());
    trace.writer.on_pins(30, 0b11, 0b11);
    trace.writer.on_pins(40, 0b01, 0b10);
    CHECK(trace.writer.ended_early_ns() == 30);
    const Vcd vcd = trace.finished(50);
    CHECK(vcd.changes == Changes{{10, "a", true}, {20, "a", false}});
    CHECK(vcd.end == 30);
}

TEST_CASE("a trace of nothing is whole", "[sim][vcd]") {
    Trace trace({"a"});
    const Vcd vcd = trace.finished(50);
    CHECK(vcd.wires.size() == 1);
    CHECK(vcd.changes.empty());
}

TEST_CASE("an error of the output ends a trace and is told", "[sim][vcd]") {
    int calls = 0;
    sim::VcdWriter writer({"a"}, {}, [&](std::string_view) -> Expected<void> {
        ++calls;
        return fail("disk full");
    });
    writer.on_pins(0, 0, ~LineMask{0});
    for (std::uint64_t i = 1; i < 40'000; ++i) writer.on_pins(i, i % 2, 1);
    const Expected<void> finished = writer.finish(50'000);
    REQUIRE_FALSE(finished);
    CHECK(finished.error().message == "disk full");
    CHECK(calls == 1);
}

TEST_CASE("a long trace is written piece by piece", "[sim][vcd]") {
    std::size_t calls = 0;
    std::size_t longest = 0;
    std::string text;
    sim::VcdWriter writer({"a"}, {}, [&](std::string_view bytes) -> Expected<void> {
        ++calls;
        longest = std::max(longest, bytes.size());
        text += bytes;
        return {};
    });
    writer.on_pins(0, 0, ~LineMask{0});
    for (std::uint64_t i = 1; i <= 100'000; ++i) writer.on_pins(i, i % 2, 1);
    REQUIRE(writer.finish(200'000));
    CHECK(calls > 5);
    CHECK(longest < 100'000);
    CHECK(read_vcd(text).changes.size() == 100'000);
}
