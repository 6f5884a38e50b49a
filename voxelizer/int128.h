// Int128: the few operations on 128-bit integers that the voxelizer needs where a triangle is too large for 64 bits.
//
// The compiler's own type where there is one, else two limbs: microcontrollers have none. Freestanding.
#pragma once

#include <cstdint>

namespace xorvox {

/// A signed 128-bit integer, hi·2^64 + lo in two's complement. Results that do not fit wrap around.
struct TwoLimbs {
    std::uint64_t lo = 0;
    std::int64_t hi = 0;

    friend constexpr bool operator==(const TwoLimbs&, const TwoLimbs&) = default;

    friend constexpr TwoLimbs operator+(TwoLimbs a, TwoLimbs b) {
        const std::uint64_t low = a.lo + b.lo;
        const std::uint64_t carry = low < a.lo ? 1 : 0;
        return {low,
                static_cast<std::int64_t>(static_cast<std::uint64_t>(a.hi) + static_cast<std::uint64_t>(b.hi) + carry)};
    }
    friend constexpr TwoLimbs operator-(TwoLimbs a) {
        const std::uint64_t low = ~a.lo + 1;
        return {low, static_cast<std::int64_t>(~static_cast<std::uint64_t>(a.hi) + (low == 0 ? 1 : 0))};
    }
};

constexpr TwoLimbs operator-(TwoLimbs a, TwoLimbs b) {
    return a + -b;
}
constexpr bool is_negative(TwoLimbs a) {
    return a.hi < 0;
}
/// The largest integer not above a / 2^shift; 0 < shift < 64.
constexpr TwoLimbs floor_shift(TwoLimbs a, std::uint32_t shift) {
    return {a.lo >> shift | static_cast<std::uint64_t>(a.hi) << (64 - shift), a.hi >> shift};
}
/// `a`, which must lie within 63 bits and a sign.
constexpr std::int64_t narrow(TwoLimbs a) {
    return static_cast<std::int64_t>(a.lo);
}
/// `a` to within one part in 2^51.
constexpr double to_double(TwoLimbs a) {
    // By its size: near zero the limbs of a negative number cancel.
    const TwoLimbs size = is_negative(a) ? -a : a;
    const double value =
        static_cast<double>(static_cast<std::uint64_t>(size.hi)) * 0x1p64 + static_cast<double>(size.lo);
    return is_negative(a) ? -value : value;
}

namespace detail {

constexpr std::uint64_t magnitude(std::int64_t a) {
    return a < 0 ? ~static_cast<std::uint64_t>(a) + 1 : static_cast<std::uint64_t>(a);
}

constexpr TwoLimbs multiply_unsigned(std::uint64_t a, std::uint64_t b) {
    constexpr std::uint64_t kLow = 0xffffffff;
    const std::uint64_t low = (a & kLow) * (b & kLow);
    const std::uint64_t middle = (a >> 32) * (b & kLow) + (low >> 32);
    const std::uint64_t other_middle = (a & kLow) * (b >> 32) + (middle & kLow);
    const std::uint64_t high = (a >> 32) * (b >> 32) + (middle >> 32) + (other_middle >> 32);
    return {other_middle << 32 | (low & kLow), static_cast<std::int64_t>(high)};
}

}  // namespace detail

/// a · b, exactly.
constexpr TwoLimbs multiply_two_limbs(std::int64_t a, std::int64_t b) {
    const TwoLimbs product = detail::multiply_unsigned(detail::magnitude(a), detail::magnitude(b));
    return (a < 0) != (b < 0) ? -product : product;
}

/// The largest integer not above n / d; d > 0, and the result must fit in 63 bits and a sign.
constexpr std::int64_t floor_divide(TwoLimbs n, std::int64_t d) {
    const bool negative = n.hi < 0;
    const TwoLimbs size = negative ? -n : n;
    const auto divisor = static_cast<std::uint64_t>(d);
    std::uint64_t remainder = 0;
    std::uint64_t quotient = 0;
    for (int bit = 127; bit >= 0; --bit) {
        const std::uint64_t limb = bit >= 64 ? static_cast<std::uint64_t>(size.hi) : size.lo;
        remainder = remainder << 1 | (limb >> (bit % 64) & 1);
        quotient <<= 1;
        if (remainder >= divisor) {
            remainder -= divisor;
            quotient |= 1;
        }
    }
    if (!negative) return static_cast<std::int64_t>(quotient);
    return static_cast<std::int64_t>(~quotient + (remainder == 0 ? 1 : 0));
}

/// The largest integer not above n / d; d > 0.
constexpr std::int64_t floor_divide(std::int64_t n, std::int64_t d) {
    const std::int64_t quotient = n / d;
    return n % d < 0 ? quotient - 1 : quotient;
}

#ifdef __SIZEOF_INT128__

__extension__ typedef __int128 Int128;

constexpr Int128 multiply(std::int64_t a, std::int64_t b) {
    return Int128{a} * b;
}
constexpr bool is_negative(Int128 a) {
    return a < 0;
}
constexpr Int128 floor_shift(Int128 a, std::uint32_t shift) {
    return a >> shift;
}
constexpr std::int64_t narrow(Int128 a) {
    return static_cast<std::int64_t>(a);
}
constexpr double to_double(Int128 a) {
    return static_cast<double>(a);
}
constexpr std::int64_t floor_divide(Int128 n, std::int64_t d) {
    const Int128 quotient = n / d;
    return static_cast<std::int64_t>(n % d < 0 ? quotient - 1 : quotient);
}

#else

using Int128 = TwoLimbs;

constexpr Int128 multiply(std::int64_t a, std::int64_t b) {
    return multiply_two_limbs(a, b);
}

#endif

}  // namespace xorvox
