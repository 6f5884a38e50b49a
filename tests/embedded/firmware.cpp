// Firmware of a display of 8 × 8 × 8 voxels whose link is the golden conversation: it answers every packet to the
// letter and shows the pictures that were sent, or ends with status 1.
#include <algorithm>
#include <array>
#include <span>

#include "driver/device/device.h"
#include "golden_conversation.h"
#include "tests/embedded/semihosting.h"

int run_firmware();

using namespace xorvox;

namespace {

constexpr DisplayDescription kDisplay = [] {
    DisplayDescription display;
    display.name = DisplayName("cube8");
    display.slices = 8;
    display.plane_pitch_mm = 10.0;
    display.cycles_per_second = 60.0;
    display.panels[0] = {.columns = 8, .rows = 8, .column_pitch_mm = 10.0, .row_pitch_mm = 10.0};
    return display;
}();

std::span<const std::byte> packet_of(const GoldenStep& step) {
    return std::as_bytes(std::span(kGoldenBytes)).subspan(static_cast<std::size_t>(step.number), step.bytes);
}

/// The far end of the link: gives the next packet of the host, and compares each answer with the next one expected.
struct Script {
    std::span<const GoldenStep> left{kGoldenSteps};
    bool wrong = false;

    bool next_is(char kind) const { return !left.empty() && left.front().kind == kind; }
    GoldenStep take() {
        const GoldenStep step = left.front();
        left = left.subspan(1);
        return step;
    }
};

constexpr LinkOperations kScriptLink{
    .info =
        [](const void*) {
            return LinkInfo{"script", wire::kMaxPacketBytes, true};
        },
    .send =
        [](void* self, std::span<const std::byte> packet) {
            auto& script = *static_cast<Script*>(self);
            if (!script.next_is('<') || !std::ranges::equal(packet, packet_of(script.take()))) script.wrong = true;
            return Status::Ok;
        },
    .receive =
        [](void* self, std::span<std::byte> buffer, std::size_t& size) {
            auto& script = *static_cast<Script*>(self);
            if (!script.next_is('>')) return Status::WouldBlock;
            const std::span<const std::byte> packet = packet_of(script.take());
            if (packet.size() > buffer.size()) return Status::OutOfMemory;
            std::ranges::copy(packet, buffer.begin());
            size = packet.size();
            return Status::Ok;
        },
    .flush = nullptr,
    .wait = nullptr,
    .close = [](void*) {},
};

std::array<std::byte, 2 * frame_bytes(kDisplay)> pages;
std::array<std::byte, wire::kMinPacketBytes> packet_buffer;
Script script;
device::Device display_device;

/// What frame 2 of the conversation shows: bytes 0 … 31 count up, byte 10 is inverted, the last bit is lit.
bool shows_frame_2() {
    const std::span<const std::byte> page = display_device.shown().page;
    if (page.size() != frame_bytes(kDisplay)) return false;
    for (std::size_t i = 0; i < page.size(); ++i) {
        unsigned expected = i < 32 ? static_cast<unsigned>(i) : 0;
        if (i == 10) expected ^= 0xffu;
        if (i == 63) expected ^= 0x80u;
        if (page[i] != static_cast<std::byte>(expected)) return false;
    }
    return true;
}

int fail(const char* why) {
    semihosting::print(why);
    return 1;
}

}  // namespace

int run_firmware() {
    std::uint64_t now_ns = 0;
    if (display_device.init({.display = &kDisplay,
                             .serial = DisplayName("XV-0001"),
                             .boot_nonce = 7,
                             .link = {&kScriptLink, &script},
                             .pages = pages,
                             .page_count = 2,
                             .packet = packet_buffer},
                            now_ns) != Status::Ok) {
        return fail("init failed\n");
    }
    for (;;) {
        if (display_device.poll(now_ns) == Status::Ok) continue;
        if (script.wrong) return fail("an answer differs from the golden one\n");
        if (script.next_is('<')) return fail("an answer is missing\n");
        if (script.left.empty()) break;
        const GoldenStep step = script.take();
        if (step.kind == '@') now_ns = step.number;
        if (step.kind == '|') display_device.boundary(now_ns);
    }
    if (!shows_frame_2()) return fail("the picture differs\n");
    semihosting::print("the golden conversation went to the letter\n");
    return 0;
}
