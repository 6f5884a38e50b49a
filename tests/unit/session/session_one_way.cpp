// A session on a link with no way back.

#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

#include "driver/host/stream.h"
#include "tests/catch.h"
#include "tests/unit/session/scripted_device.h"
#include "transport/file.h"

namespace xorvox::host {
namespace {

using namespace wire;

TEST_CASE("a recording has a hello and keyframes, and a reader gets them back") {
    const auto path = std::filesystem::temp_directory_path() / fmt::format("xorvox-session-{}.xvr", ::getpid());
    const DisplayDescription display = small_display();
    {
        const auto writer = transport::open_file_writer(path.string());
        REQUIRE(writer);
        Session session(writer->get(), display);
        CHECK(session.state() == SessionState::Ready);
        CHECK(session.device().geometry_digest == geometry_digest(display));
        CHECK((session.device().features & kFeatureDelta) == 0);
        std::uint64_t now_ns = 5;
        for (std::uint32_t i = 1; i <= 3; ++i) {
            REQUIRE(session.submit(make_frame(display, i)) == Status::Ok);
            CHECK_FALSE(session.idle());
            while (session.poll(now_ns) == Status::Ok) now_ns += 10'000'000'000;
            CHECK(session.idle());
        }
        REQUIRE(session.control(ControlOperation::Brightness, 9) == Status::Ok);
        while (session.poll(now_ns) == Status::Ok) {
        }
        CHECK(session.idle());
        CHECK(session.statistics().frames_delta == 0);
        REQUIRE(transport::commit_file(writer->get()));
    }
    auto reader = transport::open_file_reader(path.string());
    REQUIRE(reader);
    ScriptedDevice device(std::move(*reader));
    auto packets = device.receive();
    REQUIRE(packets.front().is(PacketType::HelloRequest));
    packets.erase(packets.begin());
    REQUIRE(packets.back().as<Control>().value == 9);
    packets.pop_back();
    std::uint32_t number = 0;
    std::vector<Received> frame;
    for (Received& packet : packets) {
        frame.push_back(std::move(packet));
        if (!frame.back().is(PacketType::FrameEnd)) continue;
        CHECK(frame.front().as<FrameBegin>().flags == 0);
        CHECK(decode_frame(frame) == make_frame(display, ++number));
        frame.clear();
    }
    CHECK(number == 3);
    std::filesystem::remove(path);
}

TEST_CASE("a stream into a recording hands over every frame, in order, and waits for nobody") {
    const auto path = std::filesystem::temp_directory_path() / fmt::format("xorvox-stream-{}.xvr", ::getpid());
    const DisplayDescription display = small_display();
    {
        const auto writer = transport::open_file_writer(path.string());
        REQUIRE(writer);
        Session session(writer->get(), display);
        FrameStream stream(session, display, {.period_ns = 20 * kMs});
        std::uint32_t number = 0;
        for (int i = 0; i < 1000 && (number < 5 || !stream.idle()); ++i) {
            if (number < 5 && stream.has_room()) REQUIRE(stream.offer(make_frame(display, number++)) == Status::Ok);
            (void)stream.poll(0);
        }
        CHECK(stream.idle());
        CHECK(stream.statistics().sent == 5);
        CHECK(stream.statistics().presented == 0);
        REQUIRE(transport::commit_file(writer->get()));
    }
    auto reader = transport::open_file_reader(path.string());
    REQUIRE(reader);
    ScriptedDevice device(std::move(*reader));
    std::uint32_t number = 0;
    std::vector<Received> frame;
    for (Received& packet : device.receive()) {
        if (packet.is(PacketType::HelloRequest)) continue;
        frame.push_back(std::move(packet));
        if (!frame.back().is(PacketType::FrameEnd)) continue;
        CHECK(frame.front().as<FrameBegin>().present_at_ns == 0);
        CHECK(decode_frame(frame) == make_frame(display, number++));
        frame.clear();
    }
    CHECK(number == 5);
    std::filesystem::remove(path);
}

}  // namespace
}  // namespace xorvox::host
