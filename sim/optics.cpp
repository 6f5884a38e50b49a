#include "sim/optics.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>

#include "sim/pixel_rows.h"
#include "sim/seats.h"
#include "sim/wiring.h"

namespace xorvox::sim {
namespace {

/// Height as a part of the stroke, at `part` of the time of an upward sweep; before and after it the plane is on its
/// way down, the mirror image of its way up.
double profile_height(const Motion& motion, double part) {
    part = std::abs(std::remainder(part, 2.0));
    switch (motion.profile) {
        case MotionProfile::Constant: return part;
        case MotionProfile::Sine: {
            const double sine = std::sin(std::numbers::pi / 2.0 * part);
            return sine * sine;
        }
        case MotionProfile::Table: {
            const double steps = part * (motion.table_size - 1.0);
            const double below = std::clamp(std::floor(steps), 0.0, motion.table_size - 2.0);
            const auto knot = static_cast<std::size_t>(below);
            return std::lerp(motion.table[knot], motion.table[knot + 1], steps - below);
        }
    }
    return 0.0;
}

double stack_height_mm(const DisplayDescription& display, double slice) {
    const std::span<const double> heights = display.plane_heights_mm;
    if (heights.size() < 2) {
        const double middle = heights.empty() ? 0.0 : heights[0];
        return middle + (2.0 * slice - (display.slices - 1.0)) * (display.plane_pitch_mm / 2.0);
    }
    const double last = static_cast<double>(heights.size()) - 2.0;
    const double below = std::clamp(std::floor(slice), 0.0, last);
    const auto plane = static_cast<std::size_t>(below);
    return std::lerp(heights[plane], heights[plane + 1], slice - below);
}

}  // namespace

double plane_height_mm(const DisplayDescription& display, double slice) {
    if (display.kind == DisplayKind::StackedPlanes) return stack_height_mm(display, slice);
    const Motion& motion = display.motion;
    const double part = std::lerp(motion.dead_zone, 1.0 - motion.dead_zone, (slice + 0.5) / display.slices);
    return motion.stroke_mm * profile_height(motion, part) - motion.stroke_mm / 2.0;
}

std::size_t count_lit(const DisplayDescription& display, std::span<const std::byte> page, const Faults& faults) {
    if (page.empty()) return 0;
    const std::uint32_t bits = bits_per_pixel(display.format);
    const std::uint32_t shown = PixelLight(display).shown_bits();
    std::size_t count = 0;
    Wiring(display, faults)
        .for_each_row(page, [&](std::uint32_t, std::uint32_t p, std::uint32_t, std::span<const std::byte> row) {
            for_each_lit(row, display.panels[p].columns, bits, shown, [&](std::uint32_t, std::uint32_t) { ++count; });
        });
    return count;
}

LightField expose(const DisplayDescription& display, std::span<const std::byte> page, std::uint8_t brightness,
                  const Faults& faults) {
    LightField field{PixelLight(display), brightness, {}};
    if (page.empty()) return field;
    assert(page.size() == frame_bytes(display));

    const std::uint32_t bits = bits_per_pixel(display.format);
    const std::uint32_t shown = field.pixels.shown_bits();
    field.flashes.reserve(count_lit(display, page, faults));
    std::optional<Seats> seats;
    Wiring(display, faults)
        .for_each_row(page, [&](std::uint32_t slice, std::uint32_t p, std::uint32_t row,
                                std::span<const std::byte> pixels) {
            if (row == 0) seats.emplace(display, p, slice, faults);
            for_each_lit(pixels, display.panels[p].columns, bits, shown, [&](std::uint32_t column, std::uint32_t code) {
                field.flashes.push_back({seats->place_mm(row, column), code, slice});
            });
        });
    return field;
}

}  // namespace xorvox::sim
