// Elementary functions with the same bits on every machine, unlike those of the C library: only + - × ÷ and moves of
// bits, no tables, no branches, so that a loop over them can run in vectors.
//
// Relative errors are below 1e-15, but where a function's doc says otherwise; tests compare them with the C library.
// Compile with -ffp-contract=off.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>

namespace xorvox::elementary {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Added to a number below 2^51, it leaves the nearest whole number in the low bits.
inline constexpr double kRounder = 0x1.8p52;

/// The greatest whole number that is not above x. Infinities and NaN stay.
inline float floor(float x) {
    constexpr float kWhole = 0x1p23f;  // from here on every float is whole
    const float clipped = x > -kWhole ? (x < kWhole ? x : kWhole) : -kWhole;
    const float truncated = static_cast<float>(static_cast<std::int32_t>(clipped));
    const float below = truncated > clipped ? truncated - 1.0f : truncated;
    return clipped == x ? below : x;
}

/// e^x; 0 below -700, infinite above 709.
inline double exp(double x) {
    const double clipped = x > -700.0 ? (x < 709.0 ? x : 709.0) : -700.0;
    const double shifted = clipped * 0x1.71547652b82fep0 + kRounder;  // log2(e)
    const double n = shifted - kRounder;
    const double r = (clipped - n * 0x1.62e42feep-1) - n * 0x1.a39ef35793c76p-33;  // ln 2 in two parts
    // Taylor's series; |r| is at most ln(2) / 2.
    double sum = 1.0 / 6227020800.0;
    sum = sum * r + 1.0 / 479001600.0;
    sum = sum * r + 1.0 / 39916800.0;
    sum = sum * r + 1.0 / 3628800.0;
    sum = sum * r + 1.0 / 362880.0;
    sum = sum * r + 1.0 / 40320.0;
    sum = sum * r + 1.0 / 5040.0;
    sum = sum * r + 1.0 / 720.0;
    sum = sum * r + 1.0 / 120.0;
    sum = sum * r + 1.0 / 24.0;
    sum = sum * r + 1.0 / 6.0;
    sum = sum * r + 0.5;
    sum = sum * r + 1.0;
    sum = sum * r + 1.0;
    // n is -1010 … 1023: a normal power of two.
    const std::uint64_t power = (std::bit_cast<std::uint64_t>(shifted) + 1023) << 52;
    const double value = sum * std::bit_cast<double>(power);
    const double bounded = x > 709.0 ? kInfinity : (x < -700.0 ? 0.0 : value);
    return x == x ? bounded : x;
}

/// The natural logarithm; -infinity at 0, NaN below. x is no subnormal number.
inline double log(double x) {
    const std::uint64_t bits = std::bit_cast<std::uint64_t>(x);
    // x = m 2^e with m in √½ … √2: from the bits of √½ on, e counts one more.
    constexpr std::uint64_t kRootOfHalf = 0x3fe6a09e667f3bcd;
    const std::uint64_t above = bits - kRootOfHalf;
    const auto e = static_cast<double>(static_cast<std::int32_t>(static_cast<std::int64_t>(above) >> 52));
    const double m = std::bit_cast<double>((above & 0x000fffffffffffff) + kRootOfHalf);
    const double s = (m - 1.0) / (m + 1.0);  // at most 0.1716 either way
    const double q = s * s;
    // log m = 2 atanh s
    double sum = 1.0 / 21.0;
    sum = sum * q + 1.0 / 19.0;
    sum = sum * q + 1.0 / 17.0;
    sum = sum * q + 1.0 / 15.0;
    sum = sum * q + 1.0 / 13.0;
    sum = sum * q + 1.0 / 11.0;
    sum = sum * q + 1.0 / 9.0;
    sum = sum * q + 1.0 / 7.0;
    sum = sum * q + 1.0 / 5.0;
    sum = sum * q + 1.0 / 3.0;
    const double value = e * 0x1.62e42feep-1 + (2.0 * s + (2.0 * s * q * sum + e * 0x1.a39ef35793c76p-33));
    const double bounded = x == 0.0 ? -kInfinity : (x == kInfinity ? x : value);
    return x >= 0.0 ? bounded : kNan;
}

/// The sine of x + quarters · π/2, for x within ±2^20, else NaN. Absolute error below 1e-15.
inline double sine(double x, std::uint64_t quarters) {
    const bool is_small = x >= -0x1p20 && x <= 0x1p20;
    const double clipped = is_small ? x : 0.0;
    const double shifted = clipped * 0x1.45f306dc9c883p-1 + kRounder;  // 2 / π
    const double n = shifted - kRounder;
    // π/2 in three parts, the first two of 33 bits: their products with n are exact.
    const double r = ((clipped - n * 0x1.921fb544p0) - n * 0x1.0b4611a6p-34) - n * 0x1.3198a2e037073p-69;
    const double q = r * r;
    double odd = 1.0 / 355687428096000.0;
    odd = odd * q - 1.0 / 1307674368000.0;
    odd = odd * q + 1.0 / 6227020800.0;
    odd = odd * q - 1.0 / 39916800.0;
    odd = odd * q + 1.0 / 362880.0;
    odd = odd * q - 1.0 / 5040.0;
    odd = odd * q + 1.0 / 120.0;
    odd = odd * q - 1.0 / 6.0;
    odd = odd * q * r + r;
    double even = 1.0 / 20922789888000.0;
    even = even * q - 1.0 / 87178291200.0;
    even = even * q + 1.0 / 479001600.0;
    even = even * q - 1.0 / 3628800.0;
    even = even * q + 1.0 / 40320.0;
    even = even * q - 1.0 / 720.0;
    even = even * q + 1.0 / 24.0;
    even = even * q - 0.5;
    even = even * q + 1.0;
    const std::uint64_t quarter = std::bit_cast<std::uint64_t>(shifted) + quarters;
    const double value = (quarter & 1) != 0 ? even : odd;
    const double turned = (quarter & 2) != 0 ? -value : value;
    return is_small ? turned : kNan;
}

inline double sin(double x) {
    return sine(x, 0);
}

inline double cos(double x) {
    return sine(x, 1);
}

/// The angle of (x, y) from the x axis, -π to π; 0 for (0, 0). x and y finite. Absolute error below 1e-15.
inline double atan2(double y, double x) {
    const double width = x < 0.0 ? -x : x;
    const double height = y < 0.0 ? -y : y;
    const bool is_steep = height > width;
    const double less = is_steep ? width : height;
    const double more = is_steep ? height : width;
    // An angle of up to π/4, or up to π/8 either way of it.
    const double slope = more > 0.0 ? less / more : 0.0;
    const bool is_turned = slope > 0x1.a827999fcef32p-2;  // tan(π/8)
    const double t = is_turned ? (slope - 1.0) / (slope + 1.0) : slope;
    const double q = t * t;
    double sum = 1.0 / 39.0;
    sum = 1.0 / 37.0 - sum * q;
    sum = 1.0 / 35.0 - sum * q;
    sum = 1.0 / 33.0 - sum * q;
    sum = 1.0 / 31.0 - sum * q;
    sum = 1.0 / 29.0 - sum * q;
    sum = 1.0 / 27.0 - sum * q;
    sum = 1.0 / 25.0 - sum * q;
    sum = 1.0 / 23.0 - sum * q;
    sum = 1.0 / 21.0 - sum * q;
    sum = 1.0 / 19.0 - sum * q;
    sum = 1.0 / 17.0 - sum * q;
    sum = 1.0 / 15.0 - sum * q;
    sum = 1.0 / 13.0 - sum * q;
    sum = 1.0 / 11.0 - sum * q;
    sum = 1.0 / 9.0 - sum * q;
    sum = 1.0 / 7.0 - sum * q;
    sum = 1.0 / 5.0 - sum * q;
    sum = 1.0 / 3.0 - sum * q;
    const double part = t - t * q * sum;
    constexpr double kPi = 0x1.921fb54442d18p1;
    const double eighth = is_turned ? kPi / 4.0 + part : part;
    const double quarter = is_steep ? kPi / 2.0 - eighth : eighth;
    const double half = x < 0.0 ? kPi - quarter : quarter;
    return y < 0.0 ? -half : half;
}

/// a^b; of a negative a for whole b only, else NaN. a^0 is 1. Relative error below 1e-15 times (1 + |b log a|).
inline double pow(double a, double b) {
    const double size = exp(b * log(a < 0.0 ? -a : a));
    const double clipped = b > -0x1p51 ? (b < 0x1p51 ? b : 0x1p51) : -0x1p51;
    const double half = clipped * 0.5;
    const bool is_whole = (clipped + kRounder) - kRounder == clipped;
    const bool is_even = (half + kRounder) - kRounder == half;
    const double signed_size = is_even ? size : (is_whole ? -size : kNan);
    const double value = a < 0.0 ? signed_size : size;
    return b == 0.0 ? 1.0 : value;
}

/// Linear light of an sRGB value (IEC 61966-2-1), 0 … 1. Relative error below 1e-6.
inline float linear_from_srgb(float encoded) {
    const float base = (encoded + 0.055f) / 1.055f;
    // Newton's method for the fifth root, from a parabola that is within 4 % of it.
    float root = 0.5395f + base * (0.9144f - base * 0.4539f);
    for (int i = 0; i < 3; ++i) {
        const float square = root * root;
        root = 0.8f * root + 0.2f * base / (square * square);
    }
    const float curve = base * base * (root * root);  // base^2.4
    return encoded <= 0.04045f ? encoded / 12.92f : curve;
}

/// As a float; infinite where it is too large for one.
inline float narrow(double x) {
    constexpr double kMost = std::numeric_limits<float>::max();
    const float inside = static_cast<float>(x > -kMost ? (x < kMost ? x : kMost) : -kMost);
    const float infinity = std::numeric_limits<float>::infinity();
    const float bounded = x > kMost ? infinity : (x < -kMost ? -infinity : inside);
    return x == x ? bounded : std::numeric_limits<float>::quiet_NaN();
}

}  // namespace xorvox::elementary
