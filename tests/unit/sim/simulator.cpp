#include "sim/simulator.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "driver/display/toml.h"
#include "driver/wire/messages.h"
#include "sim/make_sim.h"
#include "tests/catch.h"
#include "tests/unit/sim/displays.h"
#include "transport/loopback.h"

namespace xorvox {
namespace {

using namespace test;
using sim::make_sim;

constexpr std::uint64_t kCycle_ns = 10'000'000;  // stack_of turns over 100 times a second

/// A simulator, and a host that knows the wire alone.
struct Bench {
    DisplayDescription display = stack_of(5, 4, 3, PixelFormat::Rgb888);
    std::pair<UniqueLink, UniqueLink> ends = transport::make_loopback();
    sim::Simulator simulator = make(display, ends.second.get());
    std::uint32_t sequence = 0;

    static sim::Simulator make(const DisplayDescription& display, Link link) {
        auto made = sim::Simulator::make(display, link);
        INFO((made ? "" : made.error().message));
        REQUIRE(made.has_value());
        return std::move(*made);
    }

    template <class Message>
    void send(const Message& message) {
        std::vector<std::byte> packet(wire::kMaxPacketBytes);
        std::size_t size = 0;
        REQUIRE(wire::encode_packet(3, sequence++, message, packet, size) == Status::Ok);
        REQUIRE(ends.first->send(std::span(packet).first(size)) == Status::Ok);
    }

    void send_frame(std::uint32_t frame, const std::vector<std::byte>& page) {
        send(wire::FrameBegin{.frame = frame, .frame_bytes = static_cast<std::uint32_t>(page.size())});
        send(wire::Chunk{.frame = frame,
                         .offset = 0,
                         .decoded_length = static_cast<std::uint32_t>(page.size()),
                         .codec = wire::Codec::Raw,
                         .data = page});
        send(wire::FrameEnd{.frame = frame, .page_crc = wire::crc32c(page)});
    }

    /// A page with one red pixel in `column` of the first row.
    std::vector<std::byte> page_with(std::uint32_t column) const {
        std::vector<std::byte> page = dark_page(display);
        set_pixel(display, page, {.column = column}, 0xff);
        return page;
    }

    void poll(std::uint64_t now_ns) { (void)simulator.poll(now_ns); }
};

TEST_CASE("a simulated display is dark until a frame was sent") {
    Bench bench;
    bench.poll(3 * kCycle_ns);
    CHECK(bench.simulator.light().flashes.empty());
}

TEST_CASE("a frame lights up at the next boundary of a cycle and not before") {
    Bench bench;
    bench.poll(0);
    bench.send(wire::HelloRequest{});
    bench.send_frame(1, bench.page_with(2));
    bench.poll(1);
    bench.poll(kCycle_ns - 1);
    CHECK(bench.simulator.light().flashes.empty());
    CHECK(bench.simulator.next_boundary_ns() == kCycle_ns);
    bench.poll(kCycle_ns);
    CHECK(bench.simulator.next_boundary_ns() == 2 * kCycle_ns);
    const sim::LightField field = bench.simulator.light();
    REQUIRE(field.flashes.size() == 1);
    CHECK(field.flashes[0].code == 0xff);
    CHECK(field.light(field.flashes[0]) == glm::vec3(1.0f, 0.0f, 0.0f));
    CHECK(field.flashes[0].place_mm == glm::dvec3(0.0, -4.5, -7.0));
    CHECK(bench.simulator.device().status(kCycle_ns).shown_frame == 1);
}

TEST_CASE("a long pause ends at the boundary before now") {
    Bench bench;
    bench.poll(0);
    bench.send(wire::HelloRequest{});
    bench.send_frame(1, bench.page_with(0));
    bench.poll(1);
    bench.poll(50 * kCycle_ns + 5);
    CHECK(bench.simulator.light().flashes.size() == 1);
    CHECK(bench.simulator.next_boundary_ns() == 51 * kCycle_ns);
}

TEST_CASE("a host that falls silent for long leaves the display dark") {
    Bench bench;
    bench.send(wire::HelloRequest{});
    bench.send_frame(1, bench.page_with(0));
    bench.poll(1);
    bench.poll(1'000'000'000 * kCycle_ns);
    CHECK(bench.simulator.light().flashes.empty());
}

TEST_CASE("brightness and blanking by the host change the light") {
    Bench bench;
    bench.send(wire::HelloRequest{});
    bench.send_frame(1, bench.page_with(0));
    bench.send(wire::Control{.operation = wire::ControlOperation::Brightness, .value = 51});
    bench.poll(1);
    bench.poll(kCycle_ns);
    const sim::LightField dimmed = bench.simulator.light();
    REQUIRE(dimmed.flashes.size() == 1);
    CHECK(dimmed.light(dimmed.flashes[0]).x == Approx(0.2f));
    bench.send(wire::Control{.operation = wire::ControlOperation::Blank, .value = 1});
    bench.poll(kCycle_ns + 1);
    CHECK(bench.simulator.light().flashes.empty());
}

/// What is seen of a frame whose pixel `column` of the first row is lit.
sim::LightField seen(const sim::MakeSim& sim, std::uint32_t column) {
    auto rig = sim.build();
    REQUIRE(rig.has_value());
    std::vector<std::byte> page = dark_page(rig->display());
    set_pixel(rig->display(), page, {.column = column}, 0xff);
    rig->show(page);
    rig->run_for(cycle_ns(rig->display()));
    return rig->simulator().light();
}

TEST_CASE("a simulator with a fault shows the same frame elsewhere") {
    auto stack = make_sim().stacked(3).panel(5, 4).format(PixelFormat::Rgb888);
    CHECK(seen(stack, 0).flashes.at(0).place_mm.x == -4.0);
    CHECK(seen(stack.fault({.kind = sim::FaultKind::Mirrored}), 0).flashes.at(0).place_mm.x == 4.0);
}

sim::LightField seen_as_built(const DisplayDescription& display, const DisplayDescription& built,
                              std::uint32_t column) {
    return seen(make_sim().display(display).built_like(built), column);
}

TEST_CASE("light is where the display as it is built has its pixels") {
    const DisplayDescription stack = stack_of(5, 4, 3, PixelFormat::Rgb888);
    DisplayDescription wider = stack;
    wider.panels[0].column_pitch_mm = 5.0;
    sim::LightField field = seen_as_built(stack, wider, 0);
    REQUIRE(field.flashes.size() == 1);
    CHECK(field.flashes[0].place_mm == glm::dvec3(-10.0, -4.5, -7.0));

    const DisplayDescription rotor = rotor_of(8, 4, 12, PixelFormat::Rgb888);
    DisplayDescription mounted = rotor;
    mounted.panels[0].mirrored = true;
    mounted.panels[0].lift_mm = 2.5;
    const glm::dvec3 mirrored = seen_as_built(rotor, rotor, 7).flashes.at(0).place_mm;
    field = seen_as_built(rotor, mounted, 0);
    REQUIRE(field.flashes.size() == 1);
    CHECK(glm::distance(field.flashes[0].place_mm, mirrored + glm::dvec3(0.0, 0.0, 2.5)) < 1e-9);
}

TEST_CASE("where the index mark comes at another phase, light is turned by the difference, whichever way it goes") {
    const bool clockwise = GENERATE(false, true);
    DisplayDescription rotor = rotor_of(8, 4, 12, PixelFormat::Rgb888);
    rotor.clockwise = clockwise;
    rotor.sync.index = IndexSource::Pulses;
    rotor.sync.index_phase = 0.9;
    DisplayDescription marked = rotor;
    marked.sync.index_phase = 0.15;  // A quarter of a turn further.
    const glm::dvec3 right = seen_as_built(rotor, rotor, 7).flashes.at(0).place_mm;
    const glm::dvec3 turned = seen_as_built(rotor, marked, 7).flashes.at(0).place_mm;
    const double sign = clockwise ? -1.0 : 1.0;
    CHECK(glm::distance(turned, glm::dvec3(-sign * right.y, sign * right.x, right.z)) < 1e-9);
}

TEST_CASE("a plane that is lit both ways shows a slice at two heights where its index mark is off") {
    DisplayDescription plane = swept_of(5, 4, 10, MotionProfile::Constant, PixelFormat::Rgb888);
    plane.plane_pitch_mm = 1.0;
    plane.motion.both_ways = true;
    plane.motion.dead_zone = 0.25;  // The ten slices take a quarter of a cycle each way.
    plane.sync.index = IndexSource::Pulses;
    DisplayDescription marked = plane;
    marked.sync.index_phase = 0.05;
    marked.motion.dead_zone = 0.0;  // Which is for the device to keep.
    const glm::dvec3 right = seen_as_built(plane, plane, 2).flashes.at(0).place_mm;
    const sim::LightField field = seen_as_built(plane, marked, 2);
    REQUIRE(field.flashes.size() == 2);
    CHECK(glm::distance(field.flashes[0].place_mm, right + glm::dvec3(0.0, 0.0, 6.0)) < 1e-9);
    CHECK(glm::distance(field.flashes[1].place_mm, right - glm::dvec3(0.0, 0.0, 6.0)) < 1e-9);
}

TEST_CASE("a display cannot be built so that its frames have another layout") {
    const DisplayDescription rotor = rotor_of(8, 4, 12);
    const auto refused = [&](DisplayDescription built, const std::string& why) {
        sim::SimulatorOptions options;
        options.built = built;
        const auto made = sim::Simulator::make(rotor, Link{}, options);
        REQUIRE_FALSE(made.has_value());
        CHECK_THAT(made.error().message, Catch::Contains(why));
    };
    refused(stack_of(8, 4, 12), "rotor cannot really be built like stack: another kind of display");
    refused(rotor_of(8, 4, 12, PixelFormat::Rgb332), "format rgb332 instead of mono1");
    refused(rotor_of(8, 4, 13), "slices 13 instead of 12");
    refused(rotor_of(8, 4, 12, PixelFormat::Mono1, 1), "panels 1 instead of 2");
    refused(rotor_of(9, 4, 12), "panel 0: columns 9 instead of 8");
    DisplayDescription last = rotor;
    last.panels[1].rows = 5;
    refused(last, "panel 1: rows 5 instead of 4");
    last.panels[1].rows = 0;
    refused(last, "rows");
}

TEST_CASE("a simulator whose client does not read waits for room and not for packets") {
    Bench bench;
    Link link = bench.ends.second.get();
    bench.send(wire::HelloRequest{});
    std::vector<std::byte> packet(wire::kMinPacketBytes);
    std::size_t size = 0;
    for (Status sent = Status::Ok; sent == Status::Ok;) {
        REQUIRE(wire::encode_packet(3, bench.sequence++, wire::Ping{}, packet, size) == Status::Ok);
        sent = bench.ends.first->send(std::span(packet).first(size));
        while (bench.simulator.poll(1) == Status::Ok) {
        }
    }
    CHECK(link.wait(kLinkReadable, 0) == Status::Ok);  // What the client sends waits as well.
    CHECK(link.wait(bench.simulator.device().events(), 0) == Status::Timeout);

    std::vector<std::byte> answer(wire::kMaxPacketBytes);
    while (bench.ends.first->receive(answer, size) == Status::Ok) {
    }
    CHECK(link.wait(bench.simulator.device().events(), 0) == Status::Ok);
    CHECK(bench.simulator.poll(1) == Status::Ok);
}

TEST_CASE("a display that cannot be is refused in the words of its rules") {
    std::vector<DisplayDescription> displays(4, rotor_of(4, 4, 8));
    displays[0].cycles_per_second = 0.0;
    displays[1].cycles_per_second = -1.0;
    displays[2].panel_count = 1000;
    displays[3].slices = 0;
    for (const DisplayDescription& display : displays) {
        const auto made = sim::Simulator::make(display, Link{});
        REQUIRE_FALSE(made.has_value());
        CHECK(made.error().message == validate_display(display).error().message);
    }
}

TEST_CASE("sizes that no device has are refused in words") {
    sim::SimulatorOptions options;
    options.pages = 1;
    const auto made = sim::Simulator::make(stack_of(2, 2, 2), Link{}, options);
    REQUIRE_FALSE(made.has_value());
    CHECK(made.error().message.find("1 pages, allowed 2 to 8") != std::string::npos);
}

}  // namespace
}  // namespace xorvox
