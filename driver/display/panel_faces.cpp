#include "driver/display/panel_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace xorvox::display {
namespace {

/// A parallelepiped: all points centre ± up to half[i] of each edge. Flat where half[2] is 0.
struct Face {
    glm::dvec3 centre;
    std::array<glm::dvec3, 3> edges;  ///< Directions of length 1: right, up, and away from the axis.
    std::array<double, 3> half;       ///< mm.
};

Face face_of(const Panel& panel) {
    constexpr double degree = std::numbers::pi / 180.0;
    const double angle = panel.angle_deg * degree;
    const double tilt = panel.tilt_deg * degree;
    const glm::dvec3 right(std::cos(angle), std::sin(angle), 0.0);
    const glm::dvec3 normal(std::sin(angle), -std::cos(angle), 0.0);
    const glm::dvec3 up = normal * std::sin(tilt) + glm::dvec3(0.0, 0.0, std::cos(tilt));

    double width = panel.columns * panel.column_pitch_mm;
    double height = panel.rows * panel.row_pitch_mm;
    if (panel.turned % 2 == 1) std::swap(width, height);
    const bool deep = panel.skew_mm != 0.0 && panel.columns > 1;
    const double depth = deep ? panel.skew_mm : 0.0;
    return {right * panel.shift_mm + normal * (panel.offset_mm + depth / 2.0) + glm::dvec3(0.0, 0.0, panel.lift_mm),
            {right, up, deep ? normal : glm::cross(right, up)},
            {width / 2.0, height / 2.0, std::abs(depth) / 2.0}};
}

double size(const Face& face) {
    return face.half[0] + face.half[1] + face.half[2];
}

/// `face` with its edges drawn in, so that faces that touch are apart by more than `noise`.
Face shrunk(Face face, double noise) {
    for (double& half : face.half) half = std::max(0.0, half - std::max(1e-6 * half, 4.0 * noise));
    return face;
}

/// Whether a plane with the normal `axis` has the two on different sides.
bool separates(const glm::dvec3& axis, const Face& a, const Face& b, double noise) {
    const double length = glm::length(axis);
    if (length < 1e-9) return false;  // Of parallel edges: other axes tell.
    double gap = std::abs(glm::dot(b.centre - a.centre, axis));
    for (std::size_t i = 0; i < 3; ++i) {
        gap -= a.half[i] * std::abs(glm::dot(a.edges[i], axis));
        gap -= b.half[i] * std::abs(glm::dot(b.edges[i], axis));
    }
    return gap > noise * length;
}

}  // namespace

bool faces_cross(const Panel& a, const Panel& b) {
    const Face whole_a = face_of(a);
    const Face whole_b = face_of(b);
    const double reach = size(whole_a) + size(whole_b) + glm::length(whole_a.centre) + glm::length(whole_b.centre);
    const double noise = 1e-13 * reach;  // Of the arithmetic.
    const Face first = shrunk(whole_a, noise);
    const Face second = shrunk(whole_b, noise);
    // Two convex bodies are apart if and only if a plane along a side of one, or along an edge of each, separates them.
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        if (separates(glm::cross(first.edges[i], first.edges[j]), first, second, noise)) return false;
        if (separates(glm::cross(second.edges[i], second.edges[j]), first, second, noise)) return false;
        for (const glm::dvec3& edge : second.edges) {
            if (separates(glm::cross(first.edges[i], edge), first, second, noise)) return false;
        }
    }
    return true;
}

}  // namespace xorvox::display
