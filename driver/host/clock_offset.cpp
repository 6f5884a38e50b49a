#include "driver/host/clock_offset.h"

#include <algorithm>

namespace xorvox::host {
namespace {

std::int64_t drift_ns(std::uint64_t since_ns, std::uint64_t now_ns) {
    if (now_ns <= since_ns) return 0;
    return static_cast<std::int64_t>((now_ns - since_ns) / (1'000'000 / ClockOffset::kDriftPpm) + 1);
}

/// 146 years: far from where sums of offsets and drifts would overflow.
constexpr std::int64_t kLimit_ns = std::int64_t{1} << 62;

bool is_sane(std::int64_t offset_ns) {
    return offset_ns > -kLimit_ns && offset_ns < kLimit_ns;
}

}  // namespace

void ClockOffset::observe(std::uint64_t sent_ns, std::uint64_t received_ns, std::uint64_t device_ns) {
    if (sent_ns > received_ns || received_ns - sent_ns >= static_cast<std::uint64_t>(kLimit_ns)) return;
    const auto lowest = static_cast<std::int64_t>(device_ns - received_ns);
    const auto highest = static_cast<std::int64_t>(device_ns - sent_ns);
    if (!is_sane(lowest) || !is_sane(highest)) return;
    const std::int64_t drift = drift_ns(at_ns_, received_ns);
    lowest_ns_ = std::max(lowest_ns_ - drift, lowest);
    highest_ns_ = std::min(highest_ns_ + drift, highest);
    if (!valid_ || lowest_ns_ > highest_ns_) {
        lowest_ns_ = lowest;
        highest_ns_ = highest;
    }
    at_ns_ = received_ns;
    valid_ = true;
}

std::uint64_t ClockOffset::device_time_at(std::uint64_t host_ns) const {
    const std::int64_t offset = lowest_ns_ + (highest_ns_ - lowest_ns_) / 2;
    if (offset < 0 && host_ns < static_cast<std::uint64_t>(-offset)) return 0;
    return host_ns + static_cast<std::uint64_t>(offset);
}

std::uint64_t ClockOffset::error_ns_at(std::uint64_t host_ns) const {
    return static_cast<std::uint64_t>((highest_ns_ - lowest_ns_ + 1) / 2 + drift_ns(at_ns_, host_ns));
}

}  // namespace xorvox::host
