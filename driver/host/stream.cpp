#include "driver/host/stream.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "driver/wire/messages.h"

namespace xorvox::host {
namespace {

constexpr std::uint32_t kMostInFlight = 16;
/// Between looks at the device's clock: crystals run apart by 20 µs in that time.
constexpr std::uint64_t kClockEvery_ns = 100'000'000;
/// More than the clock is off on a device without a crystal.
constexpr std::uint64_t kClockSlack_ns = 1'000'000'000;

}  // namespace

FrameStream::FrameStream(Session& session, const DisplayDescription& display, const StreamOptions& options)
    : session_(&session),
      options_(options),
      frame_bytes_(frame_bytes(display)),
      boundaries_(1e9 / display.cycles_per_second),
      lateness_ns_(kLatenessWindow) {
    options_.queue_frames = std::max(options_.queue_frames, 1u);
    options_.max_in_flight = std::clamp(options_.max_in_flight, 1u, kMostInFlight);
    queue_.resize(options_.queue_frames * frame_bytes_);
    flights_.reserve(kMostInFlight + 1);
    session_->follow_clock(kClockEvery_ns);
}

Status FrameStream::offer(std::span<const std::byte> frame) {
    if (session_->state() == SessionState::Failed) return Status::Closed;
    if (frame.size() != frame_bytes_) return Status::InvalidArgument;
    if (!has_room() && options_.policy == DropPolicy::Wait) return Status::WouldBlock;
    ++counts_.offered;
    if (!has_room()) {
        ++counts_.dropped;
        if (options_.policy == DropPolicy::DropNewest) return Status::Ok;
        first_ = (first_ + 1) % options_.queue_frames;
        --waiting_;
    }
    const std::size_t place = (first_ + waiting_) % options_.queue_frames;
    std::copy(frame.begin(), frame.end(), queue_.begin() + static_cast<std::ptrdiff_t>(place * frame_bytes_));
    ++waiting_;
    return Status::Ok;
}

Status FrameStream::poll(std::uint64_t now_ns) {
    now_ns_ = now_ns;
    const Status moved = session_->poll(now_ns);
    notice_another_session();
    notice_delivery();
    collect_fates();
    if (session_->state() == SessionState::Failed) return moved;
    return send_next() ? Status::Ok : moved;
}

bool FrameStream::idle() const {
    return waiting_ == 0 && flights_.empty() && (session_->two_way() || session_->idle());
}

// What became of the frames that were sent ------------------------------------------------------------------------

/// Its clock may be another one, and what was asked for by the clock before is not kept.
void FrameStream::notice_another_session() {
    if (session_->statistics().hellos == hellos_) return;
    hellos_ = session_->statistics().hellos;
    boundaries_.forget();
    finding_boundary_ = delivering_ = false;
    last_presented_ns_ = 0;
    for (Flight& flight : flights_) flight.boundary_ns = 0;
}

void FrameStream::notice_delivery() {
    if (!delivering_ || session_->statistics().frames_accepted == accepted_before_) return;
    delivering_ = false;
    deliveries_ns_[oldest_delivery_] = now_ns_ - submitted_ns_;
    oldest_delivery_ = (oldest_delivery_ + 1) % deliveries_ns_.size();
}

void FrameStream::collect_fates() {
    FrameFate fate;
    while (session_->next_fate(fate)) {
        const auto flight = std::find_if(flights_.begin(), flights_.end(),
                                         [&](const Flight& sent) { return sent.frame == fate.frame; });
        if (flight == flights_.end()) continue;
        const std::uint64_t boundary_ns = flight->boundary_ns;
        flights_.erase(flight);
        if (boundary_ns == 0) finding_boundary_ = false;
        if (fate.presented) {
            note_presented(boundary_ns, fate.device_time_ns);
        } else {
            ++counts_.given_up;
        }
    }
}

/// `boundary_ns` is the one asked for, or 0; `presented_ns` the one that it was, or 0 where nobody said.
void FrameStream::note_presented(std::uint64_t boundary_ns, std::uint64_t presented_ns) {
    ++counts_.presented;
    // Nothing was shown in the future: what a device says is not trusted with the schedule.
    const std::uint64_t latest_ns = device_time_ns() + session_->clock().error_ns_at(now_ns_) + kClockSlack_ns;
    if (presented_ns > latest_ns) presented_ns = 0;
    const std::uint64_t before_ns = last_presented_ns_;
    last_presented_ns_ = presented_ns;
    if (presented_ns == 0) return;
    if (!boundaries_.known()) last_.begin_ns = last_.boundary_ns = presented_ns;
    boundaries_.observe(presented_ns);
    if (before_ns != 0 && presented_ns > before_ns) {
        ++intervals_;
        intervals_sum_ns_ += presented_ns - before_ns;
        counts_.worst_interval_ns = std::max(counts_.worst_interval_ns, presented_ns - before_ns);
    }
    if (boundary_ns == 0) return;
    const std::uint64_t lateness_ns = presented_ns > boundary_ns ? presented_ns - boundary_ns : 0;
    lateness_ns_.add(lateness_ns);
    counts_.lateness_max_ns = std::max(counts_.lateness_max_ns, lateness_ns);
    if (lateness_ns > half_cycle_ns()) ++counts_.late;
}

StreamStatistics FrameStream::statistics() const {
    StreamStatistics statistics = counts_;
    statistics.lateness_p50_ns = lateness_ns_.quantile(0.50);
    statistics.lateness_p99_ns = lateness_ns_.quantile(0.99);
    if (intervals_ > 0) {
        statistics.rate_hz = 1e9 * static_cast<double>(intervals_) / static_cast<double>(intervals_sum_ns_);
    }
    return statistics;
}

// What is sent when -----------------------------------------------------------------------------------------------

bool FrameStream::send_next() {
    if (waiting_ == 0) return false;
    if (!session_->two_way()) return hand_over(0, 0);
    if (session_->state() != SessionState::Ready) return false;
    if (flights_.size() >= options_.max_in_flight) return false;
    if (!boundaries_.known()) {
        if (finding_boundary_ || !hand_over(0, 0)) return false;
        finding_boundary_ = true;
        ++next_index_;
        return true;
    }
    const std::uint64_t arrival_ns = device_time_ns() + delivery_ns();
    const Slot slot = slot_not_before(arrival_ns);
    const std::uint64_t present_at_ns = slot.boundary_ns - half_cycle_ns();
    const bool device_waits = (session_->device().features & wire::kFeaturePresentAt) != 0;
    if (!device_waits && arrival_ns < present_at_ns) return false;
    if (!hand_over(present_at_ns, slot.boundary_ns)) return false;
    counts_.slots_missed += slot.index - next_index_;
    next_index_ = slot.index + 1;
    last_ = slot;
    return true;
}

/// The frame that waits longest goes to the session, if it takes one.
bool FrameStream::hand_over(std::uint64_t present_at_ns, std::uint64_t boundary_ns) {
    const auto frame = std::span<const std::byte>(queue_).subspan(first_ * frame_bytes_, frame_bytes_);
    if (session_->submit(frame, present_at_ns) != Status::Ok) return false;
    first_ = (first_ + 1) % options_.queue_frames;
    --waiting_;
    ++counts_.sent;
    if (!session_->two_way()) return true;
    flights_.push_back({session_->statistics().frames_submitted, boundary_ns});
    delivering_ = true;
    submitted_ns_ = now_ns_;
    accepted_before_ = session_->statistics().frames_accepted;
    return true;
}

/// The next slot whose boundary is not before `earliest_ns`.
FrameStream::Slot FrameStream::slot_not_before(std::uint64_t earliest_ns) const {
    const std::uint64_t period = period_ns();
    Slot slot{next_index_, last_.begin_ns + period, 0};
    if (slot.begin_ns < earliest_ns) {
        const std::uint64_t passed = (earliest_ns - slot.begin_ns + period - 1) / period;
        slot.index += passed;
        slot.begin_ns += passed * period;
    }
    slot.boundary_ns = boundaries_.nearest(slot.begin_ns);
    const std::uint64_t earliest_boundary_ns = std::max(last_.boundary_ns + half_cycle_ns(), earliest_ns);
    while (slot.boundary_ns < earliest_boundary_ns) {
        slot.boundary_ns = boundaries_.nearest(slot.boundary_ns + 2 * half_cycle_ns());
    }
    // The display runs at its own speed: slots of whole cycles go along with it.
    if (cycles_of_period() > 0.0) slot.begin_ns = slot.boundary_ns;
    return slot;
}

std::uint64_t FrameStream::next_slot() const {
    std::uint64_t next = next_index_;
    if (boundaries_.known()) next = slot_not_before(device_time_ns() + delivery_ns()).index;
    return next + waiting_;
}

std::uint64_t FrameStream::device_time_ns() const {
    return session_->clock().device_time_at(now_ns_);
}

/// How long the next frame will take until it is accepted: as the slowest but one of the last, because a frame that
/// had to be sent again tells nothing.
std::uint64_t FrameStream::delivery_ns() const {
    auto slowest_first = deliveries_ns_;
    std::nth_element(slowest_first.begin(), slowest_first.begin() + 1, slowest_first.end(), std::greater<>());
    return slowest_first[1];
}

std::uint64_t FrameStream::period_ns() const {
    const double cycles = cycles_of_period();
    return cycles > 0.0 ? static_cast<std::uint64_t>(cycles * boundaries_.cycle_ns() + 0.5) : options_.period_ns;
}

/// 0: the period is not a whole number of cycles.
double FrameStream::cycles_of_period() const {
    constexpr double kTolerance = 0.02;
    const double cycles = static_cast<double>(options_.period_ns) / boundaries_.cycle_ns();
    const double whole = std::max(std::round(cycles), 1.0);
    return cycles - whole <= kTolerance * whole && (whole == 1.0 || whole - cycles <= kTolerance * whole) ? whole : 0.0;
}

std::uint64_t FrameStream::half_cycle_ns() const {
    return static_cast<std::uint64_t>(boundaries_.cycle_ns() / 2.0);
}

}  // namespace xorvox::host
