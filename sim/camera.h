// Camera: a pinhole that looks at lit voxels from as near as they fit.
#pragma once

#include <span>

#include <glm/vec3.hpp>

#include "sim/surface.h"

namespace xorvox::sim {

/// Right-handed; in the world's millimetres. A point p is seen at x = dot(p − eye, right) ÷ (depth·tan_x), −1 … 1
/// across the picture, and y likewise with `up`; depth = dot(p − eye, forward).
struct Camera {
    glm::dvec3 eye_mm{0.0};
    glm::dvec3 right{1.0, 0.0, 0.0};
    glm::dvec3 up{0.0, 0.0, 1.0};
    glm::dvec3 forward{0.0, 1.0, 0.0};
    double tan_x = 1.0;
    double tan_y = 1.0;
    double distance_mm = 1.0;  ///< To the middle of what it looks at.
};

/// A point that must be in the picture, with some space around it.
struct Target {
    glm::dvec3 place_mm{0.0};
    double radius_mm = 0.0;
};

/// The camera nearest to `targets` (at least one) that sees all of them, from the side `azimuth_deg` (0: from -y, 90:
/// from +x), `elevation_deg` above the horizon (−89 … 89). `aspect`: width ÷ height of the picture.
Camera fit_camera(std::span<const Target> targets, double azimuth_deg, double elevation_deg, double aspect);

}  // namespace xorvox::sim
