#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "tests/catch.h"
#include "voxelizer/elementary.h"

namespace elementary = xorvox::elementary;

namespace {

constexpr int kCount = 200000;
const double kInfinity = std::numeric_limits<double>::infinity();

/// How far a is from b, a share of b.
double relative(double a, double b) {
    return a == b ? 0.0 : std::abs(a - b) / std::abs(b);
}

}  // namespace

TEST_CASE("exp is as close to e^x as a double can tell") {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> any(-699.0, 708.9);
    double worst = 0.0;
    for (int i = 0; i < kCount; ++i) {
        const double x = any(random);
        worst = std::max(worst, relative(elementary::exp(x), std::exp(x)));
    }
    CHECK(worst < 1e-15);
    CHECK(elementary::exp(0.0) == 1.0);
    CHECK(elementary::exp(710.0) == kInfinity);
    CHECK(elementary::exp(kInfinity) == kInfinity);
    CHECK(elementary::exp(-kInfinity) == 0.0);
    CHECK(std::isnan(elementary::exp(elementary::kNan)));
}

TEST_CASE("log is as close to the logarithm as a double can tell") {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> exponent(-700.0, 700.0);
    std::uniform_real_distribution<double> around_one(0.5, 2.0);
    double worst = 0.0;
    for (int i = 0; i < kCount; ++i) {
        const double x = i % 2 == 0 ? std::exp(exponent(random)) : around_one(random);
        worst = std::max(worst, relative(elementary::log(x), std::log(x)));
    }
    CHECK(worst < 1e-15);
    CHECK(elementary::log(1.0) == 0.0);
    CHECK(elementary::log(0.0) == -kInfinity);
    CHECK(elementary::log(kInfinity) == kInfinity);
    CHECK(std::isnan(elementary::log(-1.0)));
    CHECK(std::isnan(elementary::log(elementary::kNan)));
}

TEST_CASE("sin and cos are right to fifteen decimals within their range") {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> near(-10.0, 10.0);
    std::uniform_real_distribution<double> far(-0x1p20, 0x1p20);
    double worst = 0.0;
    for (int i = 0; i < kCount; ++i) {
        const double x = i % 2 == 0 ? near(random) : far(random);
        worst = std::max(worst, std::abs(elementary::sin(x) - std::sin(x)));
        worst = std::max(worst, std::abs(elementary::cos(x) - std::cos(x)));
    }
    CHECK(worst < 1e-15);
    CHECK(elementary::sin(0.0) == 0.0);
    CHECK(elementary::cos(0.0) == 1.0);
    for (const double x : {0x1.00001p20, -1e300, kInfinity, elementary::kNan}) {
        CHECK(std::isnan(elementary::sin(x)));
        CHECK(std::isnan(elementary::cos(x)));
    }
}

TEST_CASE("atan2 is the angle to fifteen decimals, all around") {
    std::mt19937 random(6);
    std::uniform_real_distribution<double> exponent(-30.0, 30.0);
    std::uniform_real_distribution<double> near(-1.0, 1.0);
    double worst = 0.0;
    for (int i = 0; i < kCount; ++i) {
        const double x = i % 2 == 0 ? near(random) : std::exp(exponent(random)) * (near(random) < 0.0 ? -1.0 : 1.0);
        const double y = i % 2 == 0 ? near(random) : std::exp(exponent(random)) * (near(random) < 0.0 ? -1.0 : 1.0);
        worst = std::max(worst, std::abs(elementary::atan2(y, x) - std::atan2(y, x)));
    }
    CHECK(worst < 1e-15);
    CHECK(elementary::atan2(0.0, 0.0) == 0.0);
    CHECK(elementary::atan2(0.0, 2.0) == 0.0);
    for (const auto& [y, x] :
         {std::pair{0.0, -1.0}, {1.0, 0.0}, {-1.0, 0.0}, {1.0, 1.0}, {-3.0, 3.0}, {1e-300, -1e300}}) {
        CHECK(elementary::atan2(y, x) == std::atan2(y, x));
    }
}

TEST_CASE("pow follows the C library, negative bases and whole exponents too") {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> base(-20.0, 20.0);
    std::uniform_real_distribution<double> exponent(-30.0, 30.0);
    double worst = 0.0;
    for (int i = 0; i < kCount; ++i) {
        const double a = base(random);
        const double b = a < 0.0 ? std::round(exponent(random)) : exponent(random);
        const double expected = std::pow(a, b);
        worst =
            std::max(worst, relative(elementary::pow(a, b), expected) / (1.0 + std::abs(std::log(std::abs(expected)))));
    }
    CHECK(worst < 1e-15);
    for (const double a : {0.0, -3.0, kInfinity, elementary::kNan}) CHECK(elementary::pow(a, 0.0) == 1.0);
    CHECK(elementary::pow(0.0, 2.0) == 0.0);
    CHECK(elementary::pow(0.0, -2.0) == kInfinity);
    CHECK(elementary::pow(-2.0, 1e300) == kInfinity);
    CHECK(std::isnan(elementary::pow(-2.0, 0.5)));
}

TEST_CASE("floor is the greatest whole number that is not above") {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> any(-1e7f, 1e7f);
    for (int i = 0; i < kCount; ++i) {
        const float x = any(random);
        REQUIRE(elementary::floor(x) == std::floor(x));
    }
    for (const float x :
         {0.0f, 0.5f, -0.5f, -1.0f, -1e-30f, 0x1.fffffep22f, -0x1.fffffep22f, 0x1p23f, -0x1p23f, 3e38f, -3e38f})
        CHECK(elementary::floor(x) == std::floor(x));
    CHECK(std::isinf(elementary::floor(static_cast<float>(kInfinity))));
    CHECK(std::isnan(elementary::floor(static_cast<float>(elementary::kNan))));
}

TEST_CASE("sRGB becomes linear light to six digits") {
    for (int i = 0; i <= 100000; ++i) {
        const float encoded = static_cast<float>(i) / 100000.0f;
        const double c{encoded};
        const double expected = encoded <= 0.04045f ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
        REQUIRE(relative(double{elementary::linear_from_srgb(encoded)}, expected) < 1e-6);
    }
    CHECK(elementary::linear_from_srgb(0.0f) == 0.0f);
    CHECK(elementary::linear_from_srgb(1.0f) == 1.0f);
}

TEST_CASE("a double too large for a float becomes infinite") {
    const float infinity = std::numeric_limits<float>::infinity();
    CHECK(elementary::narrow(0.1) == 0.1f);
    CHECK(elementary::narrow(1e39) == infinity);
    CHECK(elementary::narrow(-1e39) == -infinity);
    CHECK(elementary::narrow(kInfinity) == infinity);
    CHECK(std::isnan(elementary::narrow(elementary::kNan)));
}
