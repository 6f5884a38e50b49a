#include "driver/display/trigonometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace xorvox::display {
namespace {

/// atan(t) / 2π for t in 0 … 1.
double arc_turns(double t) {
    // Each halving of the angle is exact but for rounding; after three, t is below 0.1.
    for (int halving = 0; halving < 3; ++halving) t = t / (1.0 + std::sqrt(1.0 + t * t));
    const double tt = t * t;
    // Taylor's series; the first term left out is below 2^-60 of the first one.
    double sum = 0.0;
    for (int n = 17; n >= 1; n -= 2) sum = 1.0 / n - tt * sum;
    return 8.0 * t * sum / (2.0 * std::numbers::pi);
}

}  // namespace

glm::dvec2 direction(double turns) {
    const double eighths = 8.0 * (turns - std::floor(turns));
    const int octant = std::min(static_cast<int>(eighths), 7);
    double rest = eighths - octant;
    if (octant % 2 == 1) rest = 1.0 - rest;

    // Taylor's series on 0 … π/4; the first term left out is below 2^-60.
    const double x = rest * 0.78539816339744830962;
    const double xx = x * x;
    double cosine = 1.0;
    double sine = 1.0;
    for (int n = 18; n >= 2; n -= 2) {
        cosine = 1.0 - cosine * xx / (n * (n - 1));
        sine = 1.0 - sine * xx / (n * (n + 1));
    }
    sine *= x;

    switch (octant) {
        case 0: return {cosine, sine};
        case 1: return {sine, cosine};
        case 2: return {-sine, cosine};
        case 3: return {-cosine, sine};
        case 4: return {-cosine, -sine};
        case 5: return {-sine, -cosine};
        case 6: return {sine, -cosine};
        default: return {cosine, -sine};
    }
}

double angle_turns(const glm::dvec2& place) {
    const double x = std::abs(place.x);
    const double y = std::abs(place.y);
    if (x == 0.0 && y == 0.0) return 0.0;
    double turns = y <= x ? arc_turns(y / x) : 0.25 - arc_turns(x / y);
    if (place.x < 0.0) turns = 0.5 - turns;
    if (place.y < 0.0) turns = 1.0 - turns;
    return turns >= 1.0 ? 0.0 : turns;
}

}  // namespace xorvox::display
