#include "examples/duck_shape.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace xorvox::examples {
namespace {

using Vec = glm::dvec3;

double sphere(const Vec& p, const Vec& centre, double radius) {
    return glm::length(p - centre) - radius;
}

// About the distance from an ellipsoid with these half-axes, exact in sign.
double ellipsoid(const Vec& p, const Vec& half_axes) {
    const double scaled = glm::length(p / half_axes);
    const double gradient = glm::length(p / (half_axes * half_axes));
    return gradient == 0 ? -std::min({half_axes.x, half_axes.y, half_axes.z}) : scaled * (scaled - 1) / gradient;
}

// A rod from a to b whose radius goes from ra to rb.
double cone(const Vec& p, const Vec& a, const Vec& b, double ra, double rb) {
    const Vec along = b - a;
    const double t = std::clamp(glm::dot(p - a, along) / glm::dot(along, along), 0.0, 1.0);
    return glm::length(p - a - t * along) - (ra + t * (rb - ra));
}

// Unions and cuts whose seam is rounded over a width of about k (polynomial smooth minimum).
double join(double a, double b, double k) {
    const double h = std::max(k - std::abs(a - b), 0.0) / k;
    return std::min(a, b) - h * h * k / 4;
}
double cut(double a, double b, double k) {
    return -join(-a, b, k);
}

// p turned about the y axis so that (1, 0, slope) becomes the new x axis.
Vec tilt(const Vec& p, double slope) {
    const double c = 1 / std::sqrt(1 + slope * slope);
    const double s = slope * c;
    return {c * p.x + s * p.z, p.y, c * p.z - s * p.x};
}

// One side stands for both: y is not negative.
double body(const Vec& p) {
    const double hull = ellipsoid(p - Vec(-3, 0, 28), {40, 31, 28});
    const double chest = sphere(p, {14, 0, 29}, 26);
    const Vec flat(p.x, 0.62 * p.y, p.z);  // The tail is a fan, wider than high.
    const double tail =
        join(cone(flat, {-30, 0, 34}, {-45, 0, 46}, 15, 8), cone(flat, {-45, 0, 46}, {-52, 0, 58}, 8, 3.2), 8);
    return join(join(hull, chest, 10), tail, 16);
}

double wing(const Vec& p) {
    const Vec q = tilt(p - Vec(-7, 27, 36), -0.28);
    const double blade = ellipsoid(q, {24, 7.5, 13});
    const double tip = cone(q, {-10, 0, 3}, {-27, 3.5, 9}, 8, 3);
    return join(blade, tip, 8);
}

double head(const Vec& p) {
    const double skull = ellipsoid(p - Vec(21, 0, 70), {22, 21.5, 21});
    const double cheek = sphere(p, {29, 12, 63.5}, 9);
    return join(skull, cheek, 8);
}

double beak(const Vec& p) {
    const double upper = ellipsoid(tilt(p - Vec(45, 0, 66.5), 0.16), {14.5, 13, 4.8});
    const double lower = ellipsoid(tilt(p - Vec(42, 0, 59.5), -0.16), {12.5, 10.5, 4});
    return join(upper, lower, 2);
}

}  // namespace

double duck(const Vec& at) {
    const Vec p(at.x, std::abs(at.y), at.z);
    double d = join(body(p), head(p), 12);
    d = join(d, wing(p), 2.5);
    d = join(d, beak(p), 2);
    d = join(d, sphere(p, {36.6, 10.8, 76}, 4.7), 1);
    // Flat enough below to stand.
    return cut(d, p.z - 1.5, 4);
}

}  // namespace xorvox::examples
