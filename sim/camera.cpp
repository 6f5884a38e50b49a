#include "sim/camera.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace xorvox::sim {
namespace {

constexpr double kHalfView_deg = 13.0;  ///< Of the picture's height: a long lens, so that near parts do not loom.
constexpr double kFilled = 0.94;        ///< How much of the picture's width or height the object may take.

/// How far the targets reach to one side, measured where they would touch a border that leans outwards by `tangent`.
double reach(std::span<const Target> targets, const glm::dvec3& side, const glm::dvec3& forward, double tangent) {
    double most = -std::numeric_limits<double>::infinity();
    for (const Target& target : targets) {
        const double touching = target.radius_mm * std::sqrt(1.0 + tangent * tangent);
        most =
            std::max(most, glm::dot(target.place_mm, side) - tangent * glm::dot(target.place_mm, forward) + touching);
    }
    return most;
}

}  // namespace

Camera fit_camera(std::span<const Target> targets, double azimuth_deg, double elevation_deg, double aspect) {
    assert(!targets.empty());
    const double azimuth = glm::radians(azimuth_deg);
    const double elevation = glm::radians(elevation_deg);

    Camera camera;
    camera.tan_y = std::tan(glm::radians(kHalfView_deg));
    camera.tan_x = camera.tan_y * aspect;
    camera.right = {std::cos(azimuth), std::sin(azimuth), 0.0};
    camera.forward = {-std::sin(azimuth) * std::cos(elevation), std::cos(azimuth) * std::cos(elevation),
                      -std::sin(elevation)};
    camera.up = glm::cross(camera.right, camera.forward);

    // The picture's left and right border are planes through the eye. Each target must be on the inner side of both:
    // with the eye at right·a + up·b − forward·d, reach(right) <= a + d·tan and reach(−right) <= −a + d·tan.
    const double tan_x = camera.tan_x * kFilled;
    const double tan_y = camera.tan_y * kFilled;
    const double to_right = reach(targets, camera.right, camera.forward, tan_x);
    const double to_left = reach(targets, -camera.right, camera.forward, tan_x);
    const double to_top = reach(targets, camera.up, camera.forward, tan_y);
    const double to_bottom = reach(targets, -camera.up, camera.forward, tan_y);
    const double back = std::max((to_right + to_left) / (2.0 * tan_x), (to_top + to_bottom) / (2.0 * tan_y));
    camera.eye_mm =
        camera.right * ((to_right - to_left) / 2.0) + camera.up * ((to_top - to_bottom) / 2.0) - camera.forward * back;

    double nearest = std::numeric_limits<double>::infinity();
    double farthest = -nearest;
    for (const Target& target : targets) {
        const double depth = glm::dot(target.place_mm - camera.eye_mm, camera.forward);
        nearest = std::min(nearest, depth);
        farthest = std::max(farthest, depth);
    }
    camera.distance_mm = (nearest + farthest) / 2.0;
    return camera;
}

}  // namespace xorvox::sim
