// Displays for tests: small ones of every kind without any symmetry, and the drawing at the head of
// driver/display/description.h as a formula, with the C library's functions.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "driver/display/description.h"

namespace xorvox::test {

/// Where a pixel is while its slice is lit.
inline glm::dvec3 drawn(const DisplayDescription& display, std::uint32_t slice, std::uint32_t p, std::uint32_t row,
                        std::uint32_t column) {
    constexpr double kTurn = 6.283185307179586;
    const Panel& panel = display.panels[p];
    const Motion& motion = display.motion;
    const double x = (column - (panel.columns - 1) / 2.0) * panel.column_pitch_mm;
    const double y = (row - (panel.rows - 1) / 2.0) * panel.row_pitch_mm;
    const double middle = (slice + 0.5) / display.slices;
    switch (display.kind) {
        case DisplayKind::StackedPlanes:
            if (!display.plane_heights_mm.empty()) return {x, y, display.plane_heights_mm[slice]};
            return {x, y, (slice - (display.slices - 1) / 2.0) * display.plane_pitch_mm};
        case DisplayKind::SweptPlane: {
            const double u = motion.dead_zone + middle * (1.0 - 2.0 * motion.dead_zone);
            double height = u;
            if (motion.profile == MotionProfile::Sine) height = (1.0 - std::cos(kTurn / 2.0 * u)) / 2.0;
            if (motion.profile == MotionProfile::Table) {
                const double step = u * (motion.table_size - 1);
                const auto below = static_cast<std::size_t>(step);
                height = std::lerp(motion.table[below], motion.table[below + 1], step - static_cast<double>(below));
            }
            return {x, y, motion.stroke_mm * (height - 0.5)};
        }
        case DisplayKind::Helix: {
            const double turned = std::atan2(y, x) / kTurn * display.blades + (display.clockwise ? middle : -middle);
            return {x, y, motion.stroke_mm * (turned - std::floor(turned) - 0.5)};
        }
        case DisplayKind::FreePoints: {
            const PointMm& point = display.points[row * panel.columns + column];
            return {point.x, point.y, point.z};
        }
        case DisplayKind::RotatingPanel: break;
    }
    double a = panel.mirrored ? -x : x;
    double b = -y;
    for (int quarter = 0; quarter < panel.turned; ++quarter) {
        const double was = a;
        a = -b;
        b = was;
    }
    const double phase = kTurn * middle * display.sweep_deg / 360.0;
    const double theta = (display.clockwise ? -phase : phase) + panel.angle_deg / 360.0 * kTurn;
    const double tilt = panel.tilt_deg / 360.0 * kTurn;
    const double along = panel.shift_mm + a;
    const double out = panel.offset_mm + (column % 2 == 1 ? panel.skew_mm : 0.0) + b * std::sin(tilt);
    return {std::cos(theta) * along + std::sin(theta) * out, std::sin(theta) * along - std::cos(theta) * out,
            panel.lift_mm + b * std::cos(tilt)};
}

inline DisplayDescription flat_display(std::string_view name, DisplayKind kind, std::uint32_t slices) {
    DisplayDescription display;
    display.name = name;
    display.kind = kind;
    display.slices = slices;
    display.cycles_per_second = 20.0;
    display.panels[0] = {.columns = 13, .rows = 9, .column_pitch_mm = 2.5, .row_pitch_mm = 3.0};
    return display;
}

/// Two panels in all poses that leave a rotor upright, but `mirrored` and `turned`, which the first one has as given.
inline DisplayDescription upright_rotor(bool clockwise, bool mirrored, std::uint8_t turned) {
    DisplayDescription display;
    display.name = std::string_view("upright-rotor");
    display.kind = DisplayKind::RotatingPanel;
    display.slices = 23;
    display.cycles_per_second = 15.0;
    display.clockwise = clockwise;
    display.panel_count = 2;
    const bool on_its_side = turned % 2 == 1;
    display.panels[0] = {.columns = 67, .rows = 11, .column_pitch_mm = 2.0, .row_pitch_mm = 3.0};
    if (on_its_side) display.panels[0] = {.columns = 11, .rows = 67, .column_pitch_mm = 3.0, .row_pitch_mm = 2.0};
    display.panels[0].shift_mm = 0.6;
    display.panels[0].offset_mm = 0.7;
    display.panels[0].lift_mm = 20.0;
    display.panels[0].angle_deg = 12.0;
    display.panels[0].skew_mm = on_its_side ? 0.0 : 0.3;
    display.panels[0].mirrored = mirrored;
    display.panels[0].turned = turned;
    display.panels[1] = {.columns = 10, .rows = 11, .column_pitch_mm = 4.0, .row_pitch_mm = 3.0};
    display.panels[1].offset_mm = 3.0;
    display.panels[1].lift_mm = 20.0;
    display.panels[1].angle_deg = 180.0;
    display.panels[1].skew_mm = -0.4;
    return display;
}

/// Tilted, at different heights, and of different sizes: every pixel is a column of its own.
inline DisplayDescription leaning_rotor(bool clockwise) {
    DisplayDescription display = upright_rotor(clockwise, true, 3);
    display.name = std::string_view("leaning-rotor");
    display.slices = 11;
    display.panels[0].tilt_deg = 14.0;
    display.panels[0].skew_mm = 0.3;
    display.panels[1].rows = 7;
    display.panels[1].lift_mm = 15.0;
    display.panels[1].offset_mm = 12.0;
    return display;
}

/// One of every kind and in every pose.
inline std::vector<DisplayDescription> odd_displays() {
    std::vector<DisplayDescription> all;
    auto& stack = all.emplace_back(flat_display("odd-stack", DisplayKind::StackedPlanes, 7));
    stack.plane_pitch_mm = 4.0;
    static constexpr std::array kHeights{-11.0, -7.5, -4.0, 0.5, 6.0};
    auto& uneven = all.emplace_back(flat_display("uneven-stack", DisplayKind::StackedPlanes, 5));
    uneven.plane_heights_mm = kHeights;
    auto& constant = all.emplace_back(flat_display("constant-sweep", DisplayKind::SweptPlane, 8));
    constant.motion = {.stroke_mm = 30.0, .dead_zone = 0.1};
    auto& sine = all.emplace_back(flat_display("sine-sweep", DisplayKind::SweptPlane, 9));
    sine.motion = {.stroke_mm = 40.0, .profile = MotionProfile::Sine, .both_ways = true, .dead_zone = 0.05};
    auto& table = all.emplace_back(flat_display("table-sweep", DisplayKind::SweptPlane, 6));
    table.motion = {.stroke_mm = 36.0, .profile = MotionProfile::Table, .table_size = 4, .table = {0.0, 0.2, 0.7, 1.0}};
    for (const bool clockwise : {false, true}) {
        auto& helix = all.emplace_back(flat_display("helix", DisplayKind::Helix, 10));
        helix.clockwise = clockwise;
        helix.blades = clockwise ? 1 : 2;
        helix.motion.stroke_mm = 30.0;
    }
    static constexpr std::array<PointMm, 12> kPoints{{{0, 0, 0},
                                                      {5, 1, 2},
                                                      {-3, 7, 4},
                                                      {2, -6, 9},
                                                      {8, 8, -3},
                                                      {-7, -2, 6},
                                                      {1, 4, -8},
                                                      {-5, 3, -2},
                                                      {6, -4, 5},
                                                      {3, 9, 7},
                                                      {-8, -7, -6},
                                                      {0, 0, 10}}};
    auto& points = all.emplace_back(flat_display("points", DisplayKind::FreePoints, 1));
    points.panels[0] = {.columns = 4, .rows = 3, .column_pitch_mm = 4.0, .row_pitch_mm = 4.0};
    points.points = kPoints;
    for (std::uint8_t turned = 0; turned < 4; ++turned) {
        for (const bool mirrored : {false, true}) all.push_back(upright_rotor(turned % 2 == 1, mirrored, turned));
    }
    all.push_back(leaning_rotor(false));
    all.push_back(leaning_rotor(true));
    auto& half = all.emplace_back(flat_display("half-turns", DisplayKind::RotatingPanel, 12));
    half.sweep_deg = 180.0;
    half.panels[0].rows = 10;
    half.panels[0].columns = 12;  // None on the axis, where the samples of all slices are at one place.
    return all;
}

}  // namespace xorvox::test
