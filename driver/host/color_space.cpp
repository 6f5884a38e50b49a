#include "driver/host/color_space.h"

#include <algorithm>
#include <numbers>

#include "voxelizer/elementary.h"

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

glm::dvec3 clip(const glm::dvec3& c) {
    return {std::clamp(c.r, 0.0, 1.0), std::clamp(c.g, 0.0, 1.0), std::clamp(c.b, 0.0, 1.0)};
}

}  // namespace

double linear_from_srgb(std::uint8_t code) {
    const double encoded = code / 255.0;
    if (encoded <= 0.04045) return encoded / 12.92;
    const double base = (encoded + 0.055) / 1.055;
    const double square = base * base;
    return square * root(square, 5);  // base^2.4
}

const std::array<float, 256>& srgb_light() {
    static const std::array<float, 256> kLight = [] {
        std::array<float, 256> light{};
        for (std::size_t code = 0; code < light.size(); ++code) {
            light[code] = static_cast<float>(linear_from_srgb(static_cast<std::uint8_t>(code)));
        }
        return light;
    }();
    return kLight;
}

glm::dvec3 linear_from_hex(std::uint32_t rrggbb) {
    return {linear_from_srgb(static_cast<std::uint8_t>(rrggbb >> 16)),
            linear_from_srgb(static_cast<std::uint8_t>(rrggbb >> 8)),
            linear_from_srgb(static_cast<std::uint8_t>(rrggbb))};
}

glm::dvec3 mix_oklab(const glm::dvec3& a, const glm::dvec3& b, double t) {
    const glm::dvec3 mixed = linear_from_oklab((1.0 - t) * oklab_from_linear(a) + t * oklab_from_linear(b));
    return clip(mixed);
}

glm::dvec3 linear_from_oklch(double lightness, double chroma, double turns) {
    const double angle = 2.0 * std::numbers::pi * turns;
    return clip(linear_from_oklab({lightness, chroma * elementary::cos(angle), chroma * elementary::sin(angle)}));
}

Ramp::Ramp(std::span<const glm::dvec3> stops) {
    constexpr std::size_t kLeastSteps = 64;
    const std::size_t pieces = stops.size() - 1;
    steps_ = pieces * ((kLeastSteps + pieces - 1) / pieces);
    for (std::size_t i = 0; i <= steps_; ++i) {
        const double place = static_cast<double>(pieces) * static_cast<double>(i) / static_cast<double>(steps_);
        const std::size_t stop = std::min(static_cast<std::size_t>(place), pieces - 1);
        table_.emplace_back(mix_oklab(stops[stop], stops[stop + 1], place - static_cast<double>(stop)));
    }
}

}  // namespace xorvox::host
