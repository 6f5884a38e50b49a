// Session: the host's end of the wire protocol (driver/PROTOCOL.md) over any link.
//
//   Connecting ── hello ok ─► Ready ── silence ─► Connecting ── no answer ─► Failed
//        └──── refused: other geometry, other major version       link closed, frame not taken or not shown ─► Failed
//
// One frame is on its way at a time:
//
//   submit() ─► queued ── a page is free ─► sent ── accepted ─► the base of the next delta
//                 ▲                          │
//                 └── refused, or no answer ─┘  again, with a new id, as a keyframe, a bounded number of times
//
// What becomes of an accepted frame, next_fate() tells: presented, and since when, or given up for a later one. For a
// steady rate over it, see driver/host/stream.h.
//
// It does nothing on its own: poll() sends, receives and watches the clock, which the caller injects. One thread.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "driver/display/description.h"
#include "driver/host/clock_offset.h"
#include "driver/wire/messages.h"
#include "transport/link.h"
#include "voxelizer/error.h"
#include "voxelizer/status.h"

namespace xorvox::host {

struct SessionOptions {
    bool deltas = true;         ///< XOR-deltas against the last accepted frame where the device takes them.
    bool compress = true;       ///< LZ4 where the device takes it and it is shorter. Without it there are no deltas.
    std::uint16_t session = 1;  ///< Id; another one than a previous session's to the same device. 0 counts as 1.
    std::int64_t answer_timeout_ns =
        500'000'000;              ///< Without an answer for this long: ask, or send again, as a keyframe.
    std::uint32_t attempts = 10;  ///< Of hello, of one frame and of one control, before it is given up.
    std::int64_t present_timeout_ns =
        10'000'000'000;  ///< A display that shows no new frame for this long although one is due has failed. 0: never.
    std::uint64_t keyframe_interval_ns =
        0;  ///< No delta once the last keyframe was begun so long ago: for who joins later, and recordings. 0: never.
    bool clears_silence = true;  ///< Clears the fault of a silent host, since there is one now; false: looks only.
};

enum class SessionState : std::uint8_t { Connecting, Ready, Failed };

struct SessionStatistics {
    std::uint64_t frames_submitted = 0;
    std::uint64_t frames_accepted = 0;
    std::uint64_t frames_presented = 0;
    std::uint64_t frames_resent = 0;    ///< As keyframes, after a Nack or silence.
    std::uint64_t frames_delta = 0;     ///< Encoded as deltas.
    std::uint64_t controls_lost = 0;    ///< Given up: the device refused them or did not say that it did them.
    std::uint64_t hellos = 0;           ///< Times that a session was begun with the device: 1 unless it fell silent.
    std::uint64_t packets_ignored = 0;  ///< Received, but damaged, repeated or of somebody else.
    std::uint64_t bytes_raw = 0;        ///< Of the submitted frames.
    std::uint64_t bytes_sent = 0;       ///< Of all packets that the link took.
};

/// What became of a frame that the device accepted.
struct FrameFate {
    std::uint64_t frame = 0;  ///< The how-manieth that was submitted: SessionStatistics::frames_submitted after it was.
    bool presented = false;   ///< False: it will never be shown; a later one was instead, or the device forgot it.
    std::uint64_t device_time_ns = 0;  ///< Since when it is shown; 0: the message that said so was lost.
};

class Session {
public:
    /// `display` is what frames are made for and is copied; the device's geometry digest must equal its. On a link with
    /// no way back the session is Ready at once, with the capabilities that `display` implies, and sends keyframes
    /// only. `link` is borrowed for the session's life.
    Session(Link link, const DisplayDescription& display, const SessionOptions& options = {});
    ~Session();
    Session(Session&&) noexcept;
    Session& operator=(Session&&) noexcept;

    /// Moves everything that can move now. `now_ns` never goes back. Call it at least every 100 ms, and every eighth of
    /// device_status().watchdog_ms where that is shorter, also when there is nothing to send: it keeps the device's
    /// watchdog quiet. It clears the fault of a silent host by itself (SessionOptions::clears_silence), and no other.
    /// Ok; WouldBlock when nothing moved (wait for events() on the link, not for long); Closed or Refused once the
    /// session has Failed: error() says why.
    Status poll(std::uint64_t now_ns);

    /// Takes a copy of a frame of frame_bytes(display) to be sent; `present_at_ns` is of the device's clock, 0: as soon
    /// as possible. Allowed from the start. WouldBlock while the one before has not been accepted or the device has no
    /// free page; InvalidArgument on another size; Closed when Failed.
    Status submit(std::span<const std::byte> frame, std::uint64_t present_at_ns = 0);

    /// Queues one control message; it is sent again until a DeviceStatus confirms it, a bounded number of times. A
    /// Blank is confirmed only while the device has no fault. InvalidArgument when `value` is out of the operation's
    /// range; WouldBlock when many wait; Closed when Failed.
    Status control(wire::ControlOperation operation, std::uint32_t value);

    /// The oldest fate that was not asked for yet; false when there is none. Each frame that the device accepts has one
    /// in the end, in the order in which they become known. The last 64 are kept.
    bool next_fate(FrameFate& fate);

    /// From now on asks the device for its clock this often, also while frames are on their way; 0: not at all.
    void follow_clock(std::uint64_t every_ns);
    /// The device's clock, from the hello and every answer since; it begins anew with each session with the device.
    const ClockOffset& clock() const;

    SessionState state() const;
    bool two_way() const;
    /// True when every submitted frame was accepted and every control confirmed (two-way) or handed to the link
    /// (one-way).
    bool idle() const;
    /// LinkEvents that poll() is waiting for.
    std::uint32_t events() const;
    const Error& error() const;         ///< Valid when Failed.
    const wire::Hello& device() const;  ///< Valid from Ready on; its fault is that of the beginning.
    /// The last one received; before the first, only `fault` and `faults` are valid, from Ready on: they are hello's.
    /// All faults but a silent host's stay until somebody judges them and calls control(ClearFault, number of the
    /// fault): tell your user (driver/host/faults.h).
    const wire::DeviceStatus& device_status() const;
    std::uint32_t last_accepted() const;   ///< Frame id; 0: none.
    std::uint32_t last_presented() const;  ///< Frame id; 0: none.
    const SessionStatistics& statistics() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace xorvox::host
