// Small displays of every kind, and what is lit in a frame, read without the driver's help.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "driver/display/description.h"

namespace xorvox::test {

inline constexpr double kTurn = 6.283185307179586;

inline DisplayDescription stack(PixelFormat format, std::uint16_t columns = 9, std::uint16_t rows = 7,
                                std::uint32_t slices = 5) {
    DisplayDescription display;
    display.name = DisplayName("stack");
    display.format = format;
    display.slices = slices;
    display.plane_pitch_mm = 4.0;
    display.cycles_per_second = 50.0;
    display.panels[0] = {.columns = columns, .rows = rows, .column_pitch_mm = 2.0, .row_pitch_mm = 3.0};
    return display;
}

inline constexpr std::array kHeights{-9.0, -4.0, 0.5, 3.0, 11.0};
inline DisplayDescription uneven_stack(PixelFormat format) {
    DisplayDescription display = stack(format);
    display.plane_heights_mm = kHeights;
    return display;
}

inline DisplayDescription swept(PixelFormat format, MotionProfile profile = MotionProfile::Sine) {
    DisplayDescription display = stack(format);
    display.name = DisplayName("swept");
    display.kind = DisplayKind::SweptPlane;
    display.slices = 6;
    display.cycles_per_second = 15.0;
    display.motion.stroke_mm = 80.0;
    display.motion.profile = profile;
    display.motion.both_ways = true;
    return display;
}

/// Two panels back to back, an LED of each half a pitch from the axis.
inline DisplayDescription rotor(PixelFormat format, bool clockwise = false, double sweep_deg = 360.0) {
    DisplayDescription display;
    display.name = DisplayName("rotor");
    display.kind = DisplayKind::RotatingPanel;
    display.format = format;
    display.slices = 36;
    display.cycles_per_second = 20.0;
    display.clockwise = clockwise;
    display.sweep_deg = sweep_deg;
    display.panel_count = 2;
    display.panels[0] = {.columns = 16, .rows = 12, .column_pitch_mm = 2.0, .row_pitch_mm = 2.0};
    if (sweep_deg == 360.0) display.panels[0].offset_mm = 1.5;
    display.panels[1] = display.panels[0];
    display.panels[1].angle_deg = 180.0;
    return display;
}

/// Two panels on their sides, side by side; the second one mirrored.
inline DisplayDescription side_by_side(PixelFormat format) {
    DisplayDescription display = rotor(format);
    display.name = DisplayName("side by side");
    display.panels[0] = {.columns = 12, .rows = 8, .column_pitch_mm = 2.0, .row_pitch_mm = 2.0, .shift_mm = -8.0};
    display.panels[0].turned = 1;
    display.panels[1] = display.panels[0];
    display.panels[1].shift_mm = 8.0;
    display.panels[1].mirrored = true;
    return display;
}

inline DisplayDescription tilted_rotor(PixelFormat format) {
    DisplayDescription display = rotor(format, true);
    display.name = DisplayName("tilted");
    display.panels[1].tilt_deg = 10.0;
    display.panels[1].skew_mm = 0.5;
    display.panels[1].angle_deg = 90.0;
    return display;
}

inline DisplayDescription helix(PixelFormat format) {
    DisplayDescription display = stack(format, 16, 16, 8);
    display.name = DisplayName("helix");
    display.kind = DisplayKind::Helix;
    display.panels[0].row_pitch_mm = 2.0;
    display.blades = 2;
    display.motion.stroke_mm = 20.0;
    return display;
}

inline const std::array<PointMm, 12> kPoints = [] {
    std::array<PointMm, 12> points;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto n = static_cast<double>(i);
        points[i] = {10.0 * std::cos(n), 12.0 * std::sin(2.0 * n), 3.0 * n};
    }
    return points;
}();
inline DisplayDescription free_points(PixelFormat format) {
    DisplayDescription display = stack(format, 4, 3, 1);
    display.name = DisplayName("points");
    display.kind = DisplayKind::FreePoints;
    display.points = kPoints;
    return display;
}

inline std::vector<DisplayDescription> every_kind(PixelFormat format) {
    return {stack(format),
            uneven_stack(format),
            swept(format),
            swept(format, MotionProfile::Constant),
            rotor(format),
            rotor(format, true),
            rotor(format, false, 180.0),
            side_by_side(format),
            tilted_rotor(format),
            helix(format),
            free_points(format)};
}

struct LitPixel {
    std::uint32_t slice, panel, row, column, code;
    bool operator==(const LitPixel&) const = default;
};

/// Every pixel whose code is not 0, in the order of the wire. `padding` is set if a bit is set that belongs to none.
inline std::vector<LitPixel> lit_pixels(const DisplayDescription& display, std::span<const std::byte> frame,
                                        bool* padding = nullptr) {
    std::vector<LitPixel> lit;
    const auto bit = [&](std::size_t at) { return (std::to_integer<unsigned>(frame[at / 8]) >> (at % 8)) & 1u; };
    std::size_t row_start = 0;
    for (std::uint32_t slice = 0; slice < display.slices; ++slice) {
        for (std::uint32_t p = 0; p < display.panel_count; ++p) {
            const Panel& panel = display.panels[p];
            const std::size_t bits = bits_per_pixel(display.format);
            const std::size_t row_bits = (panel.columns * bits + 7) / 8 * 8;
            for (std::uint32_t row = 0; row < panel.rows; ++row, row_start += row_bits) {
                for (std::uint32_t column = 0; column < panel.columns; ++column) {
                    std::uint32_t code = 0;
                    for (std::size_t b = 0; b < bits; ++b) code |= bit(row_start + column * bits + b) << b;
                    if (code != 0) lit.push_back({slice, p, row, column, code});
                }
                for (std::size_t b = panel.columns * bits; b < row_bits && padding != nullptr; ++b) {
                    *padding = *padding || bit(row_start + b) != 0;
                }
            }
        }
    }
    return lit;
}

/// Where a pixel is on its panel, from the middle, as whoever looks at it sees it: the drawing in description.h.
inline glm::dvec2 on_panel_mm(const Panel& panel, std::uint32_t row, std::uint32_t column) {
    double a = (column - (panel.columns - 1) / 2.0) * panel.column_pitch_mm;
    double b = ((panel.rows - 1) / 2.0 - row) * panel.row_pitch_mm;
    if (panel.mirrored) a = -a;
    for (int turn = 0; turn < panel.turned; ++turn) {
        const double from = a;
        a = -b;
        b = from;
    }
    return {a, b};
}

/// Where a pixel of a rotor is lit: the drawing in description.h.
inline glm::dvec3 rotor_place_mm(const DisplayDescription& display, const LitPixel& pixel) {
    const Panel& panel = display.panels[pixel.panel];
    const double phase = display.sweep_deg * (pixel.slice + 0.5) / display.slices;
    const double theta = ((display.clockwise ? -phase : phase) + panel.angle_deg) / 360.0 * kTurn;
    const glm::dvec2 place = on_panel_mm(panel, pixel.row, pixel.column);
    const double tilt = panel.tilt_deg / 360.0 * kTurn;
    const double along = panel.shift_mm + place.x;
    const double out = panel.offset_mm + (pixel.column % 2 == 1 ? panel.skew_mm : 0.0) + place.y * std::sin(tilt);
    return {std::cos(theta) * along + std::sin(theta) * out, std::sin(theta) * along - std::cos(theta) * out,
            panel.lift_mm + place.y * std::cos(tilt)};
}

}  // namespace xorvox::test
