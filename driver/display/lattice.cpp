#include "driver/display/lattice.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <glm/common.hpp>

#include "driver/display/trigonometry.h"

namespace xorvox {
namespace {

using display::angle_turns;
using display::direction;

/// Item `index` of `count` in a line whose middle is at 0.
double centered(std::uint32_t index, std::uint32_t count, double pitch) {
    return (index - 0.5 * (count - 1)) * pitch;
}

/// Height, as a part of the stroke, at `part` of the time of an upward sweep.
double height_at(const Motion& motion, double part) {
    switch (motion.profile) {
        case MotionProfile::Constant: break;
        case MotionProfile::Sine: return 0.5 - 0.5 * direction(part / 2.0).x;
        case MotionProfile::Table: {
            const double place = part * (motion.table_size - 1);
            const std::size_t step = std::min<std::size_t>(static_cast<std::size_t>(place), motion.table_size - 2);
            const double rest = place - static_cast<double>(step);
            return motion.table[step] + rest * (motion.table[step + 1] - motion.table[step]);
        }
    }
    return part;
}

/// How `display` has turned in the middle of `slice`.
double turns_in(const DisplayDescription& display, std::uint32_t slice) {
    const double turns = (slice + 0.5) / display.slices * (display.sweep_deg / 360.0);
    return display.clockwise ? -turns : turns;
}

/// Whether LED column `left` of an upright panel, counted from the left, is an odd one on the wire.
bool is_odd_column(const Panel& panel, std::uint32_t left) {
    const bool from_right = panel.mirrored != (panel.turned == 2);
    return (from_right ? panel.columns - 1 - left : left) % 2 == 1;
}

/// Along the panel, from the axis to the far edge of its outermost pixels.
double reach_along_mm(const Panel& panel) {
    return std::abs(panel.shift_mm) + 0.5 * upright_columns(panel) * upright_column_pitch_mm(panel);
}

/// How far a panel leans out of the vertical to either side, and half its height.
glm::dvec2 half_profile_mm(const Panel& panel) {
    const glm::dvec2 tilt = direction(panel.tilt_deg / 360.0);
    const double half = 0.5 * upright_rows(panel) * upright_row_pitch_mm(panel);
    return {std::abs(tilt.y) * half, tilt.x * half};
}

DisplayExtent rotor_extent(const DisplayDescription& display) {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    DisplayExtent room{{0.0, 0.0, kFar}, {0.0, 0.0, -kFar}, kFar};
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        const Panel& panel = display.panels[p];
        const glm::dvec2 half = half_profile_mm(panel);
        const double along = reach_along_mm(panel);
        const double away = half.x > 0.0 ? 0.0 : panel.offset_mm;  // some row of a tilted panel may pass the axis
        const double farthest = std::abs(panel.offset_mm) + std::abs(panel.skew_mm) + half.x;
        const double reach = std::sqrt(along * along + farthest * farthest);
        room.radius_mm = std::min(room.radius_mm, std::sqrt(along * along + away * away));
        room.upper.x = room.upper.y = std::max(room.upper.x, reach);
        room.lower.z = std::min(room.lower.z, panel.lift_mm - half.y);
        room.upper.z = std::max(room.upper.z, panel.lift_mm + half.y);
    }
    room.lower.x = room.lower.y = -room.upper.x;
    return room;
}

DisplayExtent points_extent(const DisplayDescription& display) {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    DisplayExtent room{glm::dvec3(kFar), glm::dvec3(-kFar), 0.0};
    for (const PointMm& point : display.points) {
        room.lower = glm::min(room.lower, glm::dvec3(point.x, point.y, point.z));
        room.upper = glm::max(room.upper, glm::dvec3(point.x, point.y, point.z));
    }
    room.lower -= 0.5 * display.panels[0].column_pitch_mm;
    room.upper += 0.5 * display.panels[0].column_pitch_mm;
    return room;
}

}  // namespace

double swept_height_mm(const Motion& motion, double part_of_lit) {
    const double part = motion.dead_zone + part_of_lit * (1.0 - 2.0 * motion.dead_zone);
    return motion.stroke_mm * (height_at(motion, part) - 0.5);
}

UprightPixel upright_pixel(const Panel& panel, std::uint32_t column, std::uint32_t row) {
    const std::uint32_t right = panel.columns - 1;
    const std::uint32_t top = panel.rows - 1;
    const std::uint32_t a = panel.mirrored ? right - column : column;
    const std::uint32_t b = top - row;
    switch (panel.turned) {
        case 1: return {top - b, a};
        case 2: return {right - a, top - b};
        case 3: return {b, right - a};
        default: return {a, b};
    }
}

bool is_upright(const DisplayDescription& display) {
    const Panel& first = display.panels[0];
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        const Panel& panel = display.panels[p];
        if (panel.tilt_deg != 0.0 || (panel.turned % 2 == 1 && panel.skew_mm != 0.0)) return false;
        if (upright_rows(panel) != upright_rows(first)) return false;
        if (upright_row_pitch_mm(panel) != upright_row_pitch_mm(first) || panel.lift_mm != first.lift_mm) return false;
    }
    return true;
}

std::size_t lattice_columns(const DisplayDescription& display) {
    if (display.kind != DisplayKind::RotatingPanel) {
        return std::size_t{display.panels[0].columns} * display.panels[0].rows;
    }
    if (!is_upright(display)) return frame_pixels(display);
    std::size_t columns = 0;
    for (std::uint32_t p = 0; p < display.panel_count; ++p) columns += upright_columns(display.panels[p]);
    return columns * display.slices;
}

DisplayLattice::DisplayLattice(const DisplayDescription& display) {
    switch (display.kind) {
        case DisplayKind::StackedPlanes: make_stack(display); break;
        case DisplayKind::SweptPlane: make_swept(display); break;
        case DisplayKind::RotatingPanel: is_upright(display) ? make_upright(display) : make_pixels(display); break;
        case DisplayKind::Helix: make_helix(display); break;
        case DisplayKind::FreePoints: make_points(display); break;
    }
}

/// Columns of a flat panel about the z axis.
void DisplayLattice::put_regular_plan(const Panel& panel) {
    lattice_.nx = panel.columns;
    lattice_.ny = panel.rows;
    plan_.reserve(lattice_.column_count());
    for (std::uint32_t row = 0; row < panel.rows; ++row) {
        for (std::uint32_t column = 0; column < panel.columns; ++column) {
            plan_.emplace_back(centered(column, panel.columns, panel.column_pitch_mm),
                               centered(row, panel.rows, panel.row_pitch_mm));
        }
    }
}

void DisplayLattice::make_stack(const DisplayDescription& display) {
    const Panel& panel = display.panels[0];
    if (!display.plane_heights_mm.empty()) {
        put_regular_plan(panel);
        lattice_.nz = display.slices;
        z_.assign(display.plane_heights_mm.begin(), display.plane_heights_mm.end());
        return;
    }
    lattice_.nx = panel.columns;
    lattice_.ny = panel.rows;
    lattice_.nz = display.slices;
    lattice_.pitch = {panel.column_pitch_mm, panel.row_pitch_mm, display.plane_pitch_mm};
    lattice_.origin = -0.5 * glm::dvec3(lattice_.nx, lattice_.ny, lattice_.nz) * lattice_.pitch;
}

void DisplayLattice::make_swept(const DisplayDescription& display) {
    const Panel& panel = display.panels[0];
    const Motion& motion = display.motion;
    if (motion.profile == MotionProfile::Constant) {
        lattice_.nx = panel.columns;
        lattice_.ny = panel.rows;
        lattice_.nz = display.slices;
        lattice_.pitch = {panel.column_pitch_mm, panel.row_pitch_mm,
                          motion.stroke_mm * (1.0 - 2.0 * motion.dead_zone) / display.slices};
        lattice_.origin = -0.5 * glm::dvec3(lattice_.nx, lattice_.ny, lattice_.nz) * lattice_.pitch;
        return;
    }
    put_regular_plan(panel);
    lattice_.nz = display.slices;
    z_.reserve(display.slices);
    for (std::uint32_t slice = 0; slice < display.slices; ++slice) {
        z_.push_back(swept_height_mm(motion, (slice + 0.5) / display.slices));
    }
}

void DisplayLattice::make_upright(const DisplayDescription& display) {
    const Panel& first = display.panels[0];
    for (std::uint32_t p = 0; p < display.panel_count; ++p) lattice_.nx += upright_columns(display.panels[p]);
    lattice_.ny = display.slices;
    lattice_.nz = upright_rows(first);
    plan_.reserve(lattice_.column_count());
    for (std::uint32_t slice = 0; slice < display.slices; ++slice) {
        for (std::uint32_t p = 0; p < display.panel_count; ++p) {
            const Panel& panel = display.panels[p];
            const std::uint32_t columns = upright_columns(panel);
            const glm::dvec2 u = direction(turns_in(display, slice) + panel.angle_deg / 360.0);
            const glm::dvec2 n(u.y, -u.x);
            for (std::uint32_t column = 0; column < columns; ++column) {
                const double along = panel.shift_mm + centered(column, columns, upright_column_pitch_mm(panel));
                const bool skewed = panel.skew_mm != 0.0 && is_odd_column(panel, column);
                plan_.push_back(u * along + n * (panel.offset_mm + (skewed ? panel.skew_mm : 0.0)));
            }
        }
    }
    z_.reserve(lattice_.nz);
    for (std::uint32_t k = 0; k < lattice_.nz; ++k) {
        z_.push_back(first.lift_mm + centered(k, lattice_.nz, upright_row_pitch_mm(first)));
    }
}

/// Every pixel a column of one sample.
void DisplayLattice::make_pixels(const DisplayDescription& display) {
    lattice_.nx = static_cast<std::uint32_t>(frame_pixels(display) / display.slices);
    lattice_.ny = display.slices;
    lattice_.nz = 1;
    plan_.reserve(lattice_.column_count());
    z0_.reserve(lattice_.column_count());
    for (std::uint32_t slice = 0; slice < display.slices; ++slice) {
        for (std::uint32_t p = 0; p < display.panel_count; ++p) {
            const Panel& panel = display.panels[p];
            const glm::dvec2 u = direction(turns_in(display, slice) + panel.angle_deg / 360.0);
            const glm::dvec2 n(u.y, -u.x);
            const glm::dvec2 tilt = direction(panel.tilt_deg / 360.0);
            for (std::uint32_t row = 0; row < panel.rows; ++row) {
                for (std::uint32_t column = 0; column < panel.columns; ++column) {
                    const UprightPixel pixel = upright_pixel(panel, column, row);
                    const double a = centered(pixel.column, upright_columns(panel), upright_column_pitch_mm(panel));
                    const double b = centered(pixel.row, upright_rows(panel), upright_row_pitch_mm(panel));
                    const double out = panel.offset_mm + (column % 2 == 1 ? panel.skew_mm : 0.0) + b * tilt.y;
                    plan_.push_back(u * (panel.shift_mm + a) + n * out);
                    z0_.push_back(panel.lift_mm + b * tilt.x);
                }
            }
        }
    }
    z_.push_back(0.0);
}

void DisplayLattice::make_helix(const DisplayDescription& display) {
    put_regular_plan(display.panels[0]);
    lattice_.nz = display.slices;
    const double stroke = display.motion.stroke_mm;
    const double half = display.clockwise ? 0.5 : -0.5;  // slice 0 is lit in its middle
    z0_.reserve(plan_.size());
    helix_k_.reserve(plan_.size());
    for (const glm::dvec2& place : plan_) {
        // In steps of height: where slice 0 meets the screen.
        double steps = (angle_turns(place) * display.blades) * display.slices + half;
        steps -= std::floor(steps / display.slices) * display.slices;
        const double whole = std::floor(steps);
        z0_.push_back(stroke * ((steps - whole) / display.slices - 0.5));
        helix_k_.push_back(static_cast<std::uint32_t>(whole) % display.slices);
    }
    z_.reserve(display.slices);
    for (std::uint32_t k = 0; k < display.slices; ++k) z_.push_back(stroke * k / display.slices);
}

void DisplayLattice::make_points(const DisplayDescription& display) {
    lattice_.nx = static_cast<std::uint32_t>(display.points.size());
    lattice_.ny = 1;
    lattice_.nz = 1;
    plan_.reserve(display.points.size());
    z0_.reserve(display.points.size());
    for (const PointMm& point : display.points) {
        plan_.emplace_back(point.x, point.y);
        z0_.push_back(point.z);
    }
    z_.push_back(0.0);
}

Lattice DisplayLattice::view() const {
    Lattice lattice = lattice_;
    lattice.plan = plan_;
    lattice.z0 = z0_;
    lattice.z = z_;
    return lattice;
}

DisplayExtent extent(const DisplayDescription& display) {
    if (display.kind == DisplayKind::RotatingPanel) return rotor_extent(display);
    if (display.kind == DisplayKind::FreePoints) return points_extent(display);
    const Panel& panel = display.panels[0];
    glm::dvec3 upper = 0.5 * glm::dvec3(panel.columns * panel.column_pitch_mm, panel.rows * panel.row_pitch_mm, 0.0);
    glm::dvec3 lower = -upper;
    if (display.kind == DisplayKind::SweptPlane) {
        lower.z = swept_height_mm(display.motion, 0.0);
        upper.z = swept_height_mm(display.motion, 1.0);
    } else if (display.kind == DisplayKind::Helix) {
        upper.z = 0.5 * display.motion.stroke_mm;
        lower.z = -upper.z;
    } else if (display.plane_heights_mm.size() > 1) {
        const std::span<const double> z = display.plane_heights_mm;
        lower.z = z.front() - 0.5 * (z[1] - z.front());
        upper.z = z.back() + 0.5 * (z.back() - z[z.size() - 2]);
    } else {
        const double middle = display.plane_heights_mm.empty() ? 0.0 : display.plane_heights_mm.front();
        const double half = 0.5 * display.slices * display.plane_pitch_mm;
        lower.z = middle - half;
        upper.z = middle + half;
    }
    return {lower, upper, 0.0};
}

}  // namespace xorvox
