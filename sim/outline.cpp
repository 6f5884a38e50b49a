#include "sim/outline.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include <glm/trigonometric.hpp>

#include "sim/optics.h"
#include "sim/space.h"
#include "sim/surface.h"

namespace xorvox::sim {
namespace {

constexpr double kHalf = 0.5 * double{kVoxelFilling};  ///< Half a voxel, as it is drawn, in pitches.

/// The outermost LEDs of a panel, as far as they reach from the axis and up and down.
void include_panel(DisplayExtent& space, const Panel& panel) {
    const double tilt = glm::radians(panel.tilt_deg);
    const double along = std::abs(panel.shift_mm) + 0.5 * (upright_columns(panel) - 1) * upright_column_pitch_mm(panel);
    const double half_height = 0.5 * (upright_rows(panel) - 1) * upright_row_pitch_mm(panel);
    for (const double b : {-half_height, half_height}) {
        for (const double skew : {0.0, panel.skew_mm}) {
            const double out = panel.offset_mm + skew + b * std::sin(tilt);
            const double up = panel.lift_mm + b * std::cos(tilt);
            space.radius_mm = std::max(space.radius_mm, std::hypot(along, out));
            space.lower.z = std::min(space.lower.z, up);
            space.upper.z = std::max(space.upper.z, up);
        }
    }
}

DisplayExtent drawn_cylinder(const DisplayDescription& display) {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    const Spacing spacing = spacing_of(display);
    DisplayExtent space{glm::dvec3(kFar), glm::dvec3(-kFar), 0.0};
    for (std::uint32_t p = 0; p < display.panel_count; ++p) include_panel(space, display.panels[p]);
    space.radius_mm += kHalf * spacing.across_mm;
    space.lower = {-space.radius_mm, -space.radius_mm, space.lower.z - kHalf * spacing.up_mm};
    space.upper = {space.radius_mm, space.radius_mm, space.upper.z + kHalf * spacing.up_mm};
    return space;
}

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
    if (display.kind == DisplayKind::RotatingPanel) return drawn_cylinder(display);
    const Panel& panel = display.panels[0];
    const Spacing spacing = spacing_of(display);
    const glm::dvec3 pitch_mm(spacing.across_mm, spacing.along_mm, spacing.up_mm);
    DisplayExtent box = extent(display);
    if (display.kind == DisplayKind::FreePoints) {
        // Half a column's pitch, by which it is larger than the points, says nothing of how they are drawn.
        box.lower += 0.5 * panel.column_pitch_mm - kHalf * pitch_mm;
        box.upper -= 0.5 * panel.column_pitch_mm - kHalf * pitch_mm;
        return box;
    }
    box.lower -= (kHalf - 0.5) * pitch_mm;
    box.upper += (kHalf - 0.5) * pitch_mm;
    if (display.kind == DisplayKind::Helix) {
        box.lower.z -= 0.5 * spacing.up_mm;  // its samples reach to the ends of the stroke
        box.upper.z += 0.5 * spacing.up_mm;
        return box;
    }
    const std::uint32_t top = display.slices - 1;
    box.lower.z = plane_height_mm(display, 0.0) - kHalf * plane_thickness_mm(display, 0);
    box.upper.z = plane_height_mm(display, top) + kHalf * plane_thickness_mm(display, top);
    return box;
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

std::vector<Segment> marks(const DisplayDescription& display) {
    const DisplayExtent box = drawn_extent(display);
    const double size = 0.04 * std::max({box.upper.x - box.lower.x, box.upper.y - box.lower.y, 0.0});
    const glm::dvec3 along(size, 0.0, 0.0);
    const glm::dvec3 steep(0.0, size * std::numbers::sqrt2 / 2.0, size * std::numbers::sqrt2 / 2.0);
    const glm::dvec3 foot(box.upper.x, (box.lower.y + box.upper.y) / 2.0, box.lower.z);
    const glm::dvec3 tip = foot + 2.0 * along;
    const glm::dvec3 letter = tip + 1.2 * along;
    std::vector<Segment> segments{{foot, tip}};
    for (const double sign : {-1.0, 1.0}) {
        // Leaning back, so that they are seen from the front and from above.
        const glm::dvec3 stroke = 0.5 * (along + sign * steep);
        segments.push_back({tip - along + 0.5 * sign * steep, tip});
        segments.push_back({letter - stroke, letter + stroke});
    }
    if (display.kind == DisplayKind::RotatingPanel || display.kind == DisplayKind::Helix) {
        segments.push_back({{0.0, 0.0, box.lower.z - 1.5 * size}, {0.0, 0.0, box.upper.z + 1.5 * size}});
    }
    return segments;
}

}  // namespace xorvox::sim
