// A stream to a real device half, over a wire of a given speed; both clocks, the display's cycle and what is offered
// when are the test's. What was asked for and what was shown is written down at the device's end.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "driver/device/device.h"
#include "driver/host/stream.h"
#include "tests/catch.h"
#include "tests/unit/session/scripted_device.h"
#include "transport/faults.h"
#include "transport/loopback.h"

namespace xorvox::host {

/// The host's end of a wire on which one packet at a time is on its way.
class Wire {
public:
    Wire(UniqueLink inner, const std::uint64_t& now_ns) : inner_(std::move(inner)), now_ns_(&now_ns) {
        held_.reserve(wire::kMaxPacketBytes);
    }

    Link link() {
        static constexpr LinkOperations kOperations{
            .info = [](const void* self) { return static_cast<const Wire*>(self)->inner_->info(); },
            .send = [](void* self,
                       std::span<const std::byte> packet) { return static_cast<Wire*>(self)->send(packet); },
            .receive =
                [](void* self, std::span<std::byte> buffer, std::size_t& size) {
                    static_cast<Wire*>(self)->deliver();
                    return static_cast<Wire*>(self)->inner_->receive(buffer, size);
                },
            .flush = nullptr,
            .wait = nullptr,
            .close = [](void*) {},
        };
        return {&kOperations, this};
    }

    std::uint64_t ns_per_byte = 0;
    std::map<std::uint32_t, std::uint64_t> asked;  ///< present_at of each frame id.
    bool writes_down = true;

private:
    Status send(std::span<const std::byte> packet) {
        deliver();
        if (!held_.empty()) return Status::WouldBlock;
        wire::Header header;
        std::span<const std::byte> payload;
        wire::FrameBegin begin;
        if (writes_down && wire::decode_packet(packet, header, payload) == Status::Ok &&
            header.type == wire::PacketType::FrameBegin && wire::decode(payload, begin) == Status::Ok) {
            asked[begin.frame] = begin.present_at_ns;
        }
        held_.assign(packet.begin(), packet.end());
        arrives_ns_ = *now_ns_ + packet.size() * ns_per_byte;
        deliver();
        return Status::Ok;
    }
    void deliver() {
        if (held_.empty() || *now_ns_ < arrives_ns_) return;
        if (inner_->send(held_) != Status::Ok) FAIL("the loopback is full");
        held_.clear();
    }

    UniqueLink inner_;
    const std::uint64_t* now_ns_;
    Bytes held_;
    std::uint64_t arrives_ns_ = 0;
};

struct StreamRigOptions {
    std::uint32_t pages = 3;
    std::uint64_t cycle_ns = 10 * kMs;  ///< The display's real one; its description says 10 ms.
    std::uint64_t ns_per_byte = 0;
    std::optional<transport::FaultOptions> faults{};
    SessionOptions session{.compress = false};
};

struct StreamRig {
    struct Shown {
        std::uint32_t number;  ///< Of the offered frame.
        std::uint32_t id;
        std::uint64_t boundary_ns;  ///< Device clock.
    };

    explicit StreamRig(const StreamOptions& stream_options, const StreamRigOptions& options = {})
        : StreamRig(stream_options, options, transport::make_loopback()) {}

    /// The device's clock: it was switched on 5 s after the host's began.
    std::uint64_t device_ns() const { return now_ns - on_since_ns; }

    void step() {
        now_ns += kStepNs;
        if (device_ns() >= next_boundary_ns) boundary();
        if (produce) produce(*this);
        for (int i = 0; i < 100; ++i) {
            const Status moved = stream->poll(now_ns);
            REQUIRE(session->state() != SessionState::Failed);
            if (device.poll(device_ns()) != Status::Ok && moved != Status::Ok) break;
        }
        most_in_flight = std::max(most_in_flight, stream->in_flight());
    }
    void run(std::uint64_t ns) {
        for (const std::uint64_t end = now_ns + ns; now_ns < end;) step();
    }
    /// Until everything that was offered has a fate.
    void drain() {
        produce = nullptr;
        for (int i = 0; !stream->idle(); ++i) {
            REQUIRE(i < 1'000'000);
            step();
        }
    }
    /// Frame `number`, of which nothing is known but that.
    Status offer(std::uint32_t number) {
        std::memcpy(frame.data(), &number, sizeof number);
        return stream->offer(frame);
    }

    /// The display loses its power for a moment: another boot, another clock, which says `clock_ns`, no picture.
    void reset_device(std::uint64_t clock_ns) {
        on_since_ns = now_ns - clock_ns;
        next_boundary_ns = clock_ns + cycle_ns;
        ++boot_nonce;
        start_device();
    }

    // What the device's end knows, to hold the statistics against.

    /// The boundary that should have shown a frame; 0: it was asked for no time.
    std::uint64_t boundary_asked(const Shown& frame_shown) const {
        const std::uint64_t present_at_ns = wire.asked.at(frame_shown.id);
        return present_at_ns == 0 ? 0 : *std::lower_bound(boundaries.begin(), boundaries.end(), present_at_ns);
    }
    std::vector<std::uint64_t> lateness() const {
        std::vector<std::uint64_t> lateness;
        for (const Shown& frame_shown : shown) {
            const std::uint64_t asked_ns = boundary_asked(frame_shown);
            if (asked_ns != 0) lateness.push_back(frame_shown.boundary_ns - asked_ns);
        }
        return lateness;
    }
    /// Between what was shown, from the picture `from` on.
    std::vector<std::uint64_t> intervals(std::size_t from = 0) const {
        std::vector<std::uint64_t> intervals;
        for (std::size_t i = from + 1; i < shown.size(); ++i) {
            intervals.push_back(shown[i].boundary_ns - shown[i - 1].boundary_ns);
        }
        return intervals;
    }
    bool in_order() const {
        return std::is_sorted(shown.begin(), shown.end(),
                              [](const Shown& a, const Shown& b) { return a.number <= b.number; });
    }

    static constexpr std::uint64_t kStepNs = 100'000;

    DisplayDescription display = small_display();
    Bytes frame;
    std::uint64_t now_ns = 7'000'000'000;
    std::uint64_t on_since_ns = 5'000'000'000;
    std::uint64_t cycle_ns;
    std::uint64_t next_boundary_ns;
    std::function<std::uint64_t()> next_cycle_ns;  ///< Where the cycles are not even.
    std::function<void(StreamRig&)> produce;       ///< Every step.
    bool turns = true;

    Wire wire;
    UniqueLink host_link;
    UniqueLink device_link;
    std::uint32_t boot_nonce = 1;
    Bytes pages;
    Bytes packet;
    device::Device device;
    std::optional<Session> session;
    std::optional<FrameStream> stream;

    std::vector<Shown> shown;
    std::vector<std::uint64_t> boundaries;
    std::uint32_t most_in_flight = 0;
    std::uint32_t page_count;

private:
    StreamRig(const StreamOptions& stream_options, const StreamRigOptions& options,
              std::pair<UniqueLink, UniqueLink> ends)
        : frame(frame_bytes(display)),
          cycle_ns(options.cycle_ns),
          wire(std::move(ends.first), now_ns),
          device_link(std::move(ends.second)),
          pages(options.pages * frame_bytes(display)),
          packet(1024),
          page_count(options.pages) {
        for (std::size_t i = 4; i < frame.size(); ++i) frame[i] = static_cast<std::byte>((i * i) >> 4);
        next_boundary_ns = device_ns() + 3 * kMs;
        wire.ns_per_byte = options.ns_per_byte;
        host_link = UniqueLink(wire.link());
        if (options.faults) host_link = transport::with_faults(std::move(host_link), *options.faults);
        start_device();
        session.emplace(host_link.get(), display, options.session);
        stream.emplace(*session, display, stream_options);
    }

    void start_device() {
        device::DeviceConfig config;
        config.display = &display;
        config.boot_nonce = boot_nonce;
        config.link = device_link.get();
        config.pages = pages;
        config.page_count = page_count;
        config.packet = packet;
        REQUIRE(device.init(config, device_ns()) == Status::Ok);
    }

    void boundary() {
        const std::uint64_t at_ns = next_boundary_ns;
        next_boundary_ns += next_cycle_ns ? next_cycle_ns() : cycle_ns;
        if (!turns) return;
        boundaries.push_back(at_ns);
        device.boundary(at_ns);
        const device::Shown now_shown = device.shown();
        if (now_shown.page.empty()) return;
        Shown entry{0, now_shown.frame, at_ns};
        std::memcpy(&entry.number, now_shown.page.data(), sizeof entry.number);
        // A frame whose acceptance was lost comes again under another id.
        if (shown.empty() || shown.back().number != entry.number) shown.push_back(entry);
    }
};

/// Offers frame after frame, as many as the stream has room for.
inline std::function<void(StreamRig&)> greedy_producer(std::uint32_t count = ~0u) {
    return [count, number = std::uint32_t{0}](StreamRig& rig) mutable {
        while (number < count && rig.stream->has_room()) REQUIRE(rig.offer(number++) == Status::Ok);
    };
}

/// Offers a frame every `period_ns`, each up to `jitter_ns` early or late, whether there is room or not.
inline std::function<void(StreamRig&)> timed_producer(std::uint64_t period_ns, std::uint64_t jitter_ns = 0) {
    return [=, number = std::uint32_t{0}, seed = std::uint32_t{1}, start_ns = std::uint64_t{0},
            next_ns = std::uint64_t{0}](StreamRig& rig) mutable {
        if (number == 0 && next_ns == 0) start_ns = next_ns = rig.now_ns + jitter_ns;
        while (rig.now_ns >= next_ns) {
            (void)rig.offer(number++);
            seed = seed * 1664525u + 1013904223u;
            const std::uint64_t shift_ns = jitter_ns == 0 ? 0 : (seed >> 8) % (2 * jitter_ns + 1);
            next_ns = start_ns + number * period_ns + shift_ns - jitter_ns;
        }
    };
}

}  // namespace xorvox::host
