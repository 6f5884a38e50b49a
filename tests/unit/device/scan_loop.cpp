// The loop of a whole device on virtual lines: packets come in, layers light up, faults darken the pins.
#include "driver/device/scan/scan_loop.h"

#include <cstdint>
#include <vector>

#include "driver/device/config.h"
#include "tests/catch.h"
#include "tests/unit/device/rig.h"
#include "tests/unit/device/scan_rig.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

/// kCube8 behind 74HC595.
DisplayDescription shifted_cube8() {
    DisplayDescription display = kCube8;
    display.scan.driver = DriverChip::ShiftRegister595;
    display.scan.pixel_clock_hz = 8'000'000;
    display.scan.latch_ns = 1000;
    display.scan.min_on_ns = 10'000;
    return display;
}

/// A cube on a desk, whose frame is shown; it knows no time but that of its lines.
struct LitCube : Desk {
    DisplayDescription display = shifted_cube8();
    device::ShiftRegisterConfig config = device::shift_register_config(display);
    Bench bench{display, config.scan.used, safe_levels(config.pins),
                std::make_unique<ShiftRegisterChips>(display, config.pins)};
    std::vector<std::uint64_t> buffer = std::vector<std::uint64_t>(scan_buffer_words(config));
    device::ScanControl control;
    device::ShiftRegisterScan scanner;
    device::ScanLoop<device::ShiftRegisterScan> loop{control, scanner};

    LitCube() {
        hello();
        accept(1, frame_of(1));
        bench.lines->advance_to(now_ns);
        REQUIRE(control.init(device::scan_control_config(display, {.reports_scans = true}), device, now_ns) ==
                Status::Ok);
        REQUIRE(scanner.init(config, bench.lines->lines(), buffer) == Status::Ok);
        REQUIRE(loop.stop() == Status::Ok);
    }

    bool dark() const {
        return !bench.chips().output_on() && bench.chips().rows_released() && bench.chips().columns_clear();
    }

    Status round() {
        now_ns = bench.lines->time_ns();
        while (device.poll(now_ns) == Status::Ok) {
        }
        const Status status = loop.poll(now_ns);
        if (bench.lines->time_ns() == now_ns) bench.lines->advance_to(now_ns + 5000);
        return status;
    }
    /// The loop, for so long or until a round goes wrong.
    Status run(std::uint64_t ns) {
        const std::uint64_t end_ns = bench.lines->time_ns() + ns;
        Status status = Status::Ok;
        while (bench.lines->time_ns() < end_ns && status == Status::Ok) status = round();
        return status;
    }
};

constexpr std::uint64_t kMs = 1'000'000;

}  // namespace

TEST_CASE("the scan loop lights the layers of a cube in turn, each in its slice, and reports in time") {
    LitCube cube;
    const std::uint64_t begin_ns = cube.now_ns;
    REQUIRE(cube.run(200 * kMs) == Status::Ok);
    CHECK(cube.device.fault() == Fault::None);
    const auto& lights = cube.bench.lights;
    REQUIRE(lights.size() > 8 * 10);
    const double slice_ns = 1e9 / 60 / 8;
    bool in_place = true;
    for (std::size_t i = 0; i + 1 < lights.size(); ++i) {
        const auto middle = static_cast<double>((lights[i].on_ns + lights[i].off_ns) / 2 - begin_ns);
        in_place = in_place && lights[i].selected == static_cast<int>(middle / slice_ns) % 8;
        in_place = in_place && static_cast<double>(lights[i].off_ns - lights[i].on_ns) > 0.9 * slice_ns;
    }
    CHECK(in_place);
    CHECK_FALSE(cube.bench.several);
}

TEST_CASE("a fault darkens the pins within a step of the scan loop") {
    LitCube cube;
    REQUIRE(cube.run(100 * kMs) == Status::Ok);
    CHECK(cube.bench.lights.size() > 20);
    std::uint64_t fault_ns = 0;
    while (cube.device.fault() == Fault::None) {
        REQUIRE(cube.round() == Status::Ok);
        fault_ns = cube.bench.lines->time_ns();
    }
    CHECK(cube.device.fault() == Fault::SilentHost);
    REQUIRE(cube.round() == Status::Ok);
    REQUIRE(cube.round() == Status::Ok);
    CHECK(cube.dark());
    CHECK(cube.bench.lights.back().off_ns <= fault_ns + 2 * 120'000);
    const std::size_t lights = cube.bench.lights.size();
    REQUIRE(cube.run(100 * kMs) == Status::Ok);
    CHECK(cube.bench.lights.size() == lights);
}

TEST_CASE("lines that fail raise a fault, and nothing is lit until it is cleared") {
    for (const std::uint64_t failures : {1u, 3u, 5000u}) {
        LitCube cube;
        REQUIRE(cube.run(50 * kMs) == Status::Ok);
        cube.bench.lines->fail_sets(3, failures);
        REQUIRE(cube.run(50 * kMs) == Status::Closed);
        const std::uint64_t failed_ns = cube.bench.lines->time_ns();
        for (int i = 0; i < 20'000; ++i) (void)cube.round();
        CHECK(cube.device.fault() == Fault::LateScan);
        CHECK(cube.dark());
        CHECK(cube.bench.lights.back().on_ns <= failed_ns);
        const std::size_t lights = cube.bench.lights.size();

        while (!cube.link.from_device.empty()) cube.link.from_device.pop_front();
        cube.send(Control{.operation = ControlOperation::ClearFault, .value = 2});
        REQUIRE(cube.run(50 * kMs) == Status::Ok);
        CHECK(cube.device.fault() == Fault::None);
        CHECK(cube.bench.lights.size() > lights + 10);
    }
}

TEST_CASE("a stop that fails is tried again by the next round, and nothing is lit until it was ordered dark") {
    LitCube cube;
    REQUIRE(cube.run(30 * kMs) == Status::Ok);
    while (!cube.bench.chips().output_on()) REQUIRE(cube.round() == Status::Ok);
    cube.bench.lines->fail_sets(0, 1000);
    REQUIRE(cube.loop.stop() == Status::Closed);
    cube.bench.lines->fail_sets(0, 0);
    const std::size_t lights = cube.bench.lights.size();
    REQUIRE(cube.round() == Status::Ok);
    CHECK(cube.dark());
    for (int i = 0; i < 20'000; ++i) (void)cube.round();
    CHECK(cube.device.fault() == Fault::LateScan);
    CHECK(cube.bench.lights.size() == lights);
}

TEST_CASE("a scan loop that is stopped is dark, in the middle of whatever it does") {
    LitCube cube;
    REQUIRE(cube.run(30 * kMs) == Status::Ok);
    while (!cube.bench.chips().output_on()) REQUIRE(cube.round() == Status::Ok);
    const std::uint64_t now_ns = cube.bench.lines->time_ns();
    REQUIRE(cube.loop.stop() == Status::Ok);
    CHECK(cube.bench.lights.back().off_ns == now_ns);
    CHECK(cube.dark());
    REQUIRE(cube.run(10 * kMs) == Status::Ok);
    CHECK(cube.bench.lights.back().on_ns > now_ns);
}
