// ClockOffset: the device's clock, as the host's tells it.
//
// A question that the device answers with its time bounds the difference between the clocks:
//
//   host      sent ──┐        ┌──► received          device − received  ≤  offset  ≤  device − sent
//   device           └► device┘
//
// whatever each way took. What is kept is the range in which all answers agree, widened by as much as the clocks may
// have drifted apart since; so one quick answer counts for longer than many slow ones.
#pragma once

#include <cstdint>

namespace xorvox::host {

class ClockOffset {
public:
    /// By how much the clocks may run apart: two crystals of 100 ppm each. Where they run apart faster, as with a
    /// device that runs on an RC oscillator, answers contradict each other sooner or later, and the estimate begins
    /// anew; it is then off by at most about one round trip.
    static constexpr std::uint64_t kDriftPpm = 200;

    /// The device said `device_ns` to a question sent at `sent_ns`, not after `received_ns`, of the host's clock. An
    /// answer that contradicts those before makes them void: one of the clocks was set. Times more than 146 years
    /// apart are ignored.
    void observe(std::uint64_t sent_ns, std::uint64_t received_ns, std::uint64_t device_ns);
    /// Another device, or the same one after a reset.
    void forget() { valid_ = false; }

    /// False until the first answer; then device_time_at() and error_ns_at() mean something.
    bool valid() const { return valid_; }
    /// The device's clock at this time of the host's; 0 if it had not begun to run.
    std::uint64_t device_time_at(std::uint64_t host_ns) const;
    /// By how much device_time_at() may be wrong, either way, at a time not before the last answer: at most half of the
    /// quickest round trip, and the drift since.
    std::uint64_t error_ns_at(std::uint64_t host_ns) const;

private:
    bool valid_ = false;
    std::int64_t lowest_ns_ = 0;  ///< Device minus host.
    std::int64_t highest_ns_ = 0;
    std::uint64_t at_ns_ = 0;  ///< Host's clock: when these held.
};

}  // namespace xorvox::host
