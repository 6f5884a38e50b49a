// The patterns `index`, `axis` and `wedge`, which need to know where pixels stand.
#include <array>
#include <cmath>
#include <limits>

#include "driver/display/trigonometry.h"
#include "driver/host/pattern_canvas.h"

namespace xorvox::host {
namespace {

/// How far from the axis, along the panel, upright column `column` of a rotor's panel stands.
double along_mm(const Panel& panel, std::uint32_t column) {
    return panel.shift_mm + (column - 0.5 * (upright_columns(panel) - 1)) * upright_column_pitch_mm(panel);
}

std::uint32_t nearest_column(const Panel& panel, double mm) {
    const double column = std::round((mm - along_mm(panel, 0)) / upright_column_pitch_mm(panel));
    return static_cast<std::uint32_t>(std::clamp(column, 0.0, upright_columns(panel) - 1.0));
}

/// `number` from 0 to below `period`.
double wrapped(double number, double period) {
    const double rest = number - std::floor(number / period) * period;
    return rest < period ? rest : 0.0;
}

double phase_deg(const DisplayDescription& display, std::uint32_t slice) {
    return display.sweep_deg * (slice + 0.5) / display.slices;
}

/// Slices within `width` of `phase`.
bool is_near(const DisplayDescription& display, std::uint32_t slice, double phase, double width) {
    const double away = wrapped(phase_deg(display, slice) - phase, display.sweep_deg);
    // Half a slice to either side is there exactly; rounding must not decide.
    return std::min(away, display.sweep_deg - away) < width + display.sweep_deg * 1e-9;
}

bool reaches_right(const Panel& panel) {
    return along_mm(panel, upright_columns(panel) - 1) > 0.0;
}
bool reaches_left(const Panel& panel) {
    return along_mm(panel, 0) < 0.0;
}

/// One side of one panel draws a spoke from the axis outwards.
PatternLight paint_spokes(const DisplayDescription& display, std::span<std::byte> frame) {
    std::uint32_t drawer = 0;
    while (drawer + 1 < display.panel_count && !reaches_right(display.panels[drawer])) ++drawer;
    const Panel& panel = display.panels[drawer];
    const bool right = reaches_right(panel);
    const bool left = !right && reaches_left(panel);
    // When this side stands at the angle 0. A panel of one column above the axis is off it along its normal, or
    // nowhere.
    const double off_deg = panel.offset_mm < 0.0 ? 90.0 : -90.0;
    const double angle = panel.angle_deg + (right ? 0.0 : left ? 180.0 : off_deg);
    const double begin = display.clockwise ? angle : -angle;
    const double half_slice = 0.5 * display.sweep_deg / display.slices;
    constexpr double kHalfSpokeDeg = 4.0;
    return paint_pixels(display, frame, false, [&](const PatternPixel& pixel) -> std::uint32_t {
        if (pixel.panel != drawer) return 0;
        const double along = along_mm(panel, pixel.place.column);
        if ((right && along <= 0.0) || (left && along >= 0.0)) return 0;
        if (is_near(display, pixel.slice, begin, std::max(half_slice, kHalfSpokeDeg))) {
            return full_code(display.format, kWhite);
        }
        const bool dash = pixel.place.row % 4 < 2;
        return dash && is_near(display, pixel.slice, begin + 90.0, half_slice) ? full_code(display.format, kGreen) : 0;
    });
}

/// A side of a panel of a rotor, which draws its part of a circle about the axis.
struct Side {
    std::uint32_t panel;
    bool right;
    std::uint32_t column;  ///< Upright; the one at the circle's radius.
    double turns;          ///< Its polar angle at phase 0.
};

Side side_at(const DisplayDescription& display, std::uint32_t p, double mm) {
    const Panel& panel = display.panels[p];
    const std::uint32_t column = nearest_column(panel, mm);
    const glm::dvec2 place(along_mm(panel, column), -panel.offset_mm);
    return {p, mm >= 0.0, column, display::angle_turns(place) + panel.angle_deg / 360.0};
}

struct Sides {
    std::array<Side, 2 * kMaxPanels> sides;
    std::uint32_t count = 0;
};

Sides sides_of(const DisplayDescription& display) {
    double reach = std::numeric_limits<double>::infinity();
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        const Panel& panel = display.panels[p];
        if (reaches_right(panel)) reach = std::min(reach, along_mm(panel, upright_columns(panel) - 1));
        if (reaches_left(panel)) reach = std::min(reach, -along_mm(panel, 0));
    }
    if (!std::isfinite(reach)) reach = 0.0;  // a single column on the axis
    const double radius = 0.75 * reach;
    Sides found;
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        const Panel& panel = display.panels[p];
        const bool left = reaches_left(panel);
        if (reaches_right(panel) || !left) {
            found.sides[found.count++] = side_at(display, p, radius);
        }
        if (left) found.sides[found.count++] = side_at(display, p, -radius);
    }
    return found;
}

/// The band of the wall, and of the post, that `row` of a panel belongs to.
std::uint32_t band_of(std::uint32_t row, std::uint32_t rows, const Sides& sides) {
    return row * sides.count / rows;
}

/// How far upright column `column` stands out along the panel's normal, `up_mm` above the panel's middle.
double out_mm(const Panel& panel, std::uint32_t column, double up_mm) {
    double out = panel.offset_mm + up_mm * display::direction(panel.tilt_deg / 360.0).y;
    if (panel.turned % 2 == 1) return out;  // Then rows stand out, every other one.
    for (std::uint32_t c = 1; c < panel.columns; c += 2) {
        if (upright_pixel(panel, c, 0).column == column) out += panel.skew_mm;
    }
    return out;
}

PatternLight paint_rotor_axis(const DisplayDescription& display, std::span<std::byte> frame) {
    const Sides sides = sides_of(display);
    const std::uint32_t arcs = 2 * sides.count;
    return paint_pixels(display, frame, false, [&](const PatternPixel& pixel) -> std::uint32_t {
        const Panel& panel = display.panels[pixel.panel];
        const std::uint32_t rows = upright_rows(panel);
        const std::uint32_t code = panel_code(display.format, pixel.panel);
        const std::uint32_t band = band_of(pixel.place.row, rows, sides);
        // The post: what is nearer to the axis than a pitch. One panel a band, so that colours do not mix.
        if (std::abs(along_mm(panel, pixel.place.column)) < upright_column_pitch_mm(panel)) {
            return sides.sides[band].panel == pixel.panel ? code : 0;
        }
        const bool is_ring = rows > 2 && (pixel.place.row == 0 || pixel.place.row == rows - 1);
        for (std::uint32_t s = 0; s < sides.count; ++s) {
            const Side& side = sides.sides[s];
            if (side.panel != pixel.panel || side.column != pixel.place.column) continue;
            if (!is_ring) {
                if (band == s) return code;
                continue;
            }
            const double phase = phase_deg(display, pixel.slice) / 360.0;
            const double place = wrapped(side.turns + (display.clockwise ? -phase : phase), 1.0);
            if (static_cast<std::uint32_t>(place * arcs) % sides.count == s) return code;
        }
        return 0;
    });
}

/// Two rectangles, or on a helix circles, about the middle of panel 0, in every slice.
PatternLight paint_outlines(const DisplayDescription& display, std::span<std::byte> frame) {
    const Panel& panel = display.panels[0];
    const double half_width = 0.5 * panel.columns * panel.column_pitch_mm;
    const double half_height = 0.5 * panel.rows * panel.row_pitch_mm;
    const double radius = 0.5 * std::min(half_width, half_height);
    const double half_pitch = 0.5 * std::max(panel.column_pitch_mm, panel.row_pitch_mm);
    return paint_pixels(display, frame, true, [&](const PatternPixel& pixel) -> std::uint32_t {
        const std::uint32_t column = std::min<std::uint32_t>(pixel.column, panel.columns - 1 - pixel.column);
        const std::uint32_t row = std::min<std::uint32_t>(pixel.row, panel.rows - 1 - pixel.row);
        if (display.kind == DisplayKind::Helix) {
            const double x = (pixel.column - 0.5 * (panel.columns - 1)) * panel.column_pitch_mm;
            const double y = (pixel.row - 0.5 * (panel.rows - 1)) * panel.row_pitch_mm;
            const double away = std::sqrt(x * x + y * y);
            if (std::abs(away - 1.75 * radius) < half_pitch) return full_code(display.format, kRed);
            return std::abs(away - radius) < half_pitch ? full_code(display.format, kGreen) : 0;
        }
        if (column == 0 || row == 0) return full_code(display.format, kRed);
        const std::uint32_t inner_column = panel.columns / 4;
        const std::uint32_t inner_row = panel.rows / 4;
        const bool inside = column >= inner_column && row >= inner_row;
        return inside && (column == inner_column || row == inner_row) ? full_code(display.format, kGreen) : 0;
    });
}

/// The points farthest out along each axis.
PatternLight paint_extremes(const DisplayDescription& display, std::span<std::byte> frame) {
    const auto coordinate = [&](std::size_t point, std::uint32_t axis) {
        const PointMm& place = display.points[point];
        return axis == 0 ? place.x : axis == 1 ? place.y : place.z;
    };
    std::array<std::size_t, 6> farthest{};
    for (std::size_t point = 0; point < display.points.size(); ++point) {
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            if (coordinate(point, axis) < coordinate(farthest[axis], axis)) farthest[axis] = point;
            if (coordinate(point, axis) > coordinate(farthest[3 + axis], axis)) farthest[3 + axis] = point;
        }
    }
    return paint_pixels(display, frame, true, [&](const PatternPixel& pixel) -> std::uint32_t {
        const std::size_t point = std::size_t{pixel.row} * display.panels[0].columns + pixel.column;
        std::uint32_t code = 0;
        for (std::uint32_t i = 0; i < farthest.size(); ++i) {
            if (farthest[i] == point) code |= full_code(display.format, 1u << (i % 3));
        }
        return code;
    });
}

/// Step `index` of `count`, of all levels but the dark one, as a shade of grey.
std::uint32_t wedge_code(PixelFormat format, std::uint32_t index, std::uint32_t count) {
    const std::uint32_t brightest = (1u << bits_per_channel(format)) - 1;
    std::uint32_t level = brightest;
    if (count > 1) level = 1 + (index * (brightest - 1) + (count - 1) / 2) / (count - 1);
    return visible_code(glm::vec3(static_cast<float>(level) / static_cast<float>(brightest)), format);
}

/// Columns from the axis to the farthest one of `panel`, and of them the one with `column`.
struct ColumnsOutwards {
    std::uint32_t index;
    std::uint32_t count;
};
ColumnsOutwards outwards(const DisplayDescription& display, const Panel& panel, std::uint32_t column) {
    const std::uint32_t columns = upright_columns(panel);
    if (display.kind != DisplayKind::RotatingPanel) return {column, columns};
    const double first = along_mm(panel, 0);
    const double last = along_mm(panel, columns - 1);
    const double nearest = first > 0.0 ? first : last < 0.0 ? -last : 0.0;
    const double pitch = upright_column_pitch_mm(panel);
    const auto steps = [&](double mm) { return static_cast<std::uint32_t>((std::abs(mm) - nearest) / pitch + 1e-9); };
    return {steps(along_mm(panel, column)), steps(std::max(std::abs(first), std::abs(last))) + 1};
}

}  // namespace

PatternLight paint_wedge(const DisplayDescription& display, std::span<std::byte> frame) {
    return paint_pixels(display, frame, false, [&](const PatternPixel& pixel) {
        const Panel& panel = display.panels[pixel.panel];
        const std::uint32_t third = upright_rows(panel) / 3;
        if (pixel.place.row < third) return wedge_code(display.format, pixel.place.row, third);
        if (pixel.place.row < 2 * third && display.slices > 1) {
            return wedge_code(display.format, pixel.slice, display.slices);
        }
        const ColumnsOutwards place = outwards(display, panel, pixel.place.column);
        return wedge_code(display.format, place.index, place.count);
    });
}

PatternLight paint_index(const DisplayDescription& display, std::span<std::byte> frame) {
    if (display.kind == DisplayKind::RotatingPanel) return paint_spokes(display, frame);
    const Panel& panel = display.panels[0];
    const std::uint32_t second = index_border_slice(display);
    const std::uint32_t pixels = std::uint32_t{panel.columns} * panel.rows;
    return paint_pixels(display, frame, false, [&](const PatternPixel& pixel) -> std::uint32_t {
        if (display.slices == 1) {
            const std::uint32_t number = pixel.row * panel.columns + pixel.column;
            if (number == 0) return full_code(display.format, kWhite);
            return number == pixels / 4 ? full_code(display.format, kGreen) : 0;
        }
        if (pixel.slice == 0) return full_code(display.format, kWhite);
        const bool border =
            pixel.column == 0 || pixel.row == 0 || pixel.column == panel.columns - 1u || pixel.row == panel.rows - 1u;
        return pixel.slice == second && border ? full_code(display.format, kGreen) : 0;
    });
}

std::uint32_t index_border_slice(const DisplayDescription& display) {
    return std::max(1u, display.slices / 4);
}

std::vector<AxisBand> axis_bands(const DisplayDescription& display) {
    std::vector<AxisBand> bands;
    if (display.kind != DisplayKind::RotatingPanel) return bands;
    const Sides sides = sides_of(display);
    for (std::uint32_t s = 0; s < sides.count; ++s) {
        const Side& side = sides.sides[s];
        const Panel& panel = display.panels[side.panel];
        const double middle = 0.5 * (upright_rows(panel) - 1);
        const double pitch = upright_row_pitch_mm(panel);
        const double up = ((s + 0.5) * upright_rows(panel) / sides.count - 0.5 - middle) * pitch;
        const double along = along_mm(panel, side.column);
        const double out = out_mm(panel, side.column, up);
        const double arc = middle * pitch * display::direction(panel.tilt_deg / 360.0).x;
        bands.push_back(
            {side.panel, side.right, std::sqrt(along * along + out * out), panel.lift_mm - arc, panel.lift_mm + arc});
    }
    return bands;
}

PatternLight paint_axis(const DisplayDescription& display, std::span<std::byte> frame) {
    switch (display.kind) {
        case DisplayKind::RotatingPanel: return paint_rotor_axis(display, frame);
        case DisplayKind::FreePoints: return paint_extremes(display, frame);
        default: return paint_outlines(display, frame);
    }
}

}  // namespace xorvox::host
