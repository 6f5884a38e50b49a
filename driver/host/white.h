// White balance from a colour temperature.
#pragma once

#include <glm/vec3.hpp>

namespace xorvox::host {

/// The gains of red, green and blue, the largest 1, that make white of sRGB's primaries look like a black body of so
/// many kelvin, 1500 … 15000: the Planckian locus in the CIE 1960 diagram as two quotients of polynomials (M. Krystek,
/// "An algorithm to calculate correlated colour temperature", Color Research & Application 10, 1985), and IEC
/// 61966-2-1's matrix. Lower is redder. Colours that the primaries cannot mix have their least channel clipped to 0.
glm::vec3 white_of_temperature(double kelvin);

inline constexpr double kLeastKelvin = 1500.0;
inline constexpr double kMostKelvin = 15000.0;

}  // namespace xorvox::host
