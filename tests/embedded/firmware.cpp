// Firmware of a display of 8 × 8 × 8 voxels whose link is the golden conversation: it answers every packet to the
// letter and shows the pictures that were sent, or ends with status 1. Then it scans them out over pins. Then the same
// slices turn: it follows the index pulses, lights each slice in its place and dims the bright one, and goes dark when
// the pulses stop.
#include <algorithm>
#include <array>
#include <span>

#include "driver/device/config.h"
#include "driver/device/device.h"
#include "driver/device/scan_control.h"
#include "golden_conversation.h"
#include "tests/embedded/scan.h"
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

// Slice 3 of frame 2 draws most: 28 LEDs, 280 mA at full brightness. The host asked for half of it.
constexpr device::ScanControlConfig kTurning = [] {
    DisplayDescription display = kDisplay;
    display.kind = DisplayKind::RotatingPanel;
    display.cycles_per_second = 20.0;
    display.sync = {.index = IndexSource::Pulses, .index_pulses = 1};
    display.power = {.led_ma = 10.0, .limit_ma = 125.0};
    return device::scan_control_config(display, {.reports_scans = true, .has_interlock = true});
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
device::ScanControl scan_control;

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

/// Half a second of pulses and a half without, a turn of 50 ms; the scanner is told every 100 µs.
const char* turn(std::uint64_t now_ns) {
    constexpr std::uint64_t kTurnNs = 50'000'000;
    constexpr std::uint64_t kPollNs = 100'000;
    if (scan_control.init(kTurning, display_device, now_ns) != Status::Ok) return "the display cannot turn\n";
    scan_control.interlock(true);
    device::ScanOrder shown;
    std::uint32_t lit = 0;
    for (std::uint64_t t = 0; t < 20 * kTurnNs; t += kPollNs) {
        if (t % kTurnNs == 0 && t <= 10 * kTurnNs) scan_control.index_pulse(now_ns + t);
        const device::ScanOrder& order = scan_control.poll(now_ns + t);
        if (order.number == shown.number) continue;
        if (shown.lit()) scan_control.scan_done(shown, now_ns + t);
        if (order.lit()) {
            if (lit > 0 && order.slice != (shown.slice + 1) % kDisplay.slices) return "a slice is out of order\n";
            if (order.slice != t * kDisplay.slices / kTurnNs % kDisplay.slices) return "a slice is out of place\n";
            if (order.brightness != (order.slice == 3 ? 113 : 128)) return "the current limit does not hold\n";
            ++lit;
        }
        shown = order;
    }
    if (lit < 50) return "too few slices were lit\n";
    if (shown.dark != device::Dark::Fault || display_device.fault() != wire::Fault::LostIndex) {
        return "it went on without its index\n";
    }
    return nullptr;
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
    if (const char* wrong = scan_out(display_device, scan_control, now_ns)) return fail(wrong);
    if (const char* wrong = turn(now_ns)) return fail(wrong);
    semihosting::print(
        "the golden conversation went to the letter, the layers to their pins, and the slices to their places\n");
    return 0;
}
