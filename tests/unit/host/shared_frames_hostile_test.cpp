// Shared frames with programs that break the rules, in this process or in one of their own: the last whole frame stays,
// and the next program is welcome.
#include <array>
#include <csignal>
#include <cstring>
#include <functional>
#include <string>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "driver/host/frame_share.h"
#include "driver/host/shared_frames.h"
#include "tests/unit/host/shared_frames_rig.h"

namespace xorvox::test {
namespace {

/// A process that does `work` with a connection of its own, until it is killed. It allocates nothing and returns never.
class Process {
public:
    Process(ShareRig& rig, const std::function<void(xorvox_frames&, int ready)>& work) {
        REQUIRE(::pipe(ready_.data()) == 0);
        pid_ = ::fork();
        REQUIRE(pid_ >= 0);
        if (pid_ == 0) {
            xorvox_frames frames;
            if (xorvox_frames_connect(&frames, rig.path.c_str()) == XORVOX_FRAMES_OK) work(frames, ready_[1]);
            ::_exit(1);
        }
        ::close(ready_[1]);
        const std::uint64_t before = rig.server->statistics().clients;
        while (rig.server->statistics().clients == before) {
            rig.server->wait(-1);
            rig.server->poll(rig.now_ns);
        }
    }
    ~Process() {
        kill();
        ::close(ready_[0]);
    }
    /// Until the work says that it is so far.
    void wait_ready() {
        char byte = 0;
        REQUIRE(::read(ready_[0], &byte, 1) == 1);
    }
    void kill() {
        if (pid_ <= 0) return;
        ::kill(pid_, SIGKILL);
        ::waitpid(pid_, nullptr, 0);
        pid_ = -1;
    }

private:
    pid_t pid_ = -1;
    std::array<int, 2> ready_{};
};

/// The last whole frame is there, and a program that keeps to the rules can draw.
void check_next_is_welcome(ShareRig& rig) {
    const auto next = rig.drawer();
    rig.publish_whole(*next);
}

TEST_CASE("shared frames: a program killed in mid-frame leaves the last whole frame") {
    const bool by_atomics = GENERATE(false, true);
    ShareRig rig;
    {
        const auto drawer = rig.drawer();
        rig.publish_whole(*drawer);
    }
    rig.server->poll(rig.now_ns);
    Process process(rig, [by_atomics](xorvox_frames& frames, int ready) {
        const std::uint32_t page = by_atomics ? xorvox_frames_begin(&frames) : 0;
        std::memset(xorvox_frames_page(&frames, page), 1, frames.segment->frame_bytes / 2);
        if (::write(ready, "", 1) == 1) ::pause();
    });
    process.wait_ready();
    rig.server->poll(rig.now_ns);
    CHECK(is_whole(rig.frames.latest()));
    process.kill();
    rig.server->poll(rig.now_ns);
    CHECK(is_whole(rig.frames.latest()));
    check_next_is_welcome(rig);
}

TEST_CASE("shared frames: a program that never stops writing spoils no frame but its own") {
    ShareRig rig;
    Process process(rig, [](xorvox_frames& frames, int ready) {
        // Everything, all the time: pages, words, the header; and messages in between.
        auto* const bytes = reinterpret_cast<unsigned char*>(frames.segment);
        unsigned state = 1;
        const auto scribble = [&] {
            for (std::size_t i = 0; i < frames.hello.segment_bytes; i += 1 + state % 64) {
                state = state * 1103515245 + 12345;
                bytes[i] = static_cast<unsigned char>(state >> 16);
            }
        };
        xorvox_frames_request request{};
        std::memcpy(request.magic, XORVOX_FRAMES_MAGIC, 8);
        request.version = XORVOX_FRAMES_VERSION;
        request.what = XORVOX_FRAMES_PUBLISH;
        request.frame_bytes = frames.hello.frame_bytes;
        request.geometry_digest = frames.hello.geometry_digest;
        request.pixel_format = frames.hello.pixel_format;
        if (::write(ready, "", 1) != 1) return;
        for (unsigned round = 0;; ++round) {
            scribble();
            request.page = round % 3;
            xorvox_frames_reply reply;
            if (::send(frames.socket, &request, sizeof request, MSG_NOSIGNAL) < 0) return;
            scribble();  // While the server copies.
            if (::recv(frames.socket, &reply, sizeof reply, 0) <= 0) return;
        }
    });
    process.wait_ready();
    const std::uint64_t before = rig.server->statistics().frames();
    for (int i = 0; i < 100'000 && rig.server->statistics().frames() < before + 100; ++i) {
        rig.server->wait(1'000'000);
        rig.server->poll(rig.now_ns);
    }
    REQUIRE(rig.server->statistics().frames() >= before + 100);
    // With the process at work: what was copied stays as it is.
    const host::Frame kept = rig.frames.latest();
    const std::vector<std::byte> copy(kept.bytes.begin(), kept.bytes.end());
    for (int i = 0; i < 50; ++i) {
        rig.server->wait(1'000'000);
        rig.server->poll(rig.now_ns);
    }
    CHECK(std::equal(copy.begin(), copy.end(), kept.bytes.begin()));
    process.kill();
    rig.server->poll(rig.now_ns);
    check_next_is_welcome(rig);
}

TEST_CASE("shared frames: a message that does not fit the display is refused, and the connection goes on") {
    ShareRig rig;
    const auto drawer = rig.drawer();
    rig.publish_whole(*drawer);
    const host::Frame last = rig.frames.latest();
    fill(drawer->page(1), 1);
    const auto refused = [&](const std::function<void(xorvox_frames_request&)>& spoil) {
        xorvox_frames_request request = drawer->request(1);
        spoil(request);
        const xorvox_frames_reply reply = rig.send(*drawer, &request, sizeof request);
        CHECK(reply.sequence == 0);
        CHECK(is_whole(rig.frames.latest()));
        CHECK(rig.frames.latest().sequence == last.sequence);
        return reply.status;
    };
    CHECK(refused([](auto& r) { r.page = 3; }) == XORVOX_FRAMES_WRONG_PAGE);
    CHECK(refused([](auto& r) { r.page = 0xffff'ffff; }) == XORVOX_FRAMES_WRONG_PAGE);
    CHECK(refused([](auto& r) { r.pixel_format = 1; }) == XORVOX_FRAMES_WRONG_FORMAT);
    CHECK(refused([](auto& r) { r.frame_bytes -= 1; }) == XORVOX_FRAMES_WRONG_SIZE);
    CHECK(refused([](auto& r) { r.frame_bytes = ~0ull; }) == XORVOX_FRAMES_WRONG_SIZE);
    CHECK(refused([](auto& r) { r.geometry_digest ^= 1; }) == XORVOX_FRAMES_WRONG_GEOMETRY);
    CHECK(rig.server->statistics().refused[XORVOX_FRAMES_WRONG_PAGE] == 2);
    CHECK(rig.server->statistics().refused[XORVOX_FRAMES_WRONG_SIZE] == 2);
    rig.publish_whole(*drawer);
}

TEST_CASE("shared frames: a message that cannot be understood is refused and ends the connection") {
    const int kind = GENERATE(0, 1, 2, 3, 4, 5, 6);
    INFO(kind);
    ShareRig rig;
    {
        const auto drawer = rig.drawer();
        rig.publish_whole(*drawer);
        fill(drawer->page(1), 1);
        std::array<std::byte, 4096> bytes{};
        xorvox_frames_request request = drawer->request(1);
        if (kind == 4) request.magic[0] = 'Y';
        if (kind == 5) request.version = 2;
        if (kind == 6) request.what = 2;
        std::memcpy(bytes.data(), &request, sizeof request);
        const std::size_t sizes[] = {1, 47, 49, 4096};
        const xorvox_frames_reply reply = rig.send(*drawer, bytes.data(), kind < 4 ? sizes[kind] : sizeof request);
        CHECK(reply.status == (kind == 5 ? XORVOX_FRAMES_WRONG_VERSION : XORVOX_FRAMES_WRONG_MESSAGE));
        CHECK(reply.page == XORVOX_FRAMES_NO_PAGE);
        CHECK(drawer->closed());
    }
    CHECK(is_whole(rig.frames.latest()));
    check_next_is_welcome(rig);
}

TEST_CASE("shared frames: an empty message ends the connection") {
    ShareRig rig;
    const auto drawer = rig.drawer();
    REQUIRE(drawer->send("", 0));
    rig.server->poll(rig.now_ns);
    CHECK(drawer->closed());
    check_next_is_welcome(rig);
}

TEST_CASE("shared frames: a program that reads no replies is not waited for") {
    ShareRig rig;
    const auto drawer = rig.drawer();
    const xorvox_frames_request request = drawer->request(0);
    std::uint64_t sent = 0;
    for (; sent < 1'000'000; ++sent) {
        if (!drawer->send(&request, sizeof request)) break;
        rig.server->poll(rig.now_ns);
    }
    CHECK(sent < 1'000'000);  // It was sent away.
    check_next_is_welcome(rig);
}

TEST_CASE("shared frames: any words of the exchange give whole pages of the segment, or none") {
    ShareRig rig;
    const auto drawer = rig.drawer();
    xorvox_frames_segment& segment = *drawer->frames().segment;
    for (std::uint32_t page = 0; page < host::FrameSegment::kPages; ++page) {
        fill(drawer->page(page), static_cast<std::uint8_t>(page + 1));
    }
    std::uint32_t state = 1;
    for (int i = 0; i < 2000; ++i) {
        state = state * 1664525 + 1013904223;
        segment.latest = i % 2 == 0 ? state : state & 15;
        segment.released[state >> 29] = state;
        rig.server->poll(rig.now_ns);
        const host::Frame latest = rig.frames.latest();
        if (latest.bytes.empty()) continue;
        const auto value = std::to_integer<std::uint8_t>(latest.bytes[0]);
        REQUIRE(value >= 1);
        REQUIRE(value <= host::FrameSegment::kPages);
        REQUIRE(all_are(latest, value));
    }
    CHECK(rig.server->statistics().by_exchange > 100);
    drawer->leave();
    check_next_is_welcome(rig);
}

TEST_CASE("shared frames: a header that its program overwrites misleads nobody else") {
    ShareRig rig;
    auto drawer = rig.drawer();
    const xorvox_frames_request request = drawer->request(0);
    fill(drawer->page(0), 3);
    std::memset(static_cast<void*>(drawer->frames().segment), 0xff, offsetof(xorvox_frames_segment, latest));
    CHECK(rig.send(*drawer, &request, sizeof request).status == XORVOX_FRAMES_OK);
    CHECK(all_are(rig.frames.latest(), 3));
    drawer.reset();
    const auto next = rig.drawer();
    CHECK(next->frames().segment->frame_bytes == frame_bytes(rig.display));
    CHECK(next->page(0)[0] == std::byte{0});
}

TEST_CASE("shared frames: a segment can be made neither shorter nor longer by its program") {
    ShareRig rig;
    const Drawer drawer(rig.path);
    rig.server->poll(rig.now_ns);
    xorvox_frames_hello hello;
    int memory = -1;
    REQUIRE(xorvox_frames_receive_hello(const_cast<Drawer&>(drawer).frames().socket, &hello, &memory) == 0);
    CHECK(::ftruncate(memory, 0) == -1);
    CHECK(::ftruncate(memory, 1 << 20) == -1);
    CHECK(::fcntl(memory, F_ADD_SEALS, F_SEAL_WRITE) == -1);
    ::close(memory);
}

TEST_CASE("shared frames: programs that come and go at once cost nothing but their own connection") {
    ShareRig rig;
    for (int i = 0; i < 100; ++i) {
        const int socket = connect_raw(rig.path);
        REQUIRE(socket >= 0);
        ::close(socket);
        if (i % 3 == 0) rig.server->poll(rig.now_ns);
    }
    for (int i = 0; i < 20; ++i) rig.server->poll(rig.now_ns);
    check_next_is_welcome(rig);
}

}  // namespace
}  // namespace xorvox::test
