// Colour arithmetic that gives the same bits on every machine: only + - × ÷ and √, no function of the C library whose
// last bits differ between versions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

namespace xorvox::host {

/// Linear light, 0 … 1, of an sRGB code (IEC 61966-2-1).
double linear_from_srgb(std::uint8_t code);

/// Linear light of 0xrrggbb in sRGB.
glm::dvec3 linear_from_hex(std::uint32_t rrggbb);

/// Linear colours `a` at t = 0 and `b` at t = 1, mixed in Oklab (Ottosson 2020), where equal steps look equal; clipped
/// to 0 … 1.
glm::dvec3 mix_oklab(const glm::dvec3& a, const glm::dvec3& b, double t);

/// A smooth row of colours, looked up many times.
class Ramp {
public:
    /// At least two linear colours, evenly spaced.
    explicit Ramp(std::span<const glm::dvec3> stops);

    /// The colour at t, which is clamped to 0 … 1.
    glm::vec3 at(float t) const;

private:
    static constexpr std::size_t kSteps = 64;
    std::array<glm::vec3, kSteps + 1> table_;
};

}  // namespace xorvox::host
