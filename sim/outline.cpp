#include "sim/outline.h"

#include <cmath>
#include <cstdint>
#include <numbers>

#include "driver/display/lattice.h"

namespace xorvox::sim {
namespace {

void add_ring(std::vector<Segment>& segments, double radius_mm, double z_mm) {
    constexpr int kSides = 180;
    const auto corner = [&](int side) {
        const double angle = 2.0 * std::numbers::pi * side / kSides;
        return glm::dvec3(radius_mm * std::cos(angle), radius_mm * std::sin(angle), z_mm);
    };
    for (int side = 0; side < kSides; ++side) segments.push_back({corner(side), corner(side + 1)});
}

}  // namespace

std::vector<Segment> outline(const DisplayDescription& display) {
    const DisplayExtent box = extent(display);
    std::vector<Segment> segments;
    if (box.radius_mm > 0.0) {
        add_ring(segments, box.radius_mm, box.upper.z);
        for (const double share : {1.0, 0.5}) add_ring(segments, share * box.radius_mm, box.lower.z);
        return segments;
    }
    const auto corner = [&](unsigned number) {
        return glm::dvec3((number & 1) != 0 ? box.upper.x : box.lower.x, (number & 2) != 0 ? box.upper.y : box.lower.y,
                          (number & 4) != 0 ? box.upper.z : box.lower.z);
    };
    for (unsigned from = 0; from < 8; ++from) {
        for (const unsigned axis : {1u, 2u, 4u}) {
            if ((from & axis) == 0) segments.push_back({corner(from), corner(from | axis)});
        }
    }
    return segments;
}

}  // namespace xorvox::sim
