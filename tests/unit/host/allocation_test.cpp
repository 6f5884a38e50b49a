#include "tests/catch.h"

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define XORVOX_SANITIZED
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define XORVOX_SANITIZED
#endif

#ifndef XORVOX_SANITIZED  // The sanitizers bring their own operator new.

#include <atomic>
#include <cstdlib>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include <sys/socket.h>

#include "driver/display/toml.h"
#include "driver/host/calibration.h"
#include "driver/host/frame_client.h"
#include "driver/host/framebuffer.h"
#include "driver/host/power_budget.h"
#include "driver/host/slices.h"

namespace {
std::atomic<std::size_t> allocations{0};
}

void* operator new(std::size_t size) {
    ++allocations;
    if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
    throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}

using namespace xorvox;

TEST_CASE("painting a frame allocates nothing, in any mode") {
    for (const char* name : {"cube16-ws2812", "vortex"}) {
        const auto display = load_display(name).value();
        const bool planes = display.kind == DisplayKind::StackedPlanes;
        const auto calibration = host::Calibration::parse(
            std::string(planes ? "plane" : "panel") + ",row,column,red,green,blue\n0,3,3,0.5,0.5,0.5\n", display);
        REQUIRE(calibration);
        for (const auto mode : {host::LightMode::Bright, host::LightMode::Uniform, host::LightMode::Even}) {
            for (const auto dither : {host::Dither::None, host::Dither::Ordered, host::Dither::Temporal}) {
                for (const host::Calibration* const measured :
                     {static_cast<const host::Calibration*>(nullptr), &*calibration}) {
                    host::FramePainter painter(display, {.mode = mode, .dither = dither, .calibration = measured});
                    host::PowerBudget budget(display);
                    BitVolume volume(painter.lattice().view());
                    for (std::uint32_t i = 0; i < 16; ++i) volume.view().flip(i, i, i);
                    std::vector<std::byte> frame(frame_bytes(display));
                    for (const char* color : {"constant:red", "gradient", "noise", "expr: hsv(noise(8*p), 1, z)"}) {
                        const auto field = host::parse_color(color).value();
                        const std::size_t before = allocations;
                        painter.set_brightness(0.7f * budget.factor());
                        const Status status = painter.paint(volume.view(), *field, frame, 5);
                        (void)budget.allows(frame);
                        const std::size_t after = allocations;
                        CHECK(status == Status::Ok);
                        CHECK(after == before);
                    }
                }
            }
        }
    }
    CHECK(allocations > 0);
}

TEST_CASE("framebuffer: frames that come and go allocate nothing") {
    host::Framebuffer frames(1000, 2);
    const std::size_t before = allocations;
    for (int i = 0; i < 10; ++i) {
        frames.begin_frame();
        (void)frames.end_frame();
        frames.latest(0);
        frames.latest(1);
        frames.release(1);
    }
    const std::size_t after = allocations;
    CHECK(after == before);
    CHECK(frames.latest().sequence == 10);
}

TEST_CASE("shared frames: what a program publishes is taken without an allocation") {
    const DisplayDescription display = load_display("cube8-595").value();
    host::Framebuffer frames(frame_bytes(display));
    host::ShareStatistics statistics;
    int ends[2];
    REQUIRE(::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends) == 0);
    host::FrameClient client(host::Descriptor{ends[0]}, std::move(*host::FrameSegment::make(display)),
                             host::FrameTerms(display), frames, statistics);
    const host::Descriptor drawer(ends[1]);
    const std::size_t before = allocations;
    for (std::uint32_t i = 0; i < 10; ++i) {
        client.segment().header()->latest = i % 3;
        (void)::send(drawer.get(), "", 1, 0);  // Refused.
        client.poll();
    }
    const std::size_t after = allocations;
    CHECK(after == before);
    CHECK(statistics.by_exchange == 10);
    CHECK(statistics.refused[XORVOX_FRAMES_WRONG_MESSAGE] == 10);
}

#endif
