// Controls and faults.

#include <set>
#include <string>
#include <vector>

#include "driver/host/faults.h"
#include "tests/catch.h"
#include "tests/unit/session/scripted_device.h"

namespace xorvox::host {
namespace {

using namespace wire;

TEST_CASE("a control is sent again until a status confirms it") {
    Rig rig;
    rig.connect();
    REQUIRE(rig.session.control(ControlOperation::Brightness, 40) == Status::Ok);
    REQUIRE(rig.session.control(ControlOperation::Watchdog, 900) == Status::Ok);
    CHECK_FALSE(rig.session.idle());
    (void)rig.poll();
    CHECK(rig.device.receive_one().as<Control>().value == 40);
    rig.device.send(DeviceStatus{.brightness = 255, .free_pages = 2});
    (void)rig.poll();
    CHECK(rig.device.receive().empty());
    (void)rig.poll_after(500 * kMs);
    CHECK(rig.device.receive_one().as<Control>().value == 40);
    rig.device.send(DeviceStatus{.brightness = 40, .free_pages = 2});
    (void)rig.poll();
    CHECK(rig.device.receive_one().as<Control>().operation == ControlOperation::Watchdog);
    rig.device.send(DeviceStatus{.brightness = 40, .watchdog_ms = 900, .free_pages = 2});
    (void)rig.poll();
    CHECK(rig.session.idle());
    CHECK(rig.session.device_status().watchdog_ms == 900);
    CHECK(rig.session.statistics().controls_lost == 0);
}

TEST_CASE("a control that the device refuses or never confirms is given up and counted") {
    Rig rig;
    rig.connect();
    REQUIRE(rig.session.control(ControlOperation::Brightness, 40) == Status::Ok);
    (void)rig.poll();
    (void)rig.device.receive_one();
    if (GENERATE(true, false)) {
        rig.device.send(Nack{.reason = NackReason::BadControl, .free_pages = 2});
        (void)rig.poll();
    } else {
        for (int i = 0; i < 10; ++i) {
            CHECK(rig.session.statistics().controls_lost == 0);
            rig.device.send(DeviceStatus{.free_pages = 2});
            (void)rig.poll_after(500 * kMs);
            (void)rig.device.receive();
        }
    }
    CHECK(rig.session.idle());
    CHECK(rig.session.statistics().controls_lost == 1);
    CHECK(rig.session.state() == SessionState::Ready);
}

TEST_CASE("only so many controls wait") {
    Rig rig;
    int taken = 0;
    while (rig.session.control(ControlOperation::Status, 0) == Status::Ok) REQUIRE(++taken < 1000);
    CHECK(rig.session.control(ControlOperation::Status, 0) == Status::WouldBlock);
}

TEST_CASE("values out of range are refused before anything is sent") {
    Rig rig;
    rig.connect();
    CHECK(rig.session.control(ControlOperation::Brightness, 256) == Status::InvalidArgument);
    CHECK(rig.session.control(ControlOperation::Blank, 2) == Status::InvalidArgument);
    CHECK(rig.session.control(ControlOperation::SilencePolicy, 2) == Status::InvalidArgument);
    CHECK(rig.session.control(ControlOperation::ClearFault, 0) == Status::InvalidArgument);
    CHECK(rig.session.control(ControlOperation::ClearFault, 8) == Status::InvalidArgument);
    CHECK(rig.session.control(ControlOperation::Status, 1) == Status::InvalidArgument);
    CHECK(rig.session.control(static_cast<ControlOperation>(0), 0) == Status::InvalidArgument);
    CHECK(rig.session.control(static_cast<ControlOperation>(7), 0) == Status::InvalidArgument);
    CHECK(rig.session.idle());
    CHECK(rig.session.control(ControlOperation::Brightness, 255) == Status::Ok);
    CHECK(rig.session.control(ControlOperation::Blank, 1) == Status::Ok);
    CHECK(rig.session.control(ControlOperation::SilencePolicy, 1) == Status::Ok);
    CHECK(rig.session.control(ControlOperation::Watchdog, 0xffffffff) == Status::Ok);
    CHECK(rig.session.control(ControlOperation::ClearFault, 1) == Status::Ok);
    CHECK(rig.session.control(ControlOperation::ClearFault, 7) == Status::Ok);
}

TEST_CASE("a control that was sent twice and refused twice takes no other with it") {
    Rig rig;
    rig.connect();
    REQUIRE(rig.session.control(ControlOperation::Brightness, 40) == Status::Ok);
    REQUIRE(rig.session.control(ControlOperation::Watchdog, 900) == Status::Ok);
    (void)rig.poll();
    (void)rig.poll_after(500 * kMs);
    CHECK(rig.device.receive().size() == 2);
    rig.device.send(Nack{.reason = NackReason::BadControl, .free_pages = 2});
    (void)rig.poll();
    CHECK(rig.device.receive_one().as<Control>().operation == ControlOperation::Watchdog);
    CHECK(rig.session.statistics().controls_lost == 1);
    rig.device.send(Nack{.reason = NackReason::BadControl, .free_pages = 2});
    (void)rig.poll();
    CHECK(rig.session.statistics().controls_lost == 1);
    CHECK_FALSE(rig.session.idle());
    // A refusal of its own counts.
    rig.device.send(Nack{.reason = NackReason::BadControl, .free_pages = 2});
    (void)rig.poll();
    CHECK(rig.session.statistics().controls_lost == 2);
    CHECK(rig.session.idle());
}

TEST_CASE("refusals that come after a control was given up, or name a frame, are nobody's") {
    SessionOptions options;
    options.attempts = 2;
    Rig rig(options);
    rig.connect();
    REQUIRE(rig.session.control(ControlOperation::Brightness, 40) == Status::Ok);
    REQUIRE(rig.session.control(ControlOperation::Watchdog, 900) == Status::Ok);
    (void)rig.poll();
    (void)rig.poll_after(500 * kMs);
    (void)rig.poll_after(500 * kMs);
    CHECK(rig.session.statistics().controls_lost == 1);
    for (int i = 0; i < 2; ++i) rig.device.send(Nack{.reason = NackReason::BadControl, .free_pages = 2});
    rig.device.send(Nack{.reason = NackReason::BadControl, .frame = 3, .free_pages = 2});
    (void)rig.poll();
    CHECK(rig.session.statistics().controls_lost == 1);
    rig.device.send(DeviceStatus{.watchdog_ms = 900, .free_pages = 2});
    (void)rig.poll();
    CHECK(rig.session.idle());
    CHECK(rig.session.statistics().controls_lost == 1);
}

TEST_CASE("a blank is confirmed by a status without fault that shows it, and by no other") {
    Rig rig;
    rig.connect();
    const std::uint32_t value = GENERATE(0u, 1u);
    const auto blank = static_cast<std::uint8_t>(value);
    const auto other = static_cast<std::uint8_t>(1 - value);
    REQUIRE(rig.session.control(ControlOperation::Blank, value) == Status::Ok);
    (void)rig.poll();
    CHECK(rig.device.receive_one().as<Control>().value == value);
    rig.device.send(DeviceStatus{.blank = other, .watchdog_ms = 2000, .free_pages = 2});
    rig.device.send(faulty(Fault::Stall));
    (void)rig.poll();
    CHECK_FALSE(rig.session.idle());
    SECTION("in the end it is") {
        (void)rig.poll_after(500 * kMs);
        CHECK(rig.device.receive_one().as<Control>().operation == ControlOperation::Blank);
        rig.device.send(DeviceStatus{.blank = blank, .watchdog_ms = 2000, .free_pages = 2});
        (void)rig.poll();
        CHECK(rig.session.idle());
        CHECK(rig.session.statistics().controls_lost == 0);
    }
    SECTION("a fault that stays is not waited for without end") {
        int sent = 1;
        for (int i = 0; i < 100 && !rig.session.idle(); ++i) {
            (void)rig.poll_after(500 * kMs);
            for (const Received& packet : rig.device.receive()) sent += packet.is(PacketType::Control) ? 1 : 0;
            rig.device.send(faulty(Fault::Stall));
            (void)rig.poll();
        }
        CHECK(rig.session.idle());
        CHECK(sent == 10);
        CHECK(rig.session.statistics().controls_lost == 1);
    }
}

TEST_CASE("a blank that a fault masks lets the clearing of the fault pass, and is sent once more after it") {
    Rig rig;
    rig.connect();
    const auto operation = [&] { return rig.device.receive_one().as<Control>().operation; };
    const bool silent = GENERATE(true, false);
    const Fault fault = silent ? Fault::SilentHost : Fault::Stall;
    REQUIRE(rig.session.control(ControlOperation::Blank, 0) == Status::Ok);
    if (!silent) REQUIRE(rig.session.control(ControlOperation::ClearFault, 4) == Status::Ok);
    (void)rig.poll();
    CHECK(operation() == ControlOperation::Blank);
    rig.device.send(faulty(fault));
    (void)rig.poll();
    CHECK(operation() == ControlOperation::ClearFault);
    rig.device.send(DeviceStatus{.blank = 1, .free_pages = 2});
    (void)rig.poll();
    CHECK(operation() == ControlOperation::Blank);
    rig.device.send(DeviceStatus{.free_pages = 2});
    (void)rig.poll();
    CHECK(rig.session.idle());
    CHECK(rig.session.statistics().controls_lost == 0);
}

TEST_CASE("a masked blank does not come after a later one") {
    Rig rig;
    rig.connect();
    REQUIRE(rig.session.control(ControlOperation::Blank, 1) == Status::Ok);
    REQUIRE(rig.session.control(ControlOperation::Blank, 0) == Status::Ok);
    REQUIRE(rig.session.control(ControlOperation::ClearFault, 4) == Status::Ok);
    std::vector<Control> sent;
    DeviceStatus status = faulty(Fault::Stall);
    for (int i = 0; i < 10 && !rig.session.idle(); ++i) {
        (void)rig.poll();
        sent.push_back(rig.device.receive_one().as<Control>());
        if (sent.back().operation == ControlOperation::ClearFault) status = faulty(Fault::None);
        rig.device.send(status);
        (void)rig.poll_after(0);
    }
    CHECK(rig.session.idle());
    REQUIRE(sent.size() == 4);
    CHECK(sent[1].value == 0);
    CHECK(sent[2].operation == ControlOperation::ClearFault);
    CHECK(sent[3].operation == ControlOperation::Blank);
    CHECK(sent[3].value == 0);
}

TEST_CASE("of the faults in hello only a silent host's is cleared, and all can be read") {
    Rig rig;
    Hello hello = rig.asked();
    hello.fault = GENERATE(Fault::SilentHost, Fault::LateScan, Fault::Interlock, static_cast<Fault>(31),
                           static_cast<Fault>(32), static_cast<Fault>(255));
    rig.device.send(hello);
    (void)rig.poll();
    CHECK(rig.session.device().fault == hello.fault);
    CHECK(rig.session.device_status().fault == hello.fault);
    bool cleared = false;
    for (int i = 0; i < 30; ++i) {
        for (const Received& packet : rig.device.receive()) {
            if (!packet.is(PacketType::Control)) continue;
            cleared = cleared || packet.as<Control>().operation == ControlOperation::ClearFault;
            rig.device.send(DeviceStatus{.fault = hello.fault, .free_pages = 2});
        }
        (void)rig.poll_after(100 * kMs);
    }
    CHECK(cleared == (hello.fault == Fault::SilentHost));
    CHECK(rig.session.device_status().fault == hello.fault);
}

TEST_CASE("the fault of a silent host is cleared by its number when the host is back, others only by command") {
    Rig rig;
    rig.connect();
    const auto fault =
        GENERATE(Fault::LateScan, Fault::LostIndex, Fault::Stall, Fault::Overspeed, Fault::Reversed, Fault::Interlock);
    rig.device.send(faulty(fault));
    (void)rig.poll();
    CHECK(rig.device.receive().empty());
    DeviceStatus both = faulty(fault);
    both.faults |= fault_bit(Fault::SilentHost);
    rig.device.send(both);
    rig.device.send(both);
    (void)rig.poll();
    const auto cleared = [&] {
        const auto control = rig.device.receive_one().as<Control>();
        CHECK(control.operation == ControlOperation::ClearFault);
        return static_cast<Fault>(control.value);
    };
    CHECK(cleared() == Fault::SilentHost);
    rig.device.send(faulty(fault));
    (void)rig.poll();
    CHECK(rig.session.idle());
    for (int i = 0; i < 5; ++i) {
        (void)rig.poll_after(500 * kMs);
        CHECK(rig.device.receive_one().is(PacketType::Ping));
        rig.device.send(Pong{});
    }
    REQUIRE(rig.session.control(ControlOperation::ClearFault, static_cast<std::uint32_t>(fault)) == Status::Ok);
    (void)rig.poll();
    CHECK(cleared() == fault);
    rig.device.send(faulty(fault));
    (void)rig.poll();
    CHECK_FALSE(rig.session.idle());
    CHECK(rig.session.device_status().fault == fault);
    rig.device.send(faulty(Fault::None));
    (void)rig.poll();
    CHECK(rig.session.idle());
}

TEST_CASE("a command to clear a fault does not stand for the clearing of another") {
    Rig rig;
    rig.connect();
    REQUIRE(rig.session.control(ControlOperation::ClearFault, 4) == Status::Ok);
    DeviceStatus both = faulty(Fault::Stall);
    both.faults |= fault_bit(Fault::SilentHost);
    rig.device.send(both);
    std::vector<std::uint32_t> cleared;
    for (int i = 0; i < 10 && (cleared.empty() || !rig.session.idle()); ++i) {
        (void)rig.poll();
        cleared.push_back(rig.device.receive_one().as<Control>().value);
        both.faults &= ~(1u << cleared.back());
        rig.device.send(both);
        (void)rig.poll_after(0);
    }
    CHECK(cleared == std::vector<std::uint32_t>{4, 1});
}

TEST_CASE("every fault has words of its own for the user, and an unknown one too") {
    std::set<std::string> texts;
    for (unsigned number = 0; number <= kHighestFault + 1u; ++number) {
        texts.insert(describe(static_cast<Fault>(number)));
    }
    CHECK(texts.size() == kHighestFault + 2u);
    CHECK(std::string(describe(Fault::Stall)).find("clear fault 4") != std::string::npos);
}

TEST_CASE("the device is asked how it is after hello, again until it answers") {
    Rig rig;
    rig.device.send(rig.asked());
    (void)rig.poll();
    CHECK(rig.device.receive_one().as<Control>().operation == ControlOperation::Status);
    CHECK(rig.session.idle());
    (void)rig.poll_after(499 * kMs);
    CHECK(rig.device.receive().empty());
    (void)rig.poll_after(kMs);
    CHECK(rig.device.receive_one().as<Control>().operation == ControlOperation::Status);
    rig.device.send(DeviceStatus{.watchdog_ms = 4000, .free_pages = 2});
    (void)rig.poll_after(999 * kMs);
    CHECK(rig.device.receive().empty());
    (void)rig.poll_after(kMs);
    CHECK(rig.device.receive_one().is(PacketType::Ping));
}

TEST_CASE("a ping comes every quarter of the watchdog, as the last status gave it") {
    Rig rig;
    rig.connect();
    struct Case {
        std::uint32_t watchdog_ms;
        std::uint64_t ping_ms;
    };
    const auto c = GENERATE(Case{100, 25}, Case{1, 1}, Case{7, 1}, Case{400, 100}, Case{2000, 500},
                            Case{60'000, 15'000}, Case{0, 500});
    CAPTURE(c.watchdog_ms);
    rig.device.send(DeviceStatus{.watchdog_ms = c.watchdog_ms, .free_pages = 2});
    (void)rig.poll_after(0);
    (void)rig.device.receive();
    // Something is sent, from which the quarter counts.
    REQUIRE(rig.session.control(ControlOperation::Status, 0) == Status::Ok);
    (void)rig.poll();
    (void)rig.device.receive_one();
    rig.device.send(DeviceStatus{.watchdog_ms = c.watchdog_ms, .free_pages = 2});
    for (int i = 0; i < 4; ++i) {
        (void)rig.poll_after(c.ping_ms * kMs - 1);
        CHECK(rig.device.receive().empty());
        (void)rig.poll_after(1);
        rig.device.send(Pong{.host_time_ns = rig.device.receive_one().as<Ping>().host_time_ns});
    }
}

TEST_CASE("a lost presented is made up for by asking what is shown") {
    Rig rig;
    rig.connect();
    const auto end = rig.sent_frame(1).back().as<FrameEnd>();
    rig.device.accept(end);
    (void)rig.poll();
    CHECK(rig.device.receive().empty());
    (void)rig.poll_after(500 * kMs);
    CHECK(rig.device.receive_one().as<Control>().operation == ControlOperation::Status);
    // The frame of that number is another session's, which showed something else.
    rig.device.send(
        DeviceStatus{.shown_frame = end.frame, .has_frame = 1, .shown_crc = end.page_crc ^ 1, .free_pages = 1});
    (void)rig.poll();
    CHECK(rig.session.last_presented() == 0);
    CHECK(rig.session.statistics().frames_presented == 0);
    (void)rig.poll_after(500 * kMs);
    CHECK(rig.device.receive_one().as<Control>().operation == ControlOperation::Status);
    rig.device.send(DeviceStatus{.shown_frame = end.frame, .has_frame = 1, .shown_crc = end.page_crc, .free_pages = 1});
    (void)rig.poll();
    CHECK(rig.session.last_presented() == end.frame);
    CHECK(rig.session.statistics().frames_presented == 1);
    (void)rig.poll_after(500 * kMs);
    CHECK(rig.device.receive_one().is(PacketType::Ping));
}

}  // namespace
}  // namespace xorvox::host
