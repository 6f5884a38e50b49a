// What transport/lines.h promises, run on every backend, operation by operation.

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "tests/catch.h"
#include "tests/contract/lines/backends.h"

namespace xorvox::transport {
namespace {

constexpr std::uint64_t kShort = 1'000'000;

Wires open_each() {
    const LinesBackend backend = GENERATE(from_range(lines_backends()));
    Wires wires = backend.open();
    wires.backend = backend.name;
    return wires;
}

/// The n-th output, as a mask.
LineMask output(const Wires& wires, int n) {
    LineMask left = wires.lines->info().outputs;
    for (; n > 0; --n) left &= left - 1;
    REQUIRE(left != 0);
    return left & -left;
}

std::uint32_t first_input(const Wires& wires) {
    return static_cast<std::uint32_t>(std::countr_zero(wires.lines->info().inputs));
}

TEST_CASE("lines say what they are, and begin at their safe levels") {
    Wires wires = open_each();
    INFO("backend: " << wires.backend);
    const LinesInfo info = wires.lines->info();
    CHECK(std::string(info.name) != "");
    CHECK(std::popcount(info.outputs) >= 4);
    CHECK(info.inputs != 0);
    CHECK((info.inputs & info.outputs) == 0);
    CHECK(wires.safe_levels != 0);
    CHECK(wires.seen() == wires.safe_levels);
}

TEST_CASE("set gives the lines of its mask their levels, and others keep theirs") {
    Wires wires = open_each();
    INFO("backend: " << wires.backend);
    const LineMask outputs = wires.lines->info().outputs;
    const LineMask a = output(wires, 0), b = output(wires, 1);
    REQUIRE(wires.lines->set(outputs, 0) == Status::Ok);
    CHECK(wires.seen() == 0);
    REQUIRE(wires.lines->set(a, ~LineMask{0}) == Status::Ok);
    CHECK(wires.seen() == a);
    REQUIRE(wires.lines->set(b, b) == Status::Ok);
    CHECK(wires.seen() == (a | b));
    REQUIRE(wires.lines->set(a, b) == Status::Ok);
    CHECK(wires.seen() == b);
    REQUIRE(wires.lines->set(0, outputs) == Status::Ok);
    CHECK(wires.seen() == b);
    REQUIRE(wires.lines->set(outputs, outputs) == Status::Ok);
    CHECK(wires.seen() == outputs);
}

TEST_CASE("lines that are no outputs are refused, and nothing changes") {
    Wires wires = open_each();
    INFO("backend: " << wires.backend);
    const LineMask inputs = wires.lines->info().inputs;
    const LineMask a = output(wires, 0);
    REQUIRE(wires.lines->set(a, 0) == Status::Ok);
    const LineMask before = wires.seen();
    const LineMask wrong = a | (inputs & -inputs);
    const std::array<LineMask, 2> levels{wrong, 0};
    CHECK(wires.lines->set(wrong, wrong) == Status::InvalidArgument);
    CHECK(wires.lines->write(wrong, levels) == Status::InvalidArgument);
    CHECK(wires.lines->strobe(wrong, wrong, 10) == Status::InvalidArgument);
    CHECK(wires.seen() == before);
}

TEST_CASE("write leaves the levels of its last element behind, and none without elements") {
    Wires wires = open_each();
    INFO("backend: " << wires.backend);
    const LineMask a = output(wires, 0), b = output(wires, 1), c = output(wires, 2);
    REQUIRE(wires.lines->set(a | b | c, c) == Status::Ok);
    const LineMask others = wires.seen() & ~(a | b);
    const std::array<LineMask, 5> levels{a, a | b, 0, b, a};
    REQUIRE(wires.lines->write(a | b, levels) == Status::Ok);
    CHECK(wires.seen() == (others | a));
    REQUIRE(wires.lines->write(a | b, {}) == Status::Ok);
    CHECK(wires.seen() == (others | a));
}

TEST_CASE("a strobe ends by itself, and what is set beside it stays") {
    Wires wires = open_each();
    INFO("backend: " << wires.backend);
    const LineMask a = output(wires, 0), b = output(wires, 1);
    REQUIRE(wires.lines->set(a | b, 0) == Status::Ok);
    const LineMask others = wires.seen();
    REQUIRE(wires.lines->strobe(a, a, kShort) == Status::Ok);
    REQUIRE(wires.lines->set(b, b) == Status::Ok);
    REQUIRE(wires.lines->join() == Status::Ok);
    CHECK(wires.seen() == (others | b));
    // Of a line that is low for a while.
    REQUIRE(wires.lines->strobe(b, 0, kShort) == Status::Ok);
    REQUIRE(wires.lines->join() == Status::Ok);
    CHECK(wires.seen() == (others | b));
    REQUIRE(wires.lines->join() == Status::Ok);
}

TEST_CASE("a strobe has ended after a hold that is as long") {
    Wires wires = open_each();
    INFO("backend: " << wires.backend);
    const LineMask a = output(wires, 0);
    REQUIRE(wires.lines->set(a, 0) == Status::Ok);
    const LineMask dark = wires.seen();
    REQUIRE(wires.lines->strobe(a, a, kShort) == Status::Ok);
    REQUIRE(wires.lines->hold(kShort) == Status::Ok);
    CHECK(wires.seen() == dark);
}

TEST_CASE("set ends a strobe of its line, and the strobe's end comes no more") {
    Wires wires = open_each();
    INFO("backend: " << wires.backend);
    const LineMask a = output(wires, 0), b = output(wires, 1);
    REQUIRE(wires.lines->set(a | b, 0) == Status::Ok);
    const LineMask others = wires.seen();
    REQUIRE(wires.lines->strobe(a | b, a | b, kShort) == Status::Ok);
    REQUIRE(wires.lines->set(a, a) == Status::Ok);
    CHECK(wires.seen() == (others | a));
    REQUIRE(wires.lines->hold(2 * kShort) == Status::Ok);
    CHECK(wires.seen() == (others | a));
}

TEST_CASE("a strobe in the middle of another ends that one first") {
    Wires wires = open_each();
    INFO("backend: " << wires.backend);
    const LineMask a = output(wires, 0), b = output(wires, 1);
    REQUIRE(wires.lines->set(a | b, 0) == Status::Ok);
    const LineMask others = wires.seen();
    REQUIRE(wires.lines->strobe(a, a, 1000 * kShort) == Status::Ok);
    REQUIRE(wires.lines->strobe(b, b, kShort) == Status::Ok);
    REQUIRE(wires.lines->join() == Status::Ok);
    CHECK(wires.seen() == others);
}

TEST_CASE("get tells what outputs were set to and what inputs carry") {
    Wires wires = open_each();
    INFO("backend: " << wires.backend);
    const LinesInfo info = wires.lines->info();
    const LineMask a = output(wires, 0);
    const std::uint32_t line = first_input(wires);
    for (const bool level : {true, false, true}) {
        REQUIRE(wires.lines->set(info.outputs, level ? a : 0) == Status::Ok);
        wires.drive(line, level);
        LineMask levels = 0;
        REQUIRE(wires.lines->get(levels) == Status::Ok);
        CHECK((levels & info.outputs) == (level ? a : 0));
        CHECK((levels >> line & 1u) == (level ? 1u : 0u));
    }
}

TEST_CASE("edges of inputs come in order, with their times, and each once") {
    Wires wires = open_each();
    INFO("backend: " << wires.backend);
    const std::uint32_t line = first_input(wires);
    std::array<LineEdge, 2> some;
    std::size_t count = 7;
    if (wires.lines->edges(some, count) == Status::Unsupported) return;
    CHECK(count == 0);
    for (const bool level : {true, true, false, true}) {
        wires.drive(line, level);
        REQUIRE(wires.lines->hold(kShort) == Status::Ok);
    }
    std::vector<LineEdge> edges;
    do {
        REQUIRE(wires.lines->edges(some, count) == Status::Ok);
        edges.insert(edges.end(), some.begin(), some.begin() + static_cast<std::ptrdiff_t>(count));
    } while (count > 0);
    REQUIRE(edges.size() == 3);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(edges[i].line == line);
        CHECK(edges[i].rising == (i != 1));
        if (i > 0) CHECK(edges[i].time_ns >= edges[i - 1].time_ns + kShort);
    }
}

TEST_CASE("of more edges than are kept the newest come, after a word that some were lost") {
    Wires wires = open_each();
    INFO("backend: " << wires.backend);
    const std::uint32_t line = first_input(wires);
    std::vector<LineEdge> edges(wires.most_edges);
    std::size_t count = 0;
    if (wires.lines->edges(edges, count) == Status::Unsupported) return;
    for (std::uint32_t i = 0; i <= wires.most_edges; ++i) wires.drive(line, i % 2 == 0);
    CHECK(wires.lines->edges(edges, count) == Status::Corrupt);
    REQUIRE(count == wires.most_edges);
    CHECK_FALSE(edges.front().rising);
    CHECK(edges.back().rising == (wires.most_edges % 2 == 0));
    CHECK(wires.lines->edges(edges, count) == Status::Ok);
    CHECK(count == 0);
}

TEST_CASE("wait ends with an edge that is there, or with its timeout") {
    Wires wires = open_each();
    INFO("backend: " << wires.backend);
    const Status nothing = wires.lines->wait(1000);
    if (nothing == Status::Unsupported) return;
    CHECK(nothing == Status::Timeout);
    CHECK(wires.lines->wait(0) == Status::Timeout);
    CHECK(wires.lines->wait(-5) == Status::Timeout);
    wires.drive(first_input(wires), true);
    CHECK(wires.lines->wait(10'000'000'000) == Status::Ok);
}

TEST_CASE("closing sets the safe levels, also in the middle of a strobe") {
    Wires wires = open_each();
    INFO("backend: " << wires.backend);
    const LineMask outputs = wires.lines->info().outputs;
    REQUIRE(wires.lines->set(outputs, ~wires.safe_levels) == Status::Ok);
    REQUIRE(wires.lines->strobe(output(wires, 0), output(wires, 0), 1000 * kShort) == Status::Ok);
    wires.lines.reset();
    CHECK(wires.seen() == wires.safe_levels);
}

}  // namespace
}  // namespace xorvox::transport
