#include "driver/host/color_space.h"

#include <algorithm>

namespace xorvox::host {
namespace {

/// The n-th root of a, 0 < a, by Newton's method from above, which falls until rounding stops it.
double root(double a, int n) {
    double x = std::max(a, 1.0);
    while (true) {
        double power = 1.0;
        for (int i = 1; i < n; ++i) power *= x;
        const double next = ((n - 1) * x + a / power) / n;
        if (!(next < x)) return x;
        x = next;
    }
}

double cube_root(double a) {
    return a > 0.0 ? root(a, 3) : 0.0;
}

// Oklab's matrices: B. Ottosson, "A perceptual color space for image processing", 2020.

glm::dvec3 oklab_from_linear(const glm::dvec3& c) {
    const double l = cube_root(0.4122214708 * c.r + 0.5363325363 * c.g + 0.0514459929 * c.b);
    const double m = cube_root(0.2119034982 * c.r + 0.6806995451 * c.g + 0.1073969566 * c.b);
    const double s = cube_root(0.0883024619 * c.r + 0.2817188376 * c.g + 0.6299787005 * c.b);
    return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
            1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
            0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

glm::dvec3 linear_from_oklab(const glm::dvec3& c) {
    const double l = c.x + 0.3963377774 * c.y + 0.2158037573 * c.z;
    const double m = c.x - 0.1055613458 * c.y - 0.0638541728 * c.z;
    const double s = c.x - 0.0894841775 * c.y - 1.2914855480 * c.z;
    const double lll = l * l * l;
    const double mmm = m * m * m;
    const double sss = s * s * s;
    return {4.0767416621 * lll - 3.3077115913 * mmm + 0.2309699292 * sss,
            -1.2684380046 * lll + 2.6097574011 * mmm - 0.3413193965 * sss,
            -0.0041960863 * lll - 0.7034186147 * mmm + 1.7076147010 * sss};
}

}  // namespace

double linear_from_srgb(std::uint8_t code) {
    const double encoded = code / 255.0;
    if (encoded <= 0.04045) return encoded / 12.92;
    const double base = (encoded + 0.055) / 1.055;
    const double square = base * base;
    return square * root(square, 5);  // base^2.4
}

glm::dvec3 linear_from_hex(std::uint32_t rrggbb) {
    return {linear_from_srgb(static_cast<std::uint8_t>(rrggbb >> 16)),
            linear_from_srgb(static_cast<std::uint8_t>(rrggbb >> 8)),
            linear_from_srgb(static_cast<std::uint8_t>(rrggbb))};
}

glm::dvec3 mix_oklab(const glm::dvec3& a, const glm::dvec3& b, double t) {
    const glm::dvec3 mixed = linear_from_oklab((1.0 - t) * oklab_from_linear(a) + t * oklab_from_linear(b));
    return {std::clamp(mixed.r, 0.0, 1.0), std::clamp(mixed.g, 0.0, 1.0), std::clamp(mixed.b, 0.0, 1.0)};
}

Ramp::Ramp(std::span<const glm::dvec3> stops) {
    const double pieces = static_cast<double>(stops.size() - 1);
    for (std::size_t i = 0; i <= kSteps; ++i) {
        const double place = pieces * static_cast<double>(i) / kSteps;
        const std::size_t stop = std::min(static_cast<std::size_t>(place), stops.size() - 2);
        table_[i] = mix_oklab(stops[stop], stops[stop + 1], place - static_cast<double>(stop));
    }
}

glm::vec3 Ramp::at(float t) const {
    const float place = std::clamp(t, 0.0f, 1.0f) * static_cast<float>(kSteps);
    const std::size_t step = std::min(static_cast<std::size_t>(place), kSteps - 1);
    const float rest = place - static_cast<float>(step);
    return table_[step] * (1.0f - rest) + table_[step + 1] * rest;
}

}  // namespace xorvox::host
