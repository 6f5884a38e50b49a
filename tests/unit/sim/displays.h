// Small displays, and pages written pixel by pixel, for the simulator's tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "driver/display/description.h"

namespace xorvox::test {

/// A pixel's place in a page.
struct Pixel {
    std::uint32_t slice = 0;
    std::uint32_t panel = 0;
    std::uint32_t row = 0;
    std::uint32_t column = 0;
};

/// Writes `code` bit by bit into a page that is in scan-out order.
inline void set_pixel(const DisplayDescription& display, std::vector<std::byte>& page, const Pixel& pixel,
                      std::uint32_t code) {
    std::size_t start = pixel.slice * slice_bytes(display);
    for (std::uint32_t p = 0; p < pixel.panel; ++p) {
        start += row_bytes(display.panels[p], display.format) * display.panels[p].rows;
    }
    start += pixel.row * row_bytes(display.panels[pixel.panel], display.format);
    const std::uint32_t bits = bits_per_pixel(display.format);
    for (std::uint32_t bit = 0; bit < bits; ++bit) {
        const std::size_t at = std::size_t{pixel.column} * bits + bit;
        if (((code >> bit) & 1u) != 0) page[start + at / 8] |= std::byte{1} << (at % 8);
    }
}

inline std::vector<std::byte> dark_page(const DisplayDescription& display) {
    return std::vector<std::byte>(frame_bytes(display));
}

/// A stack whose three pitches differ.
constexpr DisplayDescription stack_of(std::uint16_t columns, std::uint16_t rows, std::uint32_t planes,
                                      PixelFormat format = PixelFormat::Mono1) {
    DisplayDescription display;
    display.name = DisplayName("stack");
    display.format = format;
    display.slices = planes;
    display.plane_pitch_mm = 7.0;
    display.cycles_per_second = 100.0;
    display.panels[0] = {.columns = columns, .rows = rows, .column_pitch_mm = 2.0, .row_pitch_mm = 3.0};
    return display;
}

/// Two panels back to back, 3 mm from the axis, with pixels 2 mm wide and 4 mm high.
constexpr DisplayDescription rotor_of(std::uint16_t columns, std::uint16_t rows, std::uint32_t slices,
                                      PixelFormat format = PixelFormat::Mono1, std::uint32_t panels = 2) {
    DisplayDescription display;
    display.name = DisplayName("rotor");
    display.kind = DisplayKind::RotatingPanel;
    display.format = format;
    display.slices = slices;
    display.cycles_per_second = 25.0;
    display.panel_count = panels;
    for (std::uint32_t p = 0; p < panels; ++p) {
        display.panels[p] = {.columns = columns,
                             .rows = rows,
                             .column_pitch_mm = 2.0,
                             .row_pitch_mm = 4.0,
                             .offset_mm = 3.0,
                             .angle_deg = 180.0 * p};
    }
    return display;
}

/// A plane that sweeps 60 mm, with pixels 2 mm wide and 3 mm deep.
constexpr DisplayDescription swept_of(std::uint16_t columns, std::uint16_t rows, std::uint32_t slices,
                                      MotionProfile profile, PixelFormat format = PixelFormat::Mono1) {
    DisplayDescription display = stack_of(columns, rows, slices, format);
    display.name = DisplayName("swept");
    display.kind = DisplayKind::SweptPlane;
    display.cycles_per_second = 15.0;
    display.motion.stroke_mm = 60.0;
    display.motion.profile = profile;
    if (profile == MotionProfile::Table) {
        constexpr double kHeights[] = {0.0, 0.1, 0.5, 1.0};
        display.motion.table_size = 4;
        for (std::size_t i = 0; i < 4; ++i) display.motion.table[i] = kHeights[i];
    }
    return display;
}

/// A helix 40 mm high under pixels of 2 mm by 3 mm.
constexpr DisplayDescription helix_of(std::uint16_t columns, std::uint16_t rows, std::uint32_t slices,
                                      std::uint32_t blades, PixelFormat format = PixelFormat::Mono1) {
    DisplayDescription display = stack_of(columns, rows, slices, format);
    display.name = DisplayName("helix");
    display.kind = DisplayKind::Helix;
    display.motion.stroke_mm = 40.0;
    display.blades = blades;
    return display;
}

/// Points in no order. Two of them are at one place.
inline constexpr PointMm kPoints[] = {{3.0, 4.0, 5.0},   {-3.5, 1.25, 0.0}, {0.0, 0.0, 9.0},    {3.0, 4.0, -5.0},
                                      {-7.0, -2.0, 1.5}, {8.5, -6.0, 2.0},  {-3.5, 1.25, -0.5}, {1.0, 2.0, 3.0},
                                      {6.0, 6.0, -6.0},  {0.0, 0.0, 9.0}};

/// Free points, five on each of two strings.
constexpr DisplayDescription points_of(PixelFormat format = PixelFormat::Mono1) {
    DisplayDescription display = stack_of(5, 2, 1, format);
    display.name = DisplayName("points");
    display.kind = DisplayKind::FreePoints;
    display.points = kPoints;
    return display;
}

}  // namespace xorvox::test
