#include "driver/host/white.h"

#include <algorithm>

#include <glm/common.hpp>

namespace xorvox::host {

glm::vec3 white_of_temperature(double kelvin) {
    const double t = kelvin;
    const double u =
        (0.860117757 + 1.54118254e-4 * t + 1.28641212e-7 * t * t) / (1.0 + 8.42420235e-4 * t + 7.08145163e-7 * t * t);
    const double v =
        (0.317398726 + 4.22806245e-5 * t + 4.20481691e-8 * t * t) / (1.0 - 2.89741816e-5 * t + 1.61456053e-7 * t * t);
    // From (u, v) of 1960 to the tristimulus values of luminance 1.
    const double x = 1.5 * u / v;
    const double z = (4.0 - u - 10.0 * v) / (2.0 * v);
    const glm::dvec3 linear(3.2406 * x - 1.5372 - 0.4986 * z, -0.9689 * x + 1.8758 + 0.0415 * z,
                            0.0557 * x - 0.2040 + 1.0570 * z);
    const glm::dvec3 mixed = glm::max(linear, 0.0);
    return glm::vec3(mixed / std::max({mixed.r, mixed.g, mixed.b}));
}

}  // namespace xorvox::host
