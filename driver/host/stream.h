// FrameStream: volumes at a steady rate over a Session.
//
//   offer() ─► queue on the host ─► session ─► pages of the device ─► presented
//                 │ too many: the drop policy      │ not there in time, and a later one was: given up
//                 ▼                                ▼
//              dropped                          given up
//
// Time is cut into slots of one period each, and every frame gets one: the next that it can still reach, going by how
// long the last ones took; so none is shown before another that was offered earlier. A display changes its picture only
// at the boundaries of its cycle; so a slot means the boundary nearest to it, and a frame's present_at is half a cycle
// before that one: however unevenly the display runs, the frame is due after the boundary before and before its own.
// Where the boundaries are is learned from what was presented when; the first frame is sent for "now" to find out, and
// the slots count from where it appeared. A slot for which no frame is there in time is missed: the picture before
// stays.
//
// It does nothing on its own, has no clock and no thread: poll() does what can be done now. On a link with no way back
// there are no slots: every frame is handed to the link as it comes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "driver/display/description.h"
#include "driver/host/boundary_estimate.h"
#include "driver/host/recent_values.h"
#include "driver/host/session.h"
#include "voxelizer/status.h"

namespace xorvox::host {

/// What offer() does when the queue is full.
enum class DropPolicy : std::uint8_t {
    Wait,        ///< Refuses the frame: the producer waits, and nothing is lost.
    DropOldest,  ///< Takes it, and forgets the one that waits longest: the shortest delay.
    DropNewest,  ///< Forgets it.
};

struct StreamOptions {
    /// Between volumes. 0, or less than a cycle of the display: one in each cycle. What is within 2 % of a whole number
    /// of the display's real cycles is that many, so that the rate is even.
    std::uint64_t period_ns = 0;
    DropPolicy policy = DropPolicy::Wait;
    std::uint32_t queue_frames = 2;   ///< That wait on the host; 1 or more.
    std::uint32_t max_in_flight = 3;  ///< Sent and not yet shown; 1 … 16. The device's pages bound them too.
};

/// Since the stream began. offered = dropped + waiting + sent, and two-way sent = presented + given_up + in flight.
struct StreamStatistics {
    std::uint64_t offered = 0;       ///< That offer() answered Ok to.
    std::uint64_t dropped = 0;       ///< By the policy, before they were sent.
    std::uint64_t sent = 0;          ///< Handed to the session.
    std::uint64_t presented = 0;     ///< Shown.
    std::uint64_t given_up = 0;      ///< Accepted, but never shown: a later one was instead, or the device was reset.
    std::uint64_t late = 0;          ///< Of the presented: shown more than half a cycle after the boundary asked for.
    std::uint64_t slots_missed = 0;  ///< That passed without a frame.

    /// How long after the boundary asked for frames were shown, on the device's clock; 0 for one that was not late at
    /// all. Exact quantiles (the smallest value that is not below so many of them) over the last kLatenessWindow
    /// frames; the greatest is of all. Without the first one, which is asked for no time.
    std::uint64_t lateness_p50_ns = 0;
    std::uint64_t lateness_p99_ns = 0;
    std::uint64_t lateness_max_ns = 0;

    /// Between frames that were shown one after the other, on the device's clock; times without a session left out.
    double rate_hz = 0.0;  ///< 0 before the second one.
    std::uint64_t worst_interval_ns = 0;
};

class FrameStream {
public:
    static constexpr std::size_t kLatenessWindow = 4096;

    /// Borrows `session` for its life; from now on all frames of the session come from here. `display` is the
    /// session's. All memory is taken now, queue_frames pages of it; only the session's own buffers still grow with the
    /// first frames.
    FrameStream(Session& session, const DisplayDescription& display, const StreamOptions& options = {});
    FrameStream(const FrameStream&) = delete;
    FrameStream& operator=(const FrameStream&) = delete;

    /// Takes a copy of a frame of frame_bytes(display). Ok, also when the policy drops one; WouldBlock when the policy
    /// is Wait and the queue is full; InvalidArgument on another size; Closed when the session has failed.
    Status offer(std::span<const std::byte> frame);
    /// Whether a frame offered now would neither be refused nor make another one drop.
    bool has_room() const { return waiting_ < options_.queue_frames; }

    /// Polls the session, and sends what can be sent. Answers as Session::poll, and wants to be called as often; a
    /// device without the feature "present at" wants it every quarter of a cycle, because the host keeps the time then.
    /// WouldBlock: wait for session.events() at the link.
    Status poll(std::uint64_t now_ns);

    /// The slot, counted from 0, in which a frame offered now is expected, as of the last poll(). Times the period, it
    /// is the time of an animation that neither slots missed nor frames dropped slow down.
    std::uint64_t next_slot() const;
    /// Between slots: options.period_ns, fitted to the display's real cycle.
    std::uint64_t period_ns() const;

    /// Frames that were sent and whose fate is not known yet.
    std::uint32_t in_flight() const { return static_cast<std::uint32_t>(flights_.size()); }
    /// Nothing waits and nothing is in flight.
    bool idle() const;

    /// Sorts the window of lateness: not for every frame.
    StreamStatistics statistics() const;

private:
    struct Flight {
        std::uint64_t frame;        ///< As FrameFate counts.
        std::uint64_t boundary_ns;  ///< That should show it; 0: it was asked for no time.
    };
    struct Slot {
        std::uint64_t index;
        std::uint64_t begin_ns;     ///< Device clock, as all times here.
        std::uint64_t boundary_ns;  ///< The one that it means.
    };

    void notice_another_session();
    void notice_delivery();
    void collect_fates();
    void note_presented(std::uint64_t boundary_ns, std::uint64_t presented_ns);
    bool send_next();
    bool hand_over(std::uint64_t present_at_ns, std::uint64_t boundary_ns);
    Slot slot_not_before(std::uint64_t earliest_ns) const;
    std::uint64_t device_time_ns() const;
    std::uint64_t delivery_ns() const;
    double cycles_of_period() const;
    std::uint64_t half_cycle_ns() const;

    Session* session_;
    StreamOptions options_;
    std::size_t frame_bytes_;
    std::vector<std::byte> queue_;  ///< A ring of frames.
    std::uint32_t first_ = 0;
    std::uint32_t waiting_ = 0;

    std::uint64_t now_ns_ = 0;
    std::uint64_t hellos_ = 0;
    std::vector<Flight> flights_;
    bool finding_boundary_ = false;  ///< A frame is in flight to find out where the boundaries are.
    BoundaryEstimate boundaries_;
    Slot last_{};                   ///< Given to a frame last.
    std::uint64_t next_index_ = 0;  ///< Of the slot after it.

    std::array<std::uint64_t, 5> deliveries_ns_{};  ///< How long the last frames took until they were accepted.
    std::size_t oldest_delivery_ = 0;
    bool delivering_ = false;
    std::uint64_t submitted_ns_ = 0;
    std::uint64_t accepted_before_ = 0;  ///< Frames that the session had counted then.

    StreamStatistics counts_;
    RecentValues lateness_ns_;
    std::uint64_t last_presented_ns_ = 0;
    std::uint64_t intervals_ = 0;
    std::uint64_t intervals_sum_ns_ = 0;
};

}  // namespace xorvox::host
