#include "sim/outline.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "sim/surface.h"

namespace xorvox::sim {
namespace {

constexpr double kMore =
    0.5 * (double{kVoxelFilling} - 1.0);  ///< In pitches: how far voxels are drawn beyond their space.

void add_ring(std::vector<Segment>& segments, double radius_mm, double z_mm) {
    constexpr int kSides = 180;
    const auto corner = [&](int side) {
        const double angle = 2.0 * std::numbers::pi * side / kSides;
        return glm::dvec3(radius_mm * std::cos(angle), radius_mm * std::sin(angle), z_mm);
    };
    for (int side = 0; side < kSides; ++side) segments.push_back({corner(side), corner(side + 1)});
}

}  // namespace

DisplayExtent drawn_extent(const DisplayDescription& display) {
    DisplayExtent box = extent(display);
    const Panel& first = display.panels[0];
    if (display.kind == DisplayKind::StackedPlanes) {
        const glm::dvec3 pitch_mm(first.column_pitch_mm, first.row_pitch_mm, display.plane_pitch_mm);
        box.lower -= kMore * pitch_mm;
        box.upper += kMore * pitch_mm;
        return box;
    }
    double outermost_mm = 0.0;
    double widest_mm = 0.0;
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        const Panel& panel = display.panels[p];
        const double along_mm = std::abs(panel.shift_mm) + 0.5 * (panel.columns - 1) * panel.column_pitch_mm;
        outermost_mm = std::max(outermost_mm, std::hypot(along_mm, panel.offset_mm));
        widest_mm = std::max(widest_mm, panel.column_pitch_mm);
    }
    const double radius_mm = outermost_mm + (0.5 + kMore) * widest_mm;
    const double up_mm = kMore * first.row_pitch_mm;
    return {{-radius_mm, -radius_mm, box.lower.z - up_mm}, {radius_mm, radius_mm, box.upper.z + up_mm}, radius_mm};
}

std::vector<Segment> outline(const DisplayDescription& display) {
    const DisplayExtent box = drawn_extent(display);
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
