// What a session makes of frames that were accepted: shown, given up for others, or never shown.

#include <algorithm>

#include "tests/catch.h"
#include "tests/unit/session/scripted_device.h"

namespace xorvox::host {
namespace {

using namespace wire;

/// A display that accepts frames and answers questions; its clock is 3 s behind the host's.
struct Stage : Rig {
    using Rig::Rig;

    std::uint64_t device_time_ns() const { return now_ns - 3000 * kMs; }

    FrameEnd accepted(std::uint32_t number, std::uint64_t present_at_ns = 0) {
        REQUIRE(session.submit(make_frame(display, number), present_at_ns) == Status::Ok);
        now_ns += kMs;
        (void)poll();
        const auto end = device.receive().back().as<FrameEnd>();
        device.send(Acknowledge{.stage = AckStage::Accepted,
                                .frame = end.frame,
                                .page_crc = end.page_crc,
                                .free_pages = 1,
                                .device_time_ns = device_time_ns()});
        (void)poll();
        REQUIRE(session.idle());
        return end;
    }
    void present(const FrameEnd& end) {
        device.send(Acknowledge{.stage = AckStage::Presented,
                                .frame = end.frame,
                                .page_crc = end.page_crc,
                                .free_pages = 1,
                                .device_time_ns = device_time_ns()});
        (void)poll();
    }
    /// Answers all that is asked for so long, or until the session fails: how long that was, in milliseconds.
    std::uint64_t answer_for(std::uint64_t ms) {
        std::uint64_t passed_ms = 0;
        while (passed_ms < ms && session.state() == SessionState::Ready) {
            passed_ms += 100;
            (void)poll_after(100 * kMs);
            for (const Received& packet : device.receive()) {
                if (packet.is(PacketType::Ping)) device.send(Pong{.device_time_ns = device_time_ns()});
                if (!packet.is(PacketType::Control)) continue;
                DeviceStatus status = faulty(fault);
                status.device_time_ns = device_time_ns();
                device.send(status);
            }
        }
        return passed_ms;
    }

    Fault fault = Fault::None;
};

constexpr std::uint64_t kStartNs = 4'000'000'000;

SessionOptions showing_within(std::int64_t ns) {
    SessionOptions options;
    options.present_timeout_ns = ns;
    return options;
}

TEST_CASE("a display that accepts a frame and never shows it fails, saying so") {
    Stage stage;
    stage.now_ns = kStartNs;
    stage.connect();
    (void)stage.accepted(1);
    const std::uint64_t ms = stage.answer_for(60'000);
    CHECK(stage.session.state() == SessionState::Failed);
    CHECK(stage.poll() == Status::Closed);
    CHECK(stage.error_says("accepted a frame but has not shown it for 10 s; does it turn?"));
    CHECK(stage.error_says("loopback"));
    CHECK(ms >= 9'900);
    CHECK(ms <= 10'100);
}

TEST_CASE("a fault that keeps frames from being shown is named as the cause") {
    Stage stage;
    stage.now_ns = kStartNs;
    stage.connect();
    stage.fault = Fault::Stall;
    (void)stage.accepted(1);
    (void)stage.answer_for(60'000);
    CHECK(stage.error_says("its rotor stands or turns too slowly"));
}

TEST_CASE("how long a frame may wait to be shown is the caller's choice") {
    SECTION("a shorter time") {
        Stage stage(showing_within(2'500'000'000));
        stage.now_ns = kStartNs;
        stage.connect();
        (void)stage.accepted(1);
        CHECK(stage.answer_for(60'000) <= 2'600);
        CHECK(stage.error_says("has not shown it for 2.5 s"));
    }
    SECTION("for ever") {
        Stage stage(showing_within(0));
        stage.now_ns = kStartNs;
        stage.connect();
        (void)stage.accepted(1);
        (void)stage.answer_for(600'000);
        CHECK(stage.session.state() == SessionState::Ready);
    }
}

TEST_CASE("a frame for later is waited for until the device's clock is there") {
    Stage stage;
    stage.now_ns = kStartNs;
    stage.connect();
    (void)stage.accepted(1, stage.device_time_ns() + 30'000 * kMs);
    const std::uint64_t ms = stage.answer_for(90'000);
    CHECK(stage.session.state() == SessionState::Failed);
    CHECK(ms >= 39'500);
    CHECK(ms <= 41'000);
}

TEST_CASE("a display that shows a frame now and then has not failed") {
    Stage stage;
    stage.now_ns = kStartNs;
    stage.connect();
    for (std::uint32_t i = 1; i <= 5; ++i) {
        const FrameEnd end = stage.accepted(i);
        (void)stage.answer_for(8'000);
        stage.present(end);
        CHECK(stage.session.last_presented() == end.frame);
    }
    (void)stage.answer_for(30'000);
    CHECK(stage.session.state() == SessionState::Ready);
    CHECK(stage.session.statistics().frames_presented == 5);
}

TEST_CASE("frames that were due before the one shown are not waited for, those for later are") {
    Stage stage;
    stage.now_ns = kStartNs;
    stage.connect();
    (void)stage.accepted(1);
    const FrameEnd later = stage.accepted(2, stage.device_time_ns() + 15'000 * kMs);
    const FrameEnd now = stage.accepted(3);
    stage.present(now);
    CHECK(stage.session.last_presented() == now.frame);
    (void)stage.answer_for(16'000);
    CHECK(stage.session.state() == SessionState::Ready);
    stage.present(later);
    CHECK(stage.session.last_presented() == later.frame);
    CHECK(stage.session.statistics().frames_presented == 2);
    (void)stage.answer_for(30'000);
    CHECK(stage.session.state() == SessionState::Ready);
}

TEST_CASE("a frame accepted late, under an earlier number, may be shown under a later one") {
    Stage stage;
    stage.now_ns = kStartNs;
    stage.connect();
    REQUIRE(stage.session.submit(make_frame(stage.display, 1)) == Status::Ok);
    const auto first = stage.sent_frame().back().as<FrameEnd>();
    stage.now_ns += 500 * kMs;
    const auto second = stage.sent_frame().back().as<FrameEnd>();
    stage.device.accept(first);
    stage.device.accept(second);
    (void)stage.poll();
    stage.present(second);
    CHECK(stage.session.last_accepted() == first.frame);
    CHECK(stage.session.last_presented() == first.frame);
    (void)stage.answer_for(30'000);
    CHECK(stage.session.state() == SessionState::Ready);
}

TEST_CASE("after a reset the device's new clock decides, and a later frame stands for those that were lost") {
    Stage stage;
    stage.now_ns = kStartNs;
    stage.connect();
    (void)stage.accepted(1, stage.device_time_ns() + 500'000 * kMs);
    // Silence, until the host asks anew.
    std::vector<Received> packets;
    for (int i = 0; i < 40 && stage.session.state() == SessionState::Ready; ++i) {
        (void)stage.poll_after(100 * kMs);
        packets = stage.device.receive();
    }
    REQUIRE(stage.session.state() == SessionState::Connecting);
    stage.device.boot_nonce = 78;
    stage.device.next_sequence = 0;
    stage.device.greet(stage.device.hello(packets.back().as<HelloRequest>()));
    (void)stage.poll();
    const FrameEnd end = stage.accepted(2);
    stage.present(end);
    (void)stage.answer_for(30'000);
    CHECK(stage.session.state() == SessionState::Ready);
    CHECK(stage.session.last_presented() == end.frame);
}

}  // namespace
}  // namespace xorvox::host
