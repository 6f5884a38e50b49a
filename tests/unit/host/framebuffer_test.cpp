// The framebuffer as its users see it: what the writer and each reader get, and frames that stay whole under threads at
// full speed. All orders of the steps below it: page_exchange_test.cpp.

#include "driver/host/framebuffer.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

#include "tests/catch.h"
#include "tests/unit/host/checksummed_frame.h"

namespace xorvox::host {
namespace {

void publish(Framebuffer& frames, std::uint8_t value, std::uint64_t tag = 0) {
    const std::span<std::byte> page = frames.begin_frame();
    std::fill(page.begin(), page.end(), std::byte{value});
    REQUIRE(frames.end_frame(tag) == Status::Ok);
}

bool all_are(const Frame& frame, std::uint8_t value) {
    return !frame.bytes.empty() &&
           std::all_of(frame.bytes.begin(), frame.bytes.end(), [&](std::byte b) { return b == std::byte{value}; });
}

TEST_CASE("framebuffer: before the first frame there is none") {
    Framebuffer frames(100);
    CHECK(frames.latest().bytes.empty());
    CHECK(frames.latest().sequence == 0);
    CHECK_FALSE(frames.changed_since(0));
    CHECK(frames.end_frame() == Status::InvalidArgument);
    frames.begin_frame();
    CHECK(frames.latest().bytes.empty());
    CHECK_FALSE(frames.changed_since(0));
    frames.release();
    frames.release(17);
}

TEST_CASE("framebuffer: a reader gets the latest whole frame, its number and its tag") {
    Framebuffer frames(100);
    for (std::uint8_t i = 1; i <= 50; ++i) {
        publish(frames, i, 1000u * i);
        CHECK(frames.changed_since(i - 1u));
        CHECK_FALSE(frames.changed_since(i));
        if (i % 3 != 0) continue;  // It missed the others.
        const Frame frame = frames.latest();
        CHECK(frame.bytes.size() == 100);
        CHECK(all_are(frame, i));
        CHECK(frame.sequence == i);
        CHECK(frame.tag == 1000u * i);
        const Frame again = frames.latest();
        CHECK(again.bytes.data() == frame.bytes.data());
        CHECK(again.sequence == i);
    }
}

TEST_CASE("framebuffer: a frame that a reader has stays as it is, however many follow") {
    const std::uint32_t readers = GENERATE(1u, 2u, Framebuffer::kMaxReaders);
    Framebuffer frames(64, readers);
    REQUIRE(frames.pages() == readers + 2);
    std::vector<Frame> kept;
    for (std::uint32_t reader = 0; reader < readers; ++reader) {
        publish(frames, static_cast<std::uint8_t>(reader + 1));
        kept.push_back(frames.latest(reader));
    }
    for (int i = 0; i < 100; ++i) publish(frames, 99);
    for (std::uint32_t reader = 0; reader < readers; ++reader) {
        CHECK(all_are(kept[reader], static_cast<std::uint8_t>(reader + 1)));
        CHECK(all_are(frames.latest(reader), 99));
        CHECK(frames.latest(reader).sequence == readers + 100);
    }
}

TEST_CASE("framebuffer: a frame that was begun and not ended is not seen, and can be begun anew") {
    Framebuffer frames(64);
    publish(frames, 1);
    const std::span<std::byte> given_up = frames.begin_frame();
    given_up[0] = std::byte{2};
    CHECK(all_are(frames.latest(), 1));
    CHECK(frames.begin_frame().data() == given_up.data());
    CHECK_FALSE(frames.changed_since(1));
    publish(frames, 3);
    CHECK(all_are(frames.latest(), 3));
    CHECK(frames.end_frame() == Status::InvalidArgument);
    CHECK(frames.latest().sequence == 2);
}

TEST_CASE("framebuffer: after release a reader gets the latest frame, the same or a later one") {
    Framebuffer frames(64);
    publish(frames, 1);
    CHECK(frames.latest().sequence == 1);
    frames.release();
    frames.release();
    CHECK(frames.latest().sequence == 1);
    frames.release();
    publish(frames, 2);
    CHECK(frames.latest().sequence == 2);
}

TEST_CASE("framebuffer: pages are whole cache lines and none overlaps another") {
    const std::size_t size = GENERATE(std::size_t{1}, std::size_t{63}, std::size_t{64}, std::size_t{65});
    Framebuffer frames(size, 1);
    CHECK(frames.frame_bytes() == size);
    publish(frames, 1);
    const Frame first = frames.latest();
    publish(frames, 2);
    const std::span<std::byte> third = frames.begin_frame();
    std::fill(third.begin(), third.end(), std::byte{3});
    CHECK(third.size() == size);
    CHECK(reinterpret_cast<std::uintptr_t>(first.bytes.data()) % 64 == 0);
    CHECK(reinterpret_cast<std::uintptr_t>(third.data()) % 64 == 0);
    CHECK(all_are(first, 1));
    CHECK(all_are(frames.latest(), 2));
}

TEST_CASE("framebuffer: numbers of readers beyond the limits count as the nearest") {
    CHECK(Framebuffer(8, 0).readers() == 1);
    CHECK(Framebuffer(8, 1000).readers() == Framebuffer::kMaxReaders);
    Framebuffer frames(8);
    publish(frames, 1);
    CHECK(frames.latest(1).bytes.empty());
}

TEST_CASE("framebuffer: threads at full speed see whole frames only, in order, and the last one") {
    const std::uint32_t readers = GENERATE(1u, 3u);
    constexpr std::uint32_t kFrames = 200'000;
    Framebuffer frames(256, readers);
    struct Seen {
        std::uint32_t frames = 0;
        std::uint32_t torn = 0;
        std::uint32_t backwards = 0;
        std::uint32_t stale = 0;
    };
    std::vector<Seen> seen(readers);
    std::atomic<std::uint32_t> ready{0};
    {
        std::vector<std::jthread> threads;
        for (std::uint32_t reader = 0; reader < readers; ++reader) {
            threads.emplace_back([&, reader] {
                Seen& mine = seen[reader];
                ++ready;
                ready.notify_one();
                for (std::uint32_t last = 0; last != kFrames;) {
                    if (!frames.changed_since(last)) {
                        std::this_thread::yield();
                        continue;
                    }
                    const Frame frame = frames.latest(reader);
                    ++mine.frames;
                    if (frame.sequence <= last) {
                        ++mine.stale;  // changed_since() promised more.
                        if (frame.sequence < last) ++mine.backwards;
                        break;
                    }
                    last = frame.sequence;
                    if (!test::is_whole(frame)) ++mine.torn;
                    if (last % 7 == reader) frames.release(reader);
                }
            });
        }
        for (std::uint32_t now = 0; now != readers; now = ready.load()) ready.wait(now);
        for (std::uint32_t i = 1; i <= kFrames; ++i) {
            test::write_checksummed(frames.begin_frame(), i);
            // Not REQUIRE: it would end the test under the readers.
            if (frames.end_frame(test::tag_of(i)) != Status::Ok) std::abort();
        }
    }
    for (const Seen& mine : seen) {
        CHECK(mine.frames > 0);
        CHECK(mine.torn == 0);
        CHECK(mine.backwards == 0);
        CHECK(mine.stale == 0);
    }
}

}  // namespace
}  // namespace xorvox::host
