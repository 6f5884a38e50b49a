// The half of a session that watches the clock and sends.

#include <algorithm>

#include <fmt/format.h>

#include "driver/host/faults.h"
#include "driver/host/session_impl.h"

namespace xorvox::host {

using namespace wire;

namespace {

constexpr std::uint64_t kNsPerMs = 1'000'000;
constexpr std::uint64_t kKeepAliveNs = 500 * kNsPerMs;  ///< Between pings to a device that does not want any.
constexpr std::uint64_t kSilences = 3;  ///< Answer timeouts without a word, while idle, until the device is asked anew.

}  // namespace

bool Session::Impl::passed(std::uint64_t since_ns, std::uint64_t timeouts) const {
    return now_ns - since_ns >= timeouts * timeout_ns;
}

void Session::Impl::watch_clock() {
    if (state == SessionState::Connecting) {
        if (passed(connecting_since_ns, options.attempts)) fail_no_answer();
        return;
    }
    if (controls.watch(now_ns, timeout_ns, options.attempts)) ++statistics.controls_lost;
    if (!wants_status()) ask_status_ns = now_ns + timeout_ns;
    watch_presentation();
    if (state == SessionState::Ready) watch_transfer();
}

void Session::Impl::watch_transfer() {
    switch (transfer.phase()) {
        case Phase::None: break;
        case Phase::Queued:
            if (free_pages == 0 && passed(phase_since_ns, options.attempts)) {
                return fail_with(Status::Closed,
                                 fmt::format("the display on the link {} has no free page for a frame; does it turn or "
                                             "refresh?",
                                             info.name));
            }
            break;
        case Phase::Sending:
            if (passed(willing_ns, options.attempts)) {
                fail_with(Status::Closed,
                          fmt::format("the peer on the link {} takes no more data; is it still running?", info.name));
            }
            return;
        case Phase::Waiting:
            // Longer every time: a slow link may still be busy with the attempt before.
            if (!passed(phase_since_ns, 1 + transfer.failed_attempts())) return;
            // Twice without a word: the device may have been reset, and know of no session.
            if (++silent_timeouts >= 2) {
                connect_again();
            } else {
                send_again({});
            }
            return;
    }
    if (asked && passed(asked_ns, kSilences)) connect_again();
}

void Session::Impl::watch_presentation() {
    if (!transfer.awaits_presentation_at(device_time_ns)) {
        nothing_overdue_ns = now_ns;
        return;
    }
    if (options.present_timeout_ns <= 0) return;
    const auto limit_ns = static_cast<std::uint64_t>(options.present_timeout_ns);
    if (now_ns - nothing_overdue_ns < limit_ns) return;
    fail_with(Status::Closed,
              fmt::format("the display on the link {} accepted a frame but has not shown it for {:.3g} s; {}",
                          info.name, static_cast<double>(limit_ns) / 1e9,
                          device_status.fault > Fault::SilentHost ? describe(device_status.fault) : "does it turn?"));
}

/// What only a DeviceStatus tells: the watchdog, which a hello does not name; a page that became free; a frame that is
/// shown, where the Presented that said so was lost.
bool Session::Impl::wants_status() const {
    return !has_status || (free_pages == 0 && transfer.phase() != Phase::Waiting) || transfer.awaits_presentation();
}

std::uint64_t Session::Impl::ping_every_ns() const {
    if (device_status.watchdog_ms == 0) return kKeepAliveNs;
    return std::max<std::uint64_t>(device_status.watchdog_ms / 4, 1) * kNsPerMs;
}

bool Session::Impl::send_all() {
    bool moved = false;
    while (out_bytes > 0 || compose()) {
        const Status status = link.send(std::span(out).first(out_bytes));
        if (status == Status::WouldBlock) return moved;
        if (status != Status::Ok) {
            fail_closed();
            return true;
        }
        statistics.bytes_sent += out_bytes;
        out_bytes = 0;
        moved = true;
        moved_ns = willing_ns = now_ns;
        if (!asked) {
            asked = true;
            asked_ns = now_ns;
        }
        if (transfer.all_given()) {
            transfer.sent(info.two_way);
            phase_since_ns = now_ns;
        }
    }
    return moved;
}

template <class Message>
bool Session::Impl::compose_message(const Message& message) {
    return encode_packet(options.session, sequence++, message, out, out_bytes) == Status::Ok;
}

/// Puts the next packet into `out`. False when there is nothing to say.
bool Session::Impl::compose() {
    // Without a way back it is said once, for the device that will play the recording.
    const bool greets = info.two_way ? state == SessionState::Connecting : hello_attempts == 0;
    if (greets) return compose_hello();
    if (info.two_way && wants_status() && now_ns >= ask_status_ns) {
        ask_status_ns = now_ns + timeout_ns;
        return compose_message(Control{.operation = ControlOperation::Status});
    }
    if (info.two_way && clock_every_ns > 0 && now_ns >= ask_clock_ns) {
        ask_clock_ns = now_ns + clock_every_ns;
        return compose_message(Ping{.host_time_ns = now_ns});
    }
    if (controls.has_next()) return compose_message(info.two_way ? controls.send(now_ns) : controls.take());
    if (transfer.phase() == Phase::Queued && (free_pages > 0 || !info.two_way)) {
        const bool due = options.keyframe_interval_ns > 0 && now_ns - keyframe_ns >= options.keyframe_interval_ns;
        transfer.encode(info.two_way && options.deltas && (device.features & kFeatureDelta) != 0 && !due);
        if (!transfer.is_delta()) keyframe_ns = now_ns;
    }
    if (transfer.phase() == Phase::Sending) {
        const Payload payload = transfer.next_payload();
        const Header header{.type = payload.type, .session = options.session, .sequence = sequence++};
        return encode_packet(header, payload.bytes, out, out_bytes) == Status::Ok;
    }
    if (!info.two_way) return false;
    if (now_ns - moved_ns < ping_every_ns()) return false;
    return compose_message(Ping{.host_time_ns = now_ns});
}

bool Session::Impl::compose_hello() {
    if (hello_attempts > 0 && !passed(hello_ns, 1)) return false;
    ++hello_attempts;
    hello_ns = now_ns;
    return compose_message(HelloRequest{.major = kMajor, .minor = kMinor, .host_time_ns = now_ns});
}

}  // namespace xorvox::host
