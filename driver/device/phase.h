// Phase: where a display is in its cycles, and the line that gives it at any time.
//
// Cycles are counted in units of 2^-32 in 64 bits: the upper half is the number of the cycle, the lower half the part
// of it that has passed. It wraps after 2^32 cycles, so phases are compared by their difference. Integers only.
#pragma once

#include <bit>
#include <cstdint>

namespace xorvox::device {

using Phase = std::uint64_t;
inline constexpr Phase kCycle = Phase{1} << 32;

/// Number of the cycle that `phase` lies in.
constexpr std::uint32_t cycle_of(Phase phase) {
    return static_cast<std::uint32_t>(phase >> 32);
}
/// `to` − `from`, of phases less than 2^31 cycles apart.
constexpr std::int64_t phase_between(Phase from, Phase to) {
    return static_cast<std::int64_t>(to - from);
}

/// a·b / c, exactly, rounded down or up; c is not 0, and the result must fit into 64 bits. Two divisions where the
/// product fits into 64 bits, 128 steps where it does not.
constexpr std::uint64_t mul_div(std::uint64_t a, std::uint64_t b, std::uint64_t c, bool round_up = false) {
    if (std::bit_width(a) + std::bit_width(b) <= 64) {
        const std::uint64_t product = a * b;
        const std::uint64_t quotient = product / c;
        return quotient + (round_up && product - quotient * c != 0 ? 1 : 0);
    }
    constexpr std::uint64_t kLow = 0xffffffffu;
    const std::uint64_t low = (a & kLow) * (b & kLow);
    const std::uint64_t middle = (a >> 32) * (b & kLow) + (low >> 32);
    const std::uint64_t other = (a & kLow) * (b >> 32) + (middle & kLow);
    std::uint64_t high = (a >> 32) * (b >> 32) + (middle >> 32) + (other >> 32);
    std::uint64_t rest = other << 32 | (low & kLow);
    std::uint64_t quotient = 0;
    for (int bit = 0; bit < 64; ++bit) {
        const bool carry = high >> 63 != 0;
        high = high << 1 | rest >> 63;
        rest <<= 1;
        quotient <<= 1;
        if (carry || high >= c) {
            high -= c;
            quotient |= 1;
        }
    }
    return quotient + (round_up && high != 0 ? 1 : 0);
}

/// Phase against time: from `phase` at `from_ns` on it goes `first` a first interval, and `step` every further one. It
/// never runs backwards. interval_ns, first and step are not 0.
struct PhaseLine {
    std::uint64_t from_ns = 0;
    Phase phase = 0;
    std::uint64_t interval_ns = 1;
    std::uint64_t first = 1;
    std::uint64_t step = 1;

    /// Before from_ns: `phase`.
    constexpr Phase at(std::uint64_t now_ns) const {
        if (now_ns <= from_ns) return phase;
        const std::uint64_t elapsed = now_ns - from_ns;
        if (elapsed < interval_ns) return phase + mul_div(elapsed, first, interval_ns);
        const std::uint64_t whole = elapsed / interval_ns;
        return phase + first + (whole - 1) * step + mul_div(elapsed % interval_ns, step, interval_ns);
    }

    /// The first time at which at() has come to `to`; from_ns where it had before.
    constexpr std::uint64_t time_of(Phase to) const {
        const std::int64_t ahead = phase_between(phase, to);
        if (ahead <= 0) return from_ns;
        const auto distance = static_cast<std::uint64_t>(ahead);
        if (distance <= first) return from_ns + mul_div(distance, interval_ns, first, true);
        const std::uint64_t further = distance - first;
        return from_ns + (1 + further / step) * interval_ns + mul_div(further % step, interval_ns, step, true);
    }
};

}  // namespace xorvox::device
