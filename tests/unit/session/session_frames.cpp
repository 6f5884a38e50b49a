// How a session sends frames: credits, acceptance, refusal, silence, deltas, back-pressure.

#include "tests/catch.h"
#include "tests/unit/session/scripted_device.h"

namespace xorvox::host {
namespace {

using namespace wire;

TEST_CASE("a frame arrives whole and is done when it is accepted") {
    Rig rig;
    rig.connect();
    const Bytes frame = make_frame(rig.display, 1);
    REQUIRE(rig.session.submit(frame, 4242) == Status::Ok);
    CHECK_FALSE(rig.session.idle());
    const auto packets = rig.sent_frame();
    CHECK(packets.front().as<FrameBegin>().present_at_ns == 4242);
    CHECK(decode_frame(packets) == frame);
    for (std::size_t i = 1; i < packets.size(); ++i) {
        CHECK(packets[i].header.sequence == packets[i - 1].header.sequence + 1);
        CHECK(packets[i].header.session == 1);
    }
    const auto end = packets.back().as<FrameEnd>();
    CHECK(rig.session.submit(frame) == Status::WouldBlock);
    rig.device.send(Acknowledge{.stage = AckStage::Received, .frame = end.frame, .free_pages = 1});
    (void)rig.poll();
    CHECK_FALSE(rig.session.idle());
    rig.device.accept(end);
    (void)rig.poll();
    CHECK(rig.session.idle());
    CHECK(rig.session.last_accepted() == end.frame);
    CHECK(rig.session.last_presented() == 0);
    rig.device.send(
        Acknowledge{.stage = AckStage::Presented, .frame = end.frame, .page_crc = end.page_crc, .free_pages = 1});
    (void)rig.poll();
    CHECK(rig.session.last_presented() == end.frame);
    CHECK(rig.session.statistics().frames_presented == 1);
    CHECK(rig.session.statistics().frames_resent == 0);
    CHECK(rig.session.statistics().bytes_sent > 0);
    CHECK(rig.session.statistics().bytes_raw == frame.size());
}

TEST_CASE("a frame may be submitted before the device has answered") {
    Rig rig;
    const Bytes frame = make_frame(rig.display, 1);
    REQUIRE(rig.session.submit(frame) == Status::Ok);
    rig.connect();
    CHECK(decode_frame(rig.sent_frame()) == frame);
}

TEST_CASE("frames of another size are refused") {
    Rig rig;
    CHECK(rig.session.submit({}) == Status::InvalidArgument);
    CHECK(rig.session.submit(Bytes(frame_bytes(rig.display) + 1)) == Status::InvalidArgument);
}

TEST_CASE("without a free page no frame is taken or sent, and the device is asked") {
    Rig rig;
    Hello hello = rig.asked();
    hello.free_pages = 0;
    if (GENERATE(false, true)) {
        rig.device.greet(hello);
        (void)rig.poll();
        CHECK(rig.session.submit(make_frame(rig.display, 1)) == Status::WouldBlock);
    } else {
        REQUIRE(rig.session.submit(make_frame(rig.display, 1)) == Status::Ok);
        rig.device.greet(hello);
        (void)rig.poll();
    }
    CHECK(rig.device.receive().empty());
    (void)rig.poll_after(500 * kMs);
    CHECK(rig.device.receive_one().as<Control>().operation == ControlOperation::Status);
    rig.device.send(DeviceStatus{.free_pages = 1});
    (void)rig.poll();
    (void)rig.session.submit(make_frame(rig.display, 1));
    CHECK(decode_frame(rig.sent_frame()) == make_frame(rig.display, 1));
}

TEST_CASE("a frame for which no page ever becomes free is given up with a reason") {
    Rig rig;
    REQUIRE(rig.session.submit(make_frame(rig.display, 1)) == Status::Ok);
    Hello hello = rig.asked();
    hello.free_pages = 0;
    rig.device.greet(hello);
    Status status = rig.poll();
    for (int i = 0; i < 200 && status == Status::WouldBlock; ++i) {
        for (const Received& packet : rig.device.receive()) {
            REQUIRE(packet.is(PacketType::Control));
            rig.device.send(DeviceStatus{});
        }
        status = rig.poll_after(100 * kMs);
    }
    CHECK(status == Status::Closed);
    CHECK(rig.error_says("no free page"));
}

TEST_CASE("a session that failed for want of a page stays so, also when the device is silent") {
    Rig rig;
    REQUIRE(rig.session.submit(make_frame(rig.display, 1)) == Status::Ok);
    Hello hello = rig.asked();
    hello.free_pages = 0;
    rig.connect_as(hello);
    (void)rig.poll_after(500 * kMs);
    CHECK(rig.poll_after(5000 * kMs) == Status::Closed);
    CHECK(rig.session.state() == SessionState::Failed);
    CHECK(rig.error_says("no free page"));
}

TEST_CASE("a refused frame is sent again as a keyframe with another id") {
    Rig rig;
    rig.connect();
    rig.device.accept(rig.sent_frame(1).back().as<FrameEnd>());
    (void)rig.poll();
    const Bytes frame = make_frame(rig.display, 2);
    const auto delta = rig.sent_frame(frame);
    REQUIRE(delta.front().as<FrameBegin>().flags == kFrameDelta);
    const std::uint32_t id = delta.front().as<FrameBegin>().frame;
    const auto reason = GENERATE(NackReason::NeedKeyframe, NackReason::Gap, NackReason::BadCrc);
    rig.device.send(Nack{.reason = reason, .frame = id, .free_pages = 1});
    const auto again = rig.sent_frame();
    CHECK(again.front().as<FrameBegin>().flags == 0);
    CHECK(again.front().as<FrameBegin>().frame == id + 1);
    CHECK(decode_frame(again) == frame);
    rig.device.accept(again.back().as<FrameEnd>());
    (void)rig.poll();
    CHECK(rig.session.idle());
    CHECK(rig.session.statistics().frames_resent == 1);
    CHECK(rig.session.statistics().frames_submitted == 2);
    CHECK(rig.session.statistics().frames_accepted == 2);
}

TEST_CASE("a frame refused for want of a page waits for one") {
    Rig rig;
    rig.connect();
    const auto id = rig.sent_frame(1).front().as<FrameBegin>().frame;
    rig.device.send(Nack{.reason = NackReason::NoPage, .frame = id, .free_pages = 0});
    (void)rig.poll();
    CHECK(rig.device.receive().empty());
    rig.device.send(DeviceStatus{.free_pages = 1});
    CHECK(decode_frame(rig.sent_frame()) == make_frame(rig.display, 1));
}

TEST_CASE("a frame refused every time is given up, saying why") {
    Rig rig;
    rig.connect();
    REQUIRE(rig.session.submit(make_frame(rig.display, 1)) == Status::Ok);
    int frames = 0;
    Status status = rig.poll();
    while (status == Status::WouldBlock && frames < 100) {
        const auto packets = rig.device.receive();
        REQUIRE_FALSE(packets.empty());
        ++frames;
        rig.device.send(
            Nack{.reason = NackReason::BadCrc, .frame = packets.back().as<FrameEnd>().frame, .free_pages = 1});
        status = rig.poll();
    }
    CHECK(status == Status::Closed);
    CHECK(frames == 10);
    CHECK(rig.error_says("did not accept a frame in 10 attempts: the page's checksum was wrong"));
}

TEST_CASE("a frame that the device takes for another display's is given up at once, saying so") {
    Rig rig;
    rig.connect();
    const auto id = rig.sent_frame(1).front().as<FrameBegin>().frame;
    rig.device.send(Nack{.reason = NackReason::BadFrame, .frame = id, .free_pages = 1});
    CHECK(rig.poll() == Status::Refused);
    CHECK(rig.session.state() == SessionState::Failed);
    CHECK(rig.error_says("refuses a frame as not made for it"));
    CHECK(rig.device.receive().empty());
    CHECK(rig.session.statistics().frames_resent == 0);
}

TEST_CASE("a frame without an answer is sent again as a keyframe") {
    Rig rig;
    rig.connect();
    const Bytes frame = make_frame(rig.display, 1);
    const auto first = rig.sent_frame(frame);
    (void)rig.poll_after(499 * kMs);
    CHECK(rig.device.receive().empty());
    rig.now_ns += kMs;
    const auto second = rig.sent_frame();
    CHECK(second.front().as<FrameBegin>().frame == first.front().as<FrameBegin>().frame + 1);
    CHECK(decode_frame(second) == frame);

    SECTION("the answer to the second attempt counts") {
        rig.device.accept(second.back().as<FrameEnd>());
        (void)rig.poll();
        CHECK(rig.session.idle());
        CHECK(rig.session.last_accepted() == second.back().as<FrameEnd>().frame);
    }
    SECTION("so does a late one to the first, once, and no delta is based on it") {
        rig.device.accept(first.back().as<FrameEnd>());
        rig.device.accept(second.back().as<FrameEnd>());
        (void)rig.poll();
        CHECK(rig.session.idle());
        CHECK(rig.session.statistics().frames_accepted == 1);
        CHECK(rig.sent_frame(2).front().as<FrameBegin>().flags == 0);
    }
}

TEST_CASE("answers that are late, repeated, of others or do not fit change nothing") {
    Rig rig;
    rig.connect();
    const auto first = rig.sent_frame(1).back().as<FrameEnd>();
    rig.device.accept(first);
    const std::uint32_t accepted_at = rig.device.next_sequence - 1;
    (void)rig.poll();
    const auto second = rig.sent_frame(2).back().as<FrameEnd>();
    const Acknowledge right{
        .stage = AckStage::Accepted, .frame = second.frame, .page_crc = second.page_crc, .free_pages = 1};

    Acknowledge wrong = right;
    wrong.page_crc ^= 1;
    rig.device.send(wrong);
    wrong = right;
    wrong.frame = second.frame + 1;
    rig.device.send(wrong);
    wrong.frame = first.frame;
    rig.device.send(wrong);
    rig.device.send_numbered(right, accepted_at);
    rig.device.session = 9;
    rig.device.send(right);
    rig.device.session = 1;
    rig.device.send(Nack{.reason = NackReason::Gap, .frame = first.frame, .free_pages = 1});
    rig.device.send(Nack{.reason = NackReason::Gap, .frame = 0, .free_pages = 1});
    rig.device.send(Acknowledge{.stage = AckStage::Presented, .frame = 999, .free_pages = 1});
    (void)rig.poll();
    CHECK_FALSE(rig.session.idle());
    CHECK(rig.device.receive().empty());
    CHECK(rig.session.last_presented() == 0);
    CHECK(rig.session.statistics().frames_accepted == 1);

    rig.device.send(right);
    (void)rig.poll();
    CHECK(rig.session.idle());
}

TEST_CASE("presented stands for accepted where that was lost") {
    Rig rig;
    rig.connect();
    const auto end = rig.sent_frame(1).back().as<FrameEnd>();
    rig.device.send(
        Acknowledge{.stage = AckStage::Presented, .frame = end.frame, .page_crc = end.page_crc, .free_pages = 1});
    (void)rig.poll();
    CHECK(rig.session.idle());
    CHECK(rig.session.last_presented() == end.frame);
}

TEST_CASE("deltas are based on the last accepted frame") {
    Rig rig;
    rig.connect();
    Bytes base;
    std::uint32_t base_id = 0;
    for (std::uint32_t i = 1; i <= 5; ++i) {
        const Bytes frame = make_frame(rig.display, i);
        const auto packets = rig.sent_frame(frame);
        const auto begin = packets.front().as<FrameBegin>();
        CHECK(begin.flags == (i == 1 ? 0 : kFrameDelta));
        if (i > 1) CHECK(begin.base == base_id);
        CHECK(decode_frame(packets, base) == frame);
        rig.device.accept(packets.back().as<FrameEnd>());
        (void)rig.poll();
        base = frame;
        base_id = begin.frame;
    }
    CHECK(rig.session.statistics().frames_delta == 4);
}

TEST_CASE("a keyframe is sent each interval that the host wants") {
    SessionOptions options;
    options.keyframe_interval_ns = 30 * kMs;
    Rig rig(options);
    rig.connect();
    std::string keys;
    for (std::uint32_t i = 1; i <= 8; ++i) {
        const auto packets = rig.sent_frame(make_frame(rig.display, i));
        keys += packets.front().as<FrameBegin>().flags == kFrameDelta ? '.' : 'k';
        rig.device.accept(packets.back().as<FrameEnd>());
        (void)rig.poll();
        rig.now_ns += 10 * kMs;
    }
    CHECK(keys == "k..k..k.");
}

TEST_CASE("no deltas where the host or the device does not want them") {
    const bool by_host = GENERATE(true, false);
    SessionOptions options;
    options.deltas = !by_host;
    Rig rig(options);
    Hello hello = rig.asked();
    if (!by_host) hello.features = 0;
    rig.connect_as(hello);
    for (std::uint32_t i = 1; i <= 3; ++i) {
        const auto packets = rig.sent_frame(i);
        CHECK(packets.front().as<FrameBegin>().flags == 0);
        rig.device.accept(packets.back().as<FrameEnd>());
        (void)rig.poll();
    }
}

TEST_CASE("chunks are raw where the device knows nothing else, and fit its packets") {
    Rig rig;
    Hello hello = rig.asked();
    hello.codecs = 1;
    hello.max_packet_bytes = 256;
    rig.connect_as(hello);
    const Bytes frame = make_frame(rig.display, 1);
    const auto packets = rig.sent_frame(frame);
    CHECK(decode_frame(packets) == frame);
    for (std::size_t i = 1; i + 1 < packets.size(); ++i) {
        CHECK(packets[i].as<Chunk>().codec == Codec::Raw);
        CHECK(packets[i].payload.size() + kPacketOverhead <= 256);
    }
}

TEST_CASE("a link that takes one packet at a time gets the whole frame, each packet once") {
    transport::LoopbackOptions narrow;
    narrow.max_packet_bytes = 300;
    narrow.queue_bytes = 304;
    SessionOptions options;
    options.compress = false;
    Rig rig(options, narrow);
    rig.connect();
    const Bytes frame = make_frame(rig.display, 1);
    REQUIRE(rig.session.submit(frame) == Status::Ok);
    std::vector<Received> packets;
    for (int i = 0; i < 1000 && (packets.empty() || !packets.back().is(PacketType::FrameEnd)); ++i) {
        (void)rig.poll();
        CHECK((rig.session.events() & kLinkReadable) != 0);
        for (Received& packet : rig.device.receive()) packets.push_back(std::move(packet));
    }
    CHECK(decode_frame(packets) == frame);
    CHECK(packets.size() > 30);
    CHECK(rig.session.statistics().frames_resent == 0);
}

TEST_CASE("a peer that stops reading in the middle of a frame ends in Failed") {
    transport::LoopbackOptions narrow;
    narrow.max_packet_bytes = 300;
    narrow.queue_bytes = 304;
    SessionOptions options;
    options.compress = false;
    Rig rig(options, narrow);
    rig.connect();
    REQUIRE(rig.session.submit(make_frame(rig.display, 1)) == Status::Ok);
    Status status = rig.poll();
    CHECK(rig.session.events() == (kLinkReadable | kLinkWritable));
    for (int i = 0; i < 200 && status == Status::WouldBlock; ++i) status = rig.poll_after(100 * kMs);
    CHECK(status == Status::Closed);
    CHECK(rig.error_says("takes no more data"));
}

TEST_CASE("a program that was stopped in the middle of a frame does not blame the peer") {
    transport::LoopbackOptions narrow;
    narrow.max_packet_bytes = 300;
    narrow.queue_bytes = 304;
    SessionOptions options;
    options.compress = false;
    Rig rig(options, narrow);
    rig.connect();
    REQUIRE(rig.session.submit(make_frame(rig.display, 1)) == Status::Ok);
    (void)rig.poll();
    CHECK(rig.poll_after(60'000 * kMs) == Status::WouldBlock);
    CHECK(rig.session.state() == SessionState::Ready);
    CHECK_FALSE(rig.device.receive().empty());
    (void)rig.poll_after(kMs);
    CHECK(rig.session.state() != SessionState::Failed);
}

}  // namespace
}  // namespace xorvox::host
