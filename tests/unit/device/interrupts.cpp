// Interrupts are threads here: they come at any time, also in the middle of poll(). ThreadSanitizer sees more of it.
#include <atomic>
#include <thread>

#include "driver/device/config.h"
#include "driver/device/scan_control.h"
#include "tests/unit/device/rig.h"

using namespace xorvox;
using namespace xorvox::test;

TEST_CASE("the ring gives every event once, whole and in order, while both sides work") {
    constexpr std::int32_t kEvents = 100'000;
    device::EventRing ring;
    std::thread writer([&] {
        for (std::int32_t i = 1; i <= kEvents; ++i) {
            while (!ring.push({static_cast<std::uint64_t>(i) * 0x100000001, i})) std::this_thread::yield();
        }
    });
    int wrong = 0;
    for (std::int32_t expected = 1; expected <= kEvents;) {
        const device::RotationEvent* event = ring.front();
        if (event == nullptr) {
            std::this_thread::yield();
            continue;
        }
        if (event->steps != expected || event->time_ns != static_cast<std::uint64_t>(expected) * 0x100000001) ++wrong;
        ring.pop();
        ++expected;
    }
    writer.join();
    CHECK(wrong == 0);
    CHECK(ring.front() == nullptr);
}

TEST_CASE("a full ring takes no more, and gives what it took") {
    device::EventRing ring;
    for (std::uint32_t i = 0; i < device::EventRing::kSize; ++i) CHECK(ring.push({i, 1}));
    CHECK_FALSE(ring.push({99, 1}));
    for (std::uint32_t i = 0; i < device::EventRing::kSize; ++i) {
        REQUIRE(ring.front() != nullptr);
        CHECK(ring.front()->time_ns == i);
        ring.pop();
    }
    CHECK(ring.front() == nullptr);
}

TEST_CASE("interrupts in the middle of poll: a short opening of the interlock is not lost") {
    Desk desk;
    desk.hello();
    desk.accept(1, frame_of(1));
    DisplayDescription display = kCube8;
    display.kind = DisplayKind::RotatingPanel;
    display.cycles_per_second = 20.0;
    display.sync = {.index = IndexSource::Pulses, .index_pulses = 1};
    device::ScanControl control;
    REQUIRE(control.init(device::scan_control_config(display, {.reports_scans = true}), desk.device, 0) == Status::Ok);

    constexpr std::uint64_t kTurnNs = 50'000'000;
    std::atomic<std::uint64_t> now_ns{1};
    std::atomic<bool> opened{false};
    std::thread interrupts([&] {
        for (std::uint64_t turn = 1; turn <= 200; ++turn) {
            now_ns.store(turn * kTurnNs);
            control.index_pulse(turn * kTurnNs);
            control.scan_done({}, turn * kTurnNs);
            std::this_thread::yield();
            if (turn == 150) {
                control.interlock(false);
                control.interlock(true);
                opened.store(true);
            }
        }
        now_ns.store(0);
    });
    bool dark_after_opening = true;
    for (std::uint64_t now = 1; now != 0; now = now_ns.load()) {
        const bool was_opened = opened.load();
        const bool lit = control.poll(now).lit();
        if (was_opened && lit) dark_after_opening = false;
    }
    interrupts.join();
    (void)control.poll(200 * kTurnNs);
    CHECK(dark_after_opening);
    CHECK((desk.device.faults() & fault_bit(Fault::Interlock)) != 0);
}
