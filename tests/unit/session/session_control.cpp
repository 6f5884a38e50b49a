// Controls and faults.

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
    REQUIRE(rig.session.control(ControlOperation::Brightness, 1000) == Status::Ok);
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

TEST_CASE("a fault in hello is cleared") {
    Rig rig;
    (void)rig.poll();
    Hello hello = rig.device.hello(rig.device.receive_one().as<HelloRequest>());
    hello.fault = GENERATE(Fault::SilentHost, Fault::Scan);
    rig.device.send(hello);
    (void)rig.poll();
    CHECK(rig.device.receive_one().as<Control>().operation == ControlOperation::ClearFault);
}

TEST_CASE("the fault of a silent host is cleared when the host is back, a scanner's is not") {
    Rig rig;
    rig.connect();
    rig.device.send(DeviceStatus{.fault = Fault::Scan, .free_pages = 2});
    (void)rig.poll();
    CHECK(rig.device.receive().empty());
    rig.device.send(DeviceStatus{.fault = Fault::SilentHost, .free_pages = 2});
    rig.device.send(DeviceStatus{.fault = Fault::SilentHost, .free_pages = 2});
    (void)rig.poll();
    CHECK(rig.device.receive_one().as<Control>().operation == ControlOperation::ClearFault);
    rig.device.send(DeviceStatus{.free_pages = 2});
    (void)rig.poll();
    CHECK(rig.session.idle());
}

TEST_CASE("a lost presented is made up for by asking what is shown") {
    Rig rig;
    rig.connect();
    REQUIRE(rig.session.submit(make_frame(rig.display, 1)) == Status::Ok);
    const auto end = rig.sent_frame().back().as<FrameEnd>();
    rig.device.accept(end);
    (void)rig.poll();
    CHECK(rig.device.receive().empty());
    (void)rig.poll_after(500 * kMs);
    CHECK(rig.device.receive_one().as<Control>().operation == ControlOperation::Status);
    rig.device.send(DeviceStatus{.shown_frame = end.frame, .has_frame = 1, .free_pages = 1});
    (void)rig.poll();
    CHECK(rig.session.last_presented() == end.frame);
    CHECK(rig.session.statistics().frames_presented == 1);
    (void)rig.poll_after(500 * kMs);
    CHECK(rig.device.receive_one().is(PacketType::Ping));
}

}  // namespace
}  // namespace xorvox::host
