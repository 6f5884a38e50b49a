// Virtual lines: every change comes to the observer in its place and at its nanosecond.
#include "transport/virtual_lines.h"

#include <array>
#include <cstdint>
#include <vector>

#include "tests/catch.h"

using namespace xorvox;
using transport::VirtualLines;
using transport::VirtualLinesOptions;

namespace {

struct Change {
    std::uint64_t time_ns = 0;
    LineMask levels = 0;
    LineMask changed = 0;
    bool operator==(const Change&) const = default;
};

std::string to_text(const std::vector<Change>& changes) {
    std::string text;
    for (const Change& c : changes) {
        text += std::to_string(c.time_ns) + ":" + std::to_string(c.levels) + "/" + std::to_string(c.changed) + " ";
    }
    return text;
}

struct Seen {
    std::vector<Change> changes;
    VirtualLines virtual_lines;
    Lines lines = virtual_lines.lines();

    explicit Seen(std::uint32_t set_hz = 0, std::uint64_t start_ns = 0)
        : virtual_lines(VirtualLinesOptions{.outputs = 0xff,
                                            .inputs = 0xf00,
                                            .set_hz = set_hz,
                                            .safe_levels = 0x80,
                                            .start_ns = start_ns,
                                            .observer = [this](std::uint64_t t, LineMask levels, LineMask changed) {
                                                changes.push_back({t, levels, changed});
                                            }}) {
        CHECK(to_text(changes) == std::to_string(start_ns) + ":128/4095 ");
        changes.clear();
    }
    std::string text() const { return to_text(changes); }
};

}  // namespace

TEST_CASE("virtual lines set at once, hold, and tell only what changed") {
    Seen seen(0, 500);
    REQUIRE(seen.lines.set(0x83, 0x01) == Status::Ok);
    REQUIRE(seen.lines.set(0x83, 0x01) == Status::Ok);
    REQUIRE(seen.lines.hold(250) == Status::Ok);
    REQUIRE(seen.lines.set(0x03, 0x03) == Status::Ok);
    seen.virtual_lines.advance_to(700);
    CHECK(seen.virtual_lines.time_ns() == 750);
    seen.virtual_lines.advance_to(900);
    CHECK(seen.virtual_lines.time_ns() == 900);
    CHECK(seen.text() == "500:1/129 750:3/2 ");
    CHECK(seen.virtual_lines.sets() == 3);
}

TEST_CASE("virtual lines write at their pace: elements rounded down, the end rounded up") {
    // 333.33 ns an element.
    Seen seen(3'000'000, 10);
    const std::array<LineMask, 5> levels{1, 0, 0, 1, 0};
    REQUIRE(seen.lines.write(1, levels) == Status::Ok);
    CHECK(seen.text() == "10:129/1 343:128/1 1010:129/1 1343:128/1 ");
    CHECK(seen.virtual_lines.time_ns() == 10 + 1667);
    REQUIRE(seen.lines.write(1, std::span(levels).first(3)) == Status::Ok);
    CHECK(seen.virtual_lines.time_ns() == 10 + 1667 + 1000);

    Seen fast(4'000'000'000u);
    const std::array<LineMask, 9> nine{1, 0, 1, 0, 1, 0, 1, 0, 1};
    REQUIRE(fast.lines.write(1, nine) == Status::Ok);
    CHECK(fast.virtual_lines.time_ns() == 3);
    CHECK(fast.changes.size() == 9);
    CHECK(fast.changes.back().time_ns == 2);
}

TEST_CASE("a strobe of virtual lines ends in its place between other changes") {
    Seen seen(10'000'000);
    REQUIRE(seen.lines.strobe(0x80, 0, 250) == Status::Ok);
    const std::array<LineMask, 5> levels{1, 2, 1, 2, 1};
    REQUIRE(seen.lines.write(3, levels) == Status::Ok);
    CHECK(seen.text() == "0:0/128 0:1/1 100:2/3 200:1/3 250:129/128 300:130/3 400:129/3 ");
    CHECK(seen.virtual_lines.time_ns() == 500);
    seen.changes.clear();
    REQUIRE(seen.lines.strobe(0x80, 0, 300) == Status::Ok);
    REQUIRE(seen.lines.join() == Status::Ok);
    CHECK(seen.virtual_lines.time_ns() == 800);
    REQUIRE(seen.lines.join() == Status::Ok);
    CHECK(seen.virtual_lines.time_ns() == 800);
    CHECK(seen.text() == "500:1/128 800:129/128 ");
}

TEST_CASE("set ends a strobe of its lines, and another strobe does") {
    Seen seen;
    REQUIRE(seen.lines.strobe(0x03, 0x03, 100) == Status::Ok);
    REQUIRE(seen.lines.hold(40) == Status::Ok);
    REQUIRE(seen.lines.set(0x01, 0x01) == Status::Ok);
    REQUIRE(seen.lines.join() == Status::Ok);
    CHECK(seen.virtual_lines.time_ns() == 40);
    REQUIRE(seen.lines.strobe(0x04, 0x04, 100) == Status::Ok);
    REQUIRE(seen.lines.hold(10) == Status::Ok);
    REQUIRE(seen.lines.strobe(0x08, 0x08, 100) == Status::Ok);
    REQUIRE(seen.lines.hold(1000) == Status::Ok);
    CHECK(seen.text() == "0:131/3 40:129/2 40:133/4 50:137/12 150:129/8 ");
}

TEST_CASE("what is beyond the limit happens when the limit is raised, element by element") {
    Seen free_running(10'000'000), seen(10'000'000);
    const std::array<LineMask, 4> levels{1, 2, 1, 2};
    const auto work = [&](Seen& s) {
        REQUIRE(s.lines.strobe(0x80, 0, 270) == Status::Ok);
        REQUIRE(s.lines.write(3, levels) == Status::Ok);
        REQUIRE(s.lines.hold(100) == Status::Ok);
        REQUIRE(s.lines.strobe(0x40, 0x40, 50) == Status::Ok);
        REQUIRE(s.lines.set(0x04, 0x04) == Status::Ok);
        REQUIRE(s.lines.hold(100) == Status::Ok);
    };
    work(free_running);
    seen.virtual_lines.limit(0);
    work(seen);
    CHECK(seen.virtual_lines.time_ns() == 600);
    CHECK(seen.text() == "0:0/128 0:1/1 ");
    for (std::uint64_t t = 1; t <= 600; ++t) {
        seen.virtual_lines.limit(t);
        std::vector<Change> until;
        for (const Change& change : free_running.changes) {
            if (change.time_ns <= t) until.push_back(change);
        }
        REQUIRE(seen.changes == until);
    }
}

TEST_CASE("a cut undoes what is beyond the limit, and a strobe that has begun still ends") {
    Seen seen(10'000'000);
    seen.virtual_lines.limit(150);
    const std::array<LineMask, 4> levels{1, 2, 1, 2};
    REQUIRE(seen.lines.strobe(0x80, 0, 170) == Status::Ok);
    REQUIRE(seen.lines.write(3, levels) == Status::Ok);
    REQUIRE(seen.lines.join() == Status::Ok);
    REQUIRE(seen.lines.strobe(0x80, 0, 1000) == Status::Ok);
    seen.virtual_lines.cut();
    CHECK(seen.virtual_lines.time_ns() == 150);
    seen.virtual_lines.limit(VirtualLines::kNoLimit);
    REQUIRE(seen.lines.join() == Status::Ok);
    CHECK(seen.virtual_lines.time_ns() == 170);
    CHECK(seen.text() == "0:0/128 0:1/1 100:2/3 170:130/128 ");
    // And one that is set in the time that was cut.
    seen.virtual_lines.limit(200);
    REQUIRE(seen.lines.strobe(0x80, 0, 100) == Status::Ok);
    REQUIRE(seen.lines.hold(60) == Status::Ok);
    REQUIRE(seen.lines.set(0x80, 0x80) == Status::Ok);
    seen.virtual_lines.cut();
    seen.virtual_lines.limit(VirtualLines::kNoLimit);
    REQUIRE(seen.lines.join() == Status::Ok);
    CHECK(seen.virtual_lines.time_ns() == 270);
    CHECK(seen.changes.back().time_ns == 270);
}

TEST_CASE("inputs are driven, seen, and timed") {
    Seen seen(0, 1000);
    seen.virtual_lines.drive(8, true);
    REQUIRE(seen.lines.hold(300) == Status::Ok);
    seen.virtual_lines.drive(8, true);
    seen.virtual_lines.drive(11, true);
    seen.virtual_lines.drive(0, true);   // An output,
    seen.virtual_lines.drive(70, true);  // and none at all.
    CHECK(seen.text() == "1000:384/256 1300:2432/2048 ");
    std::array<LineEdge, 4> edges;
    std::size_t count = 0;
    REQUIRE(seen.lines.edges(edges, count) == Status::Ok);
    REQUIRE(count == 2);
    CHECK(edges[0].time_ns == 1000);
    CHECK(edges[1].time_ns == 1300);
    CHECK(edges[1].line == 11);
    REQUIRE(seen.lines.wait(250) == Status::Timeout);
    CHECK(seen.virtual_lines.time_ns() == 1550);
}

TEST_CASE("a set that was told to fail changes nothing") {
    Seen seen(10'000'000);
    const std::array<LineMask, 2> levels{1, 0};
    seen.virtual_lines.fail_sets(1, 2);
    REQUIRE(seen.lines.set(1, 1) == Status::Ok);
    CHECK(seen.lines.write(1, levels) == Status::Closed);
    CHECK(seen.lines.strobe(1, 0, 100) == Status::Closed);
    CHECK(seen.virtual_lines.time_ns() == 0);
    REQUIRE(seen.lines.set(1, 0) == Status::Ok);
    CHECK(seen.text() == "0:129/1 0:128/1 ");
}

TEST_CASE("closed virtual lines are at their safe levels and answer Closed") {
    Seen seen;
    REQUIRE(seen.lines.strobe(0xff, 0x7f, 100) == Status::Ok);
    { const UniqueLines owner(seen.lines); }
    CHECK(seen.text() == "0:127/255 0:128/255 ");
    LineMask levels = 0;
    std::size_t count = 0;
    CHECK(seen.lines.set(1, 1) == Status::Closed);
    CHECK(seen.lines.write(1, {}) == Status::Closed);
    CHECK(seen.lines.hold(1) == Status::Closed);
    CHECK(seen.lines.strobe(1, 1, 1) == Status::Closed);
    CHECK(seen.lines.join() == Status::Closed);
    CHECK(seen.lines.get(levels) == Status::Closed);
    CHECK(seen.lines.edges({}, count) == Status::Closed);
    CHECK(seen.lines.wait(1) == Status::Closed);
    seen.virtual_lines.advance_to(5000);
    CHECK(seen.virtual_lines.levels() == 0x80);
}
