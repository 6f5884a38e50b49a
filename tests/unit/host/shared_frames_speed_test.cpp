// Checksummed frames at full speed through shared memory, from a program in C: none is torn, none is lost at the end.
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <thread>

#include "tests/unit/host/shared_frames_c.h"
#include "tests/unit/host/shared_frames_rig.h"

namespace xorvox::test {
namespace {

struct Seen {
    std::uint64_t frames = 0;
    std::uint64_t torn = 0;
    std::uint64_t backwards = 0;
};

/// Whether `frame` is the one that was made for its tag: its number is that of the writer, not of the server, who does
/// not see all.
bool is_whole_by_tag(host::Frame frame) {
    std::memcpy(&frame.sequence, frame.bytes.data() + frame.bytes.size() - 8, 4);
    return is_whole(frame);
}

/// A client of `server`, which both are in this process and see one mapping of the segment: then ThreadSanitizer sees
/// what each does to the pages of the other.
class OneMapping {
public:
    explicit OneMapping(const DisplayDescription& display, host::Framebuffer& frames)
        : terms_(display), frames_(frames) {
        int ends[2];
        REQUIRE(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) == 0);
        auto segment = host::FrameSegment::make(display);
        REQUIRE(segment);
        client.emplace(host::Descriptor(ends[0]), std::move(*segment), terms_, frames_, statistics);
        drawer.socket = ends[1];
        drawer.segment = client->segment().header();
        drawer.latest = XORVOX_FRAMES_NO_PAGE;
        drawer.hello.segment_bytes = drawer.segment->segment_bytes;
        drawer.hello.frame_bytes = drawer.segment->frame_bytes;
        drawer.hello.geometry_digest = drawer.segment->geometry_digest;
        drawer.hello.pages = drawer.segment->pages;
        drawer.hello.pixel_format = drawer.segment->pixel_format;
    }
    ~OneMapping() { ::close(drawer.socket); }

    std::optional<host::FrameClient> client;
    host::ShareStatistics statistics;
    xorvox_frames drawer{};

private:
    host::FrameTerms terms_;
    host::Framebuffer& frames_;
};

/// Draws frames 1 … `count` on one thread, serves on a second, and looks on this one.
Seen run(bool by_atomics, std::uint32_t count) {
    const DisplayDescription display = shared_display();
    host::Framebuffer frames(frame_bytes(display));
    OneMapping both(display, frames);
    std::atomic<bool> done{false};
    std::jthread server([&] {
        while (!done) {
            both.client->poll();
            std::this_thread::yield();
        }
        both.client->poll();
    });
    std::jthread drawer([&] {
        for (std::uint32_t i = 1; i <= count; ++i) {
            const std::uint32_t page = by_atomics ? xorvox_test_c_begin(&both.drawer) : i % 3;
            if (page == XORVOX_FRAMES_NO_PAGE) std::abort();
            write_checksummed({reinterpret_cast<std::byte*>(xorvox_frames_page(&both.drawer, page)),
                               both.drawer.segment->frame_bytes},
                              i);
            if (by_atomics) {
                xorvox_test_c_end(&both.drawer, page, tag_of(i));
            } else if (xorvox_test_c_publish(&both.drawer, page, tag_of(i)) != XORVOX_FRAMES_OK) {
                std::abort();
            }
        }
    });
    Seen seen;
    std::uint32_t last = 0;
    for (std::uint32_t drawn = 0; drawn != count;) {
        const host::Frame frame = frames.latest();
        if (frame.sequence == last) {
            std::this_thread::yield();
            continue;
        }
        seen.backwards += frame.sequence < last;
        last = frame.sequence;
        ++seen.frames;
        seen.torn += !is_whole_by_tag(frame);
        std::memcpy(&drawn, frame.bytes.data() + frame.bytes.size() - 8, 4);
        if (seen.torn > 0) break;
    }
    done = true;
    return seen;
}

TEST_CASE("shared frames: frames by message at full speed are whole, in order, and the last one comes") {
    const Seen seen = run(false, 20'000);
    CHECK(seen.frames > 0);
    CHECK(seen.torn == 0);
    CHECK(seen.backwards == 0);
}

TEST_CASE("shared frames: frames by atomics at full speed are whole, in order, and the last one comes") {
    const Seen seen = run(true, 100'000);
    CHECK(seen.frames > 0);
    CHECK(seen.torn == 0);
    CHECK(seen.backwards == 0);
}

TEST_CASE("shared frames: a program in C and a server at full speed, from connection to end") {
    ShareRig rig;
    std::atomic<bool> done{false};
    {
        std::jthread server([&] {
            while (!done) {
                rig.server->poll(rig.now_ns);
                rig.server->wait(-1);
            }
        });
        xorvox_frames frames;
        int status = xorvox_test_c_connect(&frames, rig.path.c_str());
        for (std::uint32_t i = 1; status == XORVOX_FRAMES_OK && i <= 2000; ++i) {
            write_checksummed(
                {reinterpret_cast<std::byte*>(xorvox_frames_page(&frames, 0)), frames.segment->frame_bytes}, i);
            status = xorvox_test_c_publish(&frames, 0, tag_of(i));
        }
        const int refused = xorvox_test_c_publish(&frames, 3, 0);
        const int accepted = xorvox_test_c_publish(&frames, 0, tag_of(2001));
        xorvox_test_c_close(&frames);
        done = true;
        rig.server->wake();
        CHECK(status == XORVOX_FRAMES_OK);
        CHECK(refused == XORVOX_FRAMES_WRONG_PAGE);
        CHECK(accepted == XORVOX_FRAMES_OK);
    }
    CHECK(rig.frames.latest().sequence == 2001);
    CHECK(rig.server->statistics().by_message == 2001);
}

}  // namespace
}  // namespace xorvox::test
