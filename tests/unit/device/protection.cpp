#include "tests/unit/device/rig.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

constexpr std::uint64_t kMs = 1'000'000;

struct Lit : Desk {
    Lit() {
        hello();
        accept(1, frame_of(1));
        present();
    }
    DeviceStatus set(ControlOperation operation, std::uint32_t value) {
        send(Control{.operation = operation, .value = value});
        return answer<DeviceStatus>();
    }
    bool dark() const { return device.shown().page.empty(); }
};

}  // namespace

TEST_CASE("two seconds without a packet blank the display, tell the host, and stay until the fault is cleared") {
    Lit desk;
    desk.now_ns += 2000 * kMs - kMs - 1;  // present() took a millisecond since the last packet
    desk.work();
    CHECK_FALSE(desk.dark());
    desk.now_ns += 1;
    desk.work();
    CHECK(desk.dark());
    const DeviceStatus told = desk.answer<DeviceStatus>();
    CHECK(told.fault == Fault::SilentHost);
    CHECK(told.blank == 1);

    desk.accept(2, frame_of(2));
    desk.present();
    CHECK(desk.dark());
    CHECK(desk.set(ControlOperation::ClearFault, 1).fault == Fault::None);
    CHECK(desk.shown() == frame_of(2));
}

TEST_CASE("the display goes dark with the host and its link gone, and the next host learns why") {
    Lit desk;
    desk.link.closed = true;
    CHECK(desk.device.poll(desk.now_ns) == Status::Closed);
    desk.device.set_link({});
    CHECK_FALSE(desk.dark());
    desk.now_ns += 2000 * kMs;
    CHECK(desk.device.poll(desk.now_ns) == Status::Closed);
    CHECK(desk.dark());

    desk.link.closed = false;
    desk.device.set_link(desk.link.link());
    CHECK(desk.hello().fault == Fault::SilentHost);
    desk.set(ControlOperation::ClearFault, 1);
    CHECK(desk.shown() == frame_of(1));
}

TEST_CASE("a host that left before its first frame is missed too") {
    Desk desk;
    desk.hello();
    desk.device.set_link({});
    desk.now_ns += 2000 * kMs;
    CHECK(desk.device.poll(desk.now_ns) == Status::Closed);
    desk.device.set_link(desk.link.link());
    CHECK(desk.hello().fault == Fault::SilentHost);
}

TEST_CASE("a host that sends and never reads is not heard: the display goes dark and says so once it reads") {
    Lit desk;
    desk.link.room = 0;
    for (int i = 0; i < 20; ++i) {
        desk.now_ns += 100 * kMs;
        desk.send(Ping{});
        desk.work();
    }
    CHECK_FALSE(desk.dark());
    desk.now_ns += 100 * kMs;
    desk.work();
    CHECK(desk.dark());
    desk.link.room = 1;
    CHECK(desk.answer<DeviceStatus>().fault == Fault::SilentHost);
}

TEST_CASE("any valid packet of the session feeds the watchdog; bad, foreign and repeated ones do not") {
    Lit desk;
    const Bytes ping = desk.next_packet(Ping{});
    for (int i = 0; i < 5; ++i) {
        desk.now_ns += 1900 * kMs;
        desk.send(Ping{});
        desk.answer<Pong>();
    }
    CHECK_FALSE(desk.dark());
    for (int i = 0; i < 4; ++i) {
        desk.now_ns += 500 * kMs;
        desk.put(ping);
        desk.put(Bytes(40));
        desk.put(packet_of(99, 1000, Ping{}));
        desk.work();
    }
    CHECK(desk.dark());
}

TEST_CASE("with the hold policy the picture stays when the host is silent") {
    Lit desk;
    CHECK(desk.set(ControlOperation::SilencePolicy, 0).silence_action == SilenceAction::Hold);
    desk.now_ns += 100'000 * kMs;
    desk.work();
    CHECK_FALSE(desk.dark());
    CHECK(desk.device.status(desk.now_ns).fault == Fault::None);
}

TEST_CASE("the watchdog's time is the host's to set, and 0 turns it off") {
    Lit desk;
    CHECK(desk.set(ControlOperation::Watchdog, 10).watchdog_ms == 10);
    desk.now_ns += 10 * kMs;
    desk.work();
    CHECK(desk.dark());
    desk.answer<DeviceStatus>();
    desk.set(ControlOperation::ClearFault, 1);
    desk.set(ControlOperation::Watchdog, 0);
    desk.now_ns += 100'000 * kMs;
    desk.work();
    CHECK_FALSE(desk.dark());
    CHECK(desk.set(ControlOperation::Watchdog, 0xffffffffu).watchdog_ms == 0xffffffffu);
    desk.now_ns += 100'000 * kMs;
    desk.work();
    CHECK_FALSE(desk.dark());
}

TEST_CASE("a device that nobody has spoken to misses nobody") {
    Desk desk;
    desk.now_ns += 100'000 * kMs;
    desk.work();
    CHECK(desk.hello().fault == Fault::None);
}

TEST_CASE("the host blanks and shows again") {
    Lit desk;
    CHECK(desk.set(ControlOperation::Blank, 1).blank == 1);
    CHECK(desk.dark());
    desk.accept(2, frame_of(2));
    CHECK(desk.present().frame == 2);
    CHECK(desk.dark());
    CHECK(desk.set(ControlOperation::Blank, 0).blank == 0);
    CHECK(desk.shown() == frame_of(2));
}

TEST_CASE("brightness reaches what is shown") {
    Lit desk;
    CHECK(desk.device.shown().brightness == 255);
    CHECK(desk.set(ControlOperation::Brightness, 40).brightness == 40);
    CHECK(desk.device.shown().brightness == 40);
}

TEST_CASE("unknown operations and values out of range are refused and change nothing") {
    Lit desk;
    for (const Control control :
         {Control{ControlOperation::Brightness, 256}, Control{ControlOperation::Blank, 2},
          Control{ControlOperation::SilencePolicy, 2}, Control{ControlOperation::ClearFault, 0},
          Control{ControlOperation::ClearFault, kHighestFault + 1}, Control{ControlOperation::ClearFault, 0x101},
          Control{ControlOperation::Status, 1}, Control{static_cast<ControlOperation>(0), 0},
          Control{static_cast<ControlOperation>(77), 0}}) {
        desk.send(control);
        CHECK(desk.refusal(0) == NackReason::BadControl);
    }
    CHECK(desk.silent());
    const DeviceStatus status = desk.device.status(desk.now_ns);
    CHECK(status.brightness == 255);
    CHECK(status.blank == 0);
    CHECK(status.silence_action == SilenceAction::Blank);
    CHECK(status.watchdog_ms == 2000);
}

TEST_CASE("status says what is shown and what happened") {
    Lit desk;
    desk.send_delta(5, frame_of(2), 4, frame_of(1));
    CHECK(desk.refusal(5) == NackReason::NeedKeyframe);
    const DeviceStatus status = desk.set(ControlOperation::Status, 0);
    CHECK(status.has_frame == 1);
    CHECK(status.shown_frame == 1);
    CHECK(status.shown_crc == crc32c(frame_of(1)));
    CHECK(status.free_pages == 1);
    CHECK(status.frames_accepted == 1);
    CHECK(status.frames_dropped == 1);
    CHECK(status.device_time_ns == desk.now_ns);
    CHECK(Desk().device.status(0).has_frame == 0);
}

TEST_CASE("every fault darkens at once, is told once, and stays until the command that names it") {
    for (std::uint8_t number = 1; number <= kHighestFault; ++number) {
        INFO("fault " << int{number});
        const auto fault = static_cast<Fault>(number);
        Lit desk;
        desk.device.raise_fault(fault);
        CHECK(desk.dark());
        const DeviceStatus told = desk.answer<DeviceStatus>();
        CHECK(told.fault == fault);
        CHECK(told.faults == 1u << number);
        CHECK(told.blank == 1);
        desk.device.raise_fault(fault);
        CHECK(desk.silent());

        for (std::uint8_t other = 1; other <= kHighestFault; ++other) {
            if (other != number) CHECK(desk.set(ControlOperation::ClearFault, other).fault == fault);
        }
        desk.set(ControlOperation::Blank, 1);
        desk.set(ControlOperation::Blank, 0);
        ++desk.session;
        CHECK(desk.hello().fault == fault);
        CHECK(desk.dark());
        CHECK(desk.set(ControlOperation::ClearFault, number).faults == 0);
        CHECK_FALSE(desk.dark());
    }
}

TEST_CASE("of several faults the highest is told first, and the display is dark until the last is cleared") {
    Lit desk;
    for (const Fault fault : {Fault::LateScan, Fault::Interlock, Fault::SilentHost}) {
        desk.device.raise_fault(fault);
        desk.answer<DeviceStatus>();
    }
    CHECK(desk.device.status(desk.now_ns).faults == 0b10000110);
    CHECK(desk.device.fault() == Fault::Interlock);
    CHECK(desk.set(ControlOperation::ClearFault, 7).fault == Fault::LateScan);
    CHECK(desk.set(ControlOperation::ClearFault, 1).faults == 0b100);
    CHECK(desk.dark());
    CHECK(desk.set(ControlOperation::ClearFault, 2).fault == Fault::None);
    CHECK_FALSE(desk.dark());
}

TEST_CASE("a silent host's fault does not hide behind another, nor is it cleared with it") {
    Lit desk;
    desk.device.raise_fault(Fault::LateScan);
    desk.answer<DeviceStatus>();
    desk.now_ns += 5000 * kMs;
    CHECK(desk.answer<DeviceStatus>().faults == 0b110);
    CHECK(desk.set(ControlOperation::ClearFault, 2).fault == Fault::SilentHost);
    CHECK(desk.dark());
}

TEST_CASE("a fault that does not exist cannot be raised") {
    Lit desk;
    desk.device.raise_fault(Fault::None);
    desk.device.raise_fault(static_cast<Fault>(kHighestFault + 1));
    desk.device.raise_fault(static_cast<Fault>(200));
    CHECK(desk.device.faults() == 0);
    CHECK_FALSE(desk.dark());
    CHECK(desk.silent());
}

TEST_CASE("settings outlast the session") {
    Lit desk;
    desk.set(ControlOperation::Brightness, 12);
    ++desk.session;
    desk.hello();
    CHECK(desk.set(ControlOperation::Status, 0).brightness == 12);
}
