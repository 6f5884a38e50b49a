#include "driver/device/schedule.h"

#include <vector>

#include "driver/device/config.h"
#include "tests/catch.h"

using namespace xorvox;
using namespace xorvox::device;

namespace {

/// Goes through the cycle from place to place, and checks that they join.
std::vector<SliceSchedule::Place> walk(const SliceSchedule& schedule, std::uint32_t cycle = 0) {
    std::vector<SliceSchedule::Place> places;
    Phase phase = Phase{cycle} << 32;
    const Phase end = phase + kCycle;
    while (phase != end) {
        const SliceSchedule::Place place = schedule.at(phase);
        REQUIRE(place.begin == phase);
        REQUIRE(phase_between(phase, place.end) > 0);
        const SliceSchedule::Place last = schedule.at(place.end - 1);
        REQUIRE(last.begin == place.begin);
        REQUIRE(last.end == place.end);
        if (place.lit) REQUIRE(place.slice < schedule.slices);
        places.push_back(place);
        phase = place.end;
    }
    return places;
}

DisplayDescription swept(bool both_ways, double dead_zone) {
    DisplayDescription display;
    display.kind = DisplayKind::SweptPlane;
    display.slices = 5;
    display.cycles_per_second = 15.0;
    display.motion = {.stroke_mm = 80.0, .both_ways = both_ways, .dead_zone = dead_zone};
    display.panels[0] = {.columns = 8, .rows = 8};
    return display;
}

}  // namespace

TEST_CASE("the slices of a turn share it evenly, whatever their number") {
    for (const std::uint32_t slices : {1u, 2u, 3u, 7u, 360u, 4096u}) {
        SliceSchedule schedule;
        schedule.slices = slices;
        const auto places = walk(schedule, 0xffffffffu);
        REQUIRE(places.size() == slices);
        for (std::uint32_t s = 0; s < slices; ++s) {
            CHECK(places[s].slice == s);
            const Phase length = places[s].end - places[s].begin;
            CHECK(length - kCycle / slices <= 1);
        }
    }
}

TEST_CASE("a rotor of half turns shows every second one mirrored") {
    DisplayDescription display;
    display.kind = DisplayKind::RotatingPanel;
    display.slices = 180;
    display.cycles_per_second = 40.0;
    display.sweep_deg = 180.0;
    display.panels[0] = {.columns = 8, .rows = 8};
    const SliceSchedule schedule = slice_schedule(display);
    for (std::uint32_t cycle = 0; cycle < 4; ++cycle) {
        for (const auto& place : walk(schedule, cycle)) CHECK(place.mirrored == (cycle % 2 == 1));
    }
    CHECK(rotation_config(display).cycles_per_turn == 2);
    display.sweep_deg = 360.0;
    for (const auto& place : walk(slice_schedule(display), 1)) CHECK_FALSE(place.mirrored);
}

TEST_CASE("a plane that is lit both ways goes through its slices up and then down, dark at both ends") {
    const auto places = walk(slice_schedule(swept(true, 0.1)));
    std::vector<int> order;
    for (const auto& place : places) order.push_back(place.lit ? static_cast<int>(place.slice) : -1);
    CHECK(order == std::vector<int>{-1, 0, 1, 2, 3, 4, -1, 4, 3, 2, 1, 0, -1});
    // The upper dead zone of both sweeps is one dark part, a tenth of a cycle; the lower one is cut by the cycle's end.
    CHECK(static_cast<double>(places[6].end - places[6].begin) / kCycle == Approx(0.1));
    CHECK(static_cast<double>(places[0].end - places[0].begin) / kCycle == Approx(0.05));
    // Slice s is lit at the same heights: its two times are mirrors of each other.
    CHECK(std::abs(static_cast<double>(places[1].begin + places[11].end) - kCycle) <= 2.0);
}

TEST_CASE("a plane that is lit one way flies back dark") {
    const auto places = walk(slice_schedule(swept(false, 0.0)));
    REQUIRE(places.size() == 6);
    for (std::uint32_t s = 0; s < 5; ++s) CHECK((places[s].lit && places[s].slice == s));
    CHECK_FALSE(places[5].lit);
    CHECK(places[5].begin == kCycle / 2);
    CHECK(places[5].end == kCycle);
}

TEST_CASE("LEDs that keep their colour have one slice, the whole frame") {
    DisplayDescription display;
    display.slices = 16;
    display.cycles_per_second = 60.0;
    display.format = PixelFormat::Rgb888;
    display.panels[0] = {.columns = 16, .rows = 16};
    CHECK(walk(slice_schedule(display)).size() == 16);
    display.scan.driver = DriverChip::Ws2812;
    CHECK(walk(slice_schedule(display)).size() == 1);
    CHECK(scan_control_config(display).slice_bytes == frame_bytes(display));
    CHECK(current_config(display).slices == 16);
}

TEST_CASE("the integers of a description are computed when it is compiled") {
    static constexpr DisplayDescription kHelix = [] {
        DisplayDescription display;
        display.kind = DisplayKind::Helix;
        display.slices = 100;
        display.cycles_per_second = 30.0;
        display.blades = 2;
        display.motion.stroke_mm = 100.0;
        display.panels[0] = {.columns = 64, .rows = 64};
        display.sync = {.index = IndexSource::Pulses, .index_pulses = 1, .index_phase = 0.25};
        display.power = {.led_ma = 20.0, .limit_ma = 1500.0};
        return display;
    }();
    static constexpr ScanControlConfig kConfig = scan_control_config(kHelix, {.reports_scans = true});
    static_assert(kConfig.rotation.cycles_per_turn == 2);
    static_assert(kConfig.rotation.mark_phase == 0x40000000);
    static_assert(kConfig.rotation.longest_turn_ns == 133'333'333);
    static_assert(kConfig.rotation.shortest_turn_ns == 53'333'333);
    static_assert(kConfig.current.led_ua == 20'000);
    static_assert(kConfig.current.limit_ua == 1'500'000);
    static_assert(kConfig.late_ns == 333'333);
    CHECK_FALSE(kConfig.has_interlock);
}
