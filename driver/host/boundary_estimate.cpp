#include "driver/host/boundary_estimate.h"

#include <algorithm>
#include <cmath>

namespace xorvox::host {
namespace {

double between_ns(std::uint64_t from, std::uint64_t to) {
    return static_cast<double>(static_cast<std::int64_t>(to - from));
}

}  // namespace

void BoundaryEstimate::observe(std::uint64_t boundary_ns) {
    const double gap_ns = known_ ? between_ns(last_ns_, boundary_ns) : 0.0;
    const double cycles = std::round(gap_ns / cycle_ns_);
    // Over more cycles, nobody knows how many they were.
    constexpr double kMostCycles = 8.0;
    if (cycles >= 1.0 && cycles <= kMostCycles) {
        constexpr double kGain = 0.25;  // a rotor does not turn evenly
        cycle_ns_ += kGain * (gap_ns / cycles - cycle_ns_);
        cycle_ns_ = std::clamp(cycle_ns_, 0.8 * nominal_ns_, 1.25 * nominal_ns_);
    }
    last_ns_ = boundary_ns;
    known_ = true;
}

std::uint64_t BoundaryEstimate::nearest(std::uint64_t device_ns) const {
    const double cycles = std::round(between_ns(last_ns_, device_ns) / cycle_ns_);
    return last_ns_ + static_cast<std::uint64_t>(std::llround(cycles * cycle_ns_));
}

}  // namespace xorvox::host
