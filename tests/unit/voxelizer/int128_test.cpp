#include "voxelizer/int128.h"

#include <cmath>
#include <limits>
#include <random>

#include "tests/catch.h"

using namespace xorvox;

#ifdef __SIZEOF_INT128__

namespace {

constexpr std::int64_t kMin = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();

TwoLimbs limbs(Int128 value) {
    return {static_cast<std::uint64_t>(value), static_cast<std::int64_t>(value >> 64)};
}

/// Numbers of all lengths, both signs, and the ends of ranges.
class Numbers {
public:
    std::int64_t operator()() {
        constexpr std::int64_t kSpecial[]{
            0, 1, -1, kMin, kMin + 1, kMax, std::int64_t{1} << 32, -(std::int64_t{1} << 32), 0xffffffff};
        if (random_() % 8 == 0) return kSpecial[random_() % std::size(kSpecial)];
        return static_cast<std::int64_t>(random_()) >> (random_() % 64);
    }

private:
    std::mt19937_64 random_{1};
};

}  // namespace

TEST_CASE("two-limb products, sums and negations equal the compiler's") {
    Numbers number;
    for (int i = 0; i < 200'000; ++i) {
        const std::int64_t a = number();
        const std::int64_t b = number();
        const std::int64_t c = number();
        const std::int64_t d = number();
        REQUIRE(multiply_two_limbs(a, b) == limbs(multiply(a, b)));
        REQUIRE(-multiply_two_limbs(a, b) == limbs(-multiply(a, b)));
        const Int128 sum = multiply(a, b) / 2 + multiply(c, d) / 2;
        REQUIRE(limbs(multiply(a, b) / 2) + limbs(multiply(c, d) / 2) == limbs(sum));
    }
}

TEST_CASE("two-limb differences, shifts and signs equal the compiler's") {
    Numbers number;
    for (int i = 0; i < 100'000; ++i) {
        const Int128 a = multiply(number(), number()) / 2;
        const Int128 b = multiply(number(), number()) / 2;
        REQUIRE(limbs(a) - limbs(b) == limbs(a - b));
        REQUIRE(is_negative(limbs(a)) == (a < 0));
        REQUIRE(is_negative(a) == (a < 0));
        for (const std::uint32_t shift : {1u, 8u, 20u, 63u}) {
            REQUIRE(floor_shift(limbs(a), shift) == limbs(a >> shift));
            REQUIRE(floor_shift(a, shift) == a >> shift);
        }
        const std::int64_t small = number();
        REQUIRE(narrow(limbs(small)) == small);
        REQUIRE(narrow(multiply(small, 1)) == small);
    }
}

TEST_CASE("two-limb numbers become doubles to within one part in 2^51") {
    Numbers number;
    for (int i = 0; i < 100'000; ++i) {
        const Int128 a = multiply(number(), number()) / (i % 2 == 0 ? 1 : number() | 1);
        const double exact = to_double(a);
        REQUIRE(std::abs(to_double(limbs(a)) - exact) <= std::abs(exact) * 0x1p-51);
    }
    CHECK(to_double(limbs(-1)) == -1.0);
    CHECK(to_double(limbs(0)) == 0.0);
}

TEST_CASE("two-limb division rounds down as the compiler's does") {
    Numbers number;
    for (int i = 0; i < 100'000; ++i) {
        const std::int64_t quotient = number() / 2;
        std::int64_t divisor = number();
        if (divisor <= 0) divisor = -(divisor + 1) + (divisor == kMin ? 0 : 1);
        if (divisor == 0) divisor = 1;
        const std::int64_t remainder =
            static_cast<std::int64_t>(static_cast<std::uint64_t>(number()) % static_cast<std::uint64_t>(divisor));
        const Int128 n = multiply(quotient, divisor) + remainder;
        REQUIRE(floor_divide(n, divisor) == quotient);
        REQUIRE(floor_divide(limbs(n), divisor) == quotient);
    }
}

TEST_CASE("64-bit division rounds down") {
    CHECK(floor_divide(std::int64_t{7}, 2) == 3);
    CHECK(floor_divide(std::int64_t{-7}, 2) == -4);
    CHECK(floor_divide(std::int64_t{-8}, 2) == -4);
    CHECK(floor_divide(std::int64_t{0}, 5) == 0);
    CHECK(floor_divide(kMin, 1) == kMin);
}

#endif
