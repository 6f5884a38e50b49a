#include "sim/space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/common.hpp>
#include <glm/trigonometric.hpp>

#include "driver/display/lattice.h"
#include "sim/optics.h"

namespace xorvox::sim {
namespace {

constexpr double kRounding = 1e-9;

double slice_angle(const DisplayDescription& display) {
    return glm::radians(display.sweep_deg) / display.slices;
}

/// What an LED of `panel` sweeps in a slice; `left`: its upright column.
double swept_volume(const Panel& panel, std::uint32_t left, double slice_rad) {
    const double half = upright_column_pitch_mm(panel) / 2.0;
    const double r = std::abs(panel.shift_mm + (2.0 * left - (upright_columns(panel) - 1.0)) * half);
    // The integral of |r| over the LED's pitch; an LED that reaches over the axis sweeps both sides of it.
    const double moment = r >= half ? 2.0 * half * r : r * r + half * half;
    return moment * slice_rad * upright_row_pitch_mm(panel) * std::cos(glm::radians(panel.tilt_deg));
}

std::vector<double> rotor_volumes(const DisplayDescription& display) {
    const bool upright = is_upright(display);
    const double slice_rad = slice_angle(display);
    std::vector<double> volumes;
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        const Panel& panel = display.panels[p];
        if (upright) {
            for (std::uint32_t left = 0; left < upright_columns(panel); ++left) {
                volumes.push_back(swept_volume(panel, left, slice_rad));
            }
            continue;
        }
        for (std::uint32_t row = 0; row < panel.rows; ++row) {
            for (std::uint32_t column = 0; column < panel.columns; ++column) {
                volumes.push_back(swept_volume(panel, upright_pixel(panel, column, row).column, slice_rad));
            }
        }
    }
    return volumes;
}

/// The pitch at which a box of the size of the points' would hold as many as there are; also where the box is flat.
double point_pitch_mm(const DisplayDescription& display) {
    const DisplayExtent room = extent(display);
    const glm::dvec3 size = glm::max(room.upper - room.lower - display.panels[0].column_pitch_mm, glm::dvec3(0.0));
    const auto points_at = [&](double pitch) {
        return (size.x / pitch + 1.0) * (size.y / pitch + 1.0) * (size.z / pitch + 1.0);
    };
    double coarse = std::max({size.x, size.y, size.z});
    if (display.points.size() < 2 || coarse == 0.0) return display.panels[0].column_pitch_mm;
    double fine = coarse / static_cast<double>(display.points.size());
    for (int i = 0; i < 60; ++i) {
        const double middle = (coarse + fine) / 2.0;
        (points_at(middle) < static_cast<double>(display.points.size()) ? coarse : fine) = middle;
    }
    return fine;
}

Spacing rotor_spacing(const DisplayDescription& display) {
    Spacing spacing{true, 0.0, 0.0, 0.0, slice_angle(display), 0.0};
    double total_mm3 = 0.0;
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        const Panel& panel = display.panels[p];
        // A panel that lies flat has its rows beside each other.
        const double rising = std::max(std::cos(glm::radians(panel.tilt_deg)), 0.25);
        spacing.across_mm = std::max(spacing.across_mm, upright_column_pitch_mm(panel));
        spacing.up_mm = std::max(spacing.up_mm, rising * upright_row_pitch_mm(panel));
        for (std::uint32_t left = 0; left < upright_columns(panel); ++left) {
            total_mm3 += swept_volume(panel, left, spacing.slice_rad) * upright_rows(panel) * display.slices;
        }
    }
    const DisplayExtent room = extent(display);
    const double rim_mm = room.upper.x;
    spacing.along_mm = rim_mm * spacing.slice_rad;
    spacing.times_covered = total_mm3 / (std::numbers::pi * rim_mm * rim_mm * (room.upper.z - room.lower.z));
    return spacing;
}

}  // namespace

double plane_thickness_mm(const DisplayDescription& display, std::uint32_t slice) {
    return plane_height_mm(display, slice + 0.5) - plane_height_mm(display, slice - 0.5);
}

double passes_at(const DisplayDescription& display, const glm::dvec3& place_mm) {
    if (display.kind != DisplayKind::RotatingPanel) return 1.0;
    const double r = std::hypot(place_mm.x, place_mm.y);
    double passes = 0.0;
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        const Panel& panel = display.panels[p];
        const double tilt = glm::radians(panel.tilt_deg);
        const double up = (place_mm.z - panel.lift_mm) / std::cos(tilt);
        if (std::abs(up) > upright_rows(panel) * upright_row_pitch_mm(panel) / 2.0) continue;
        const double half = upright_columns(panel) * upright_column_pitch_mm(panel) / 2.0;
        // Even columns, and odd ones, which may stand further out.
        for (const double skew : {0.0, panel.skew_mm}) {
            const double out = panel.offset_mm + skew + up * std::sin(tilt);
            const double along = std::sqrt(std::max(r * r - out * out, 0.0));
            if (r < std::abs(out) - kRounding * half) continue;
            for (const double side : {along, -along}) passes += std::abs(side - panel.shift_mm) <= half ? 0.5 : 0.0;
        }
    }
    // A sample's own panel passes it, whatever the sum over unlike columns says.
    return std::max(passes, 1.0) * display.sweep_deg / 360.0;
}

SampleVolumes sample_volumes(const DisplayDescription& display) {
    const Panel& panel = display.panels[0];
    SampleVolumes volumes;
    switch (display.kind) {
        case DisplayKind::FreePoints: return volumes;
        case DisplayKind::RotatingPanel: volumes.by_x = rotor_volumes(display); return volumes;
        case DisplayKind::Helix: volumes.by_k = {display.motion.stroke_mm / display.slices}; break;
        case DisplayKind::StackedPlanes:
        case DisplayKind::SweptPlane:
            volumes.by_k.clear();
            for (std::uint32_t slice = 0; slice < display.slices; ++slice) {
                volumes.by_k.push_back(plane_thickness_mm(display, slice));
            }
            break;
    }
    volumes.by_x = {panel.column_pitch_mm * panel.row_pitch_mm};
    return volumes;
}

Spacing spacing_of(const DisplayDescription& display) {
    const Panel& panel = display.panels[0];
    Spacing spacing{false, panel.column_pitch_mm, panel.row_pitch_mm, 1.0, 0.0, 1.0};
    switch (display.kind) {
        case DisplayKind::RotatingPanel: return rotor_spacing(display);
        case DisplayKind::FreePoints:
            spacing.across_mm = spacing.along_mm = spacing.up_mm = point_pitch_mm(display);
            break;
        case DisplayKind::Helix: spacing.up_mm = display.motion.stroke_mm / display.slices; break;
        case DisplayKind::StackedPlanes:
        case DisplayKind::SweptPlane:
            spacing.up_mm =
                (plane_height_mm(display, display.slices - 0.5) - plane_height_mm(display, -0.5)) / display.slices;
            break;
    }
    return spacing;
}

}  // namespace xorvox::sim
