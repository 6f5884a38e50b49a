// The input turns a display, badly: index pulses and encoder steps at any time, a scanner that reports what it likes,
// an interlock, long pauses. However it goes: no slice out of range, a phase that never runs backwards, light only
// where the rotation is known, the interlock is closed and no fault is latched, and a fault that stays until it is
// cleared.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <span>
#include <utility>

#include "driver/device/config.h"
#include "driver/device/scan_control.h"

using namespace xorvox;
using namespace xorvox::wire;

namespace {

void check(bool holds) {
    if (!holds) std::abort();
}

constexpr std::uint64_t kMs = 1'000'000;

class Input {
public:
    Input(const std::uint8_t* data, std::size_t size) : left_(data, size) {}
    bool empty() const { return left_.empty(); }
    std::uint8_t byte() {
        if (left_.empty()) return 0;
        const std::uint8_t value = left_.front();
        left_ = left_.subspan(1);
        return value;
    }

private:
    std::span<const std::uint8_t> left_;
};

DisplayDescription display_of(Input& input) {
    constexpr std::array kPulses{1u, 2u, 3u, 16u, 100u, 65536u};
    constexpr std::array kKinds{DisplayKind::StackedPlanes, DisplayKind::RotatingPanel, DisplayKind::SweptPlane,
                                DisplayKind::Helix};
    DisplayDescription display;
    display.kind = kKinds[input.byte() % kKinds.size()];
    display.format = kPixelFormats[input.byte() % kPixelFormats.size()];
    display.slices = 1 + input.byte() % 8;
    display.cycles_per_second = 20.0;
    display.panels[0] = {.columns = static_cast<std::uint16_t>(1 + input.byte() % 40), .rows = 3};
    display.sync.index = static_cast<IndexSource>(input.byte() % 3);
    display.sync.index_pulses = kPulses[input.byte() % kPulses.size()];
    display.sync.index_phase = input.byte() / 256.0;
    if (display.kind == DisplayKind::RotatingPanel && input.byte() % 2 == 1) display.sweep_deg = 180.0;
    if (display.kind == DisplayKind::Helix) display.blades = 1 + input.byte() % 8;
    display.motion.stroke_mm = 10.0;
    display.motion.both_ways = input.byte() % 2 == 1;
    display.motion.dead_zone = input.byte() % 45 / 100.0;
    display.power = {.led_ma = 10.0, .limit_ma = input.byte() * 1.0};
    return display;
}

/// A link with room for the one packet that comes next.
struct OnePacket {
    std::array<std::byte, 4096> packet{};
    std::size_t size = 0;

    Link link() {
        static constexpr LinkOperations kOperations{
            .info =
                [](const void*) {
                    return LinkInfo{"fuzz", kMaxPacketBytes, true};
                },
            .send = [](void*, std::span<const std::byte>) { return Status::Ok; },
            .receive =
                [](void* self, std::span<std::byte> buffer, std::size_t& received) {
                    auto& one = *static_cast<OnePacket*>(self);
                    if (one.size == 0) return Status::WouldBlock;
                    std::copy_n(one.packet.begin(), one.size, buffer.begin());
                    received = std::exchange(one.size, 0);
                    return Status::Ok;
                },
            .flush = nullptr,
            .wait = nullptr,
            .close = [](void*) {},
        };
        return {&kOperations, this};
    }
};

class World {
public:
    explicit World(Input& input) : display_(display_of(input)) {
        const std::uint8_t built = input.byte();
        check(device_.init({.display = &display_, .link = link_.link(), .pages = pages_, .packet = buffer_}, now_ns_) ==
              Status::Ok);
        const device::Wiring wiring{.reports_scans = (built & 1u) != 0, .has_interlock = (built & 2u) != 0};
        closed_ = !wiring.has_interlock;
        check(control_.init(device::scan_control_config(display_, wiring), device_, now_ns_) == Status::Ok);
        send(HelloRequest{.host_time_ns = 1});
        send(Control{ControlOperation::Watchdog, 0});
        const auto bytes = static_cast<std::uint32_t>(frame_bytes(display_));
        for (std::uint32_t i = 0; i < bytes; ++i) frame_[i] = static_cast<std::byte>(input.byte());
        const auto frame = std::span<const std::byte>(frame_).first(bytes);
        send(FrameBegin{.frame = 1, .frame_bytes = bytes});
        send(Chunk{.frame = 1, .decoded_length = bytes, .data = frame});
        send(FrameEnd{.frame = 1, .page_crc = crc32c(frame)});
        check(device_.status(now_ns_).frames_accepted == 1);
    }

    void step(Input& input) {
        switch (input.byte() % 10) {
            case 0: now_ns_ += input.byte() * kMs / 4; break;
            case 1: now_ns_ += std::uint64_t{1} << input.byte() % 45; break;
            case 2: control_.index_pulse(now_ns_ + input.byte() * 1000 - 100'000); break;
            case 3: control_.index_pulse(std::uint64_t{input.byte()} << input.byte() % 64); break;
            case 4: {
                const auto steps = static_cast<std::int8_t>(input.byte());
                control_.encoder(now_ns_, steps * (1 << input.byte() % 24));
                break;
            }
            case 5: turn(input); break;
            case 6:
                closed_ = input.byte() % 2 == 1;
                control_.interlock(closed_);
                break;
            case 7: control_.scan_done(order_, now_ns_ + input.byte() * kMs / 8); break;
            case 8: {
                const std::uint8_t fault = input.byte() % 9;
                send(Control{ControlOperation::ClearFault, fault});
                latched_ &= ~(1u << fault);
                break;
            }
            case 9: control_.scan_done(device::ScanOrder{.number = input.byte()}, now_ns_); break;
        }
        poll();
    }

private:
    /// Turns on, evenly or not: without this, few inputs would lock.
    void turn(Input& input) {
        const int count = input.byte() % 32;
        const std::uint64_t turn_ns = (30 + input.byte() % 100) * kMs;
        const std::uint64_t jitter = input.byte();
        const std::uint32_t pulses = std::min(display_.sync.index_pulses, 64u);
        for (int i = 0; i < count; ++i) {
            now_ns_ += turn_ns / pulses + static_cast<unsigned>(i) * 7919u % (jitter + 1) * 20'000;
            if (display_.sync.index == IndexSource::Encoder) {
                control_.encoder(now_ns_, static_cast<std::int32_t>(display_.sync.index_pulses / pulses));
                if (i % static_cast<int>(pulses) == 0) control_.index_pulse(now_ns_);
            } else {
                control_.index_pulse(now_ns_);
            }
            poll();
        }
    }

    void poll() {
        (void)device_.poll(now_ns_);
        order_ = control_.poll(now_ns_);
        const device::Phase phase = control_.rotation().phase();
        check(device::phase_between(phase_, phase) >= 0);
        phase_ = phase;
        check((device_.faults() & latched_) == latched_);
        latched_ = device_.faults();
        check(!order_.lit() || (latched_ == 0 && closed_));
        check((order_.dark == device::Dark::Fault) == (latched_ != 0));
        if (!order_.lit()) {
            check(order_.bytes.empty() && order_.brightness == 0);
            return;
        }
        check(control_.rotation().state() == device::RotationTracker::State::Locked);
        check(order_.slice < display_.slices);
        check(order_.begin_ns <= now_ns_ && now_ns_ < order_.end_ns);
        const auto page = device_.shown().page;
        check(order_.bytes.size() == slice_bytes(display_));
        check(order_.bytes.data() == page.data() + order_.slice * slice_bytes(display_));
        check(control_.next_boundary_ns() > now_ns_);
    }

    template <class Message>
    void send(const Message& message) {
        check(encode_packet(1, sequence_++, message, link_.packet, link_.size) == Status::Ok);
        (void)device_.poll(now_ns_);
    }

    DisplayDescription display_;
    OnePacket link_;
    std::array<std::byte, 2 * 8 * 3 * 120> pages_{};
    std::array<std::byte, 8 * 3 * 120> frame_{};
    std::array<std::byte, 4096> buffer_{};
    device::Device device_;
    device::ScanControl control_;
    std::uint64_t now_ns_ = 1'000'000'000;
    std::uint32_t sequence_ = 0;
    bool closed_ = true;
    std::uint32_t latched_ = 0;
    device::Phase phase_ = 0;
    device::ScanOrder order_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Input input(data, size);
    World world(input);
    while (!input.empty()) world.step(input);
    return 0;
}
