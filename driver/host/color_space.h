// Colour arithmetic that gives the same bits on every machine: only + - × ÷ and √, no function of the C library whose
// last bits differ between versions.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace xorvox::host {

/// Linear light, 0 … 1, of an sRGB code (IEC 61966-2-1).
double linear_from_srgb(std::uint8_t code);

/// linear_from_srgb() of every code.
const std::array<float, 256>& srgb_light();

/// Linear light of 0xrrggbb in sRGB.
glm::dvec3 linear_from_hex(std::uint32_t rrggbb);

/// Linear colours `a` at t = 0 and `b` at t = 1, mixed in Oklab (Ottosson 2020), where equal steps look equal; clipped
/// to 0 … 1.
glm::dvec3 mix_oklab(const glm::dvec3& a, const glm::dvec3& b, double t);

/// Linear light, clipped to 0 … 1, of a lightness, a chroma and a hue in turns (from red by yellow, green and blue) in
/// Oklab.
glm::dvec3 linear_from_oklch(double lightness, double chroma, double turns);

/// A smooth row of colours, looked up many times.
class Ramp {
public:
    /// Two or more linear colours, evenly spaced; at each of their places the ramp has the very colour.
    explicit Ramp(std::span<const glm::dvec3> stops);

    /// The colour at t, which is clamped to 0 … 1.
    glm::vec3 at(float t) const {
        const float clamped = t > 0.0f ? (t < 1.0f ? t : 1.0f) : 0.0f;
        const float place = clamped * static_cast<float>(steps_);
        const std::size_t step = std::min(static_cast<std::size_t>(place), steps_ - 1);
        const float rest = place - static_cast<float>(step);
        return table_[step] * (1.0f - rest) + table_[step + 1] * rest;
    }

private:
    std::size_t steps_;
    std::vector<glm::vec3> table_;
};

}  // namespace xorvox::host
