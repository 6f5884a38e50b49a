// Description: what a display is, in plain constexpr structs that firmware, host and simulator share.
//
// The world's frame is in millimetres, right-handed, z up. A display is a set of LEDs or projected pixels on flat
// panels; what makes it volumetric is where the panels are at each phase of its cycle:
//
//   stacked planes   `slices` copies of panel 0, one above the other, `plane_pitch_mm` apart, the stack's centre at the
//                    origin. Plane 0 is the lowest. Columns run along +x, rows along +y. No motion.
//
//   rotating panel   `panel_count` panels that turn about the z axis. At phase 0 a panel with angle_deg = 0 stands
//                    in the xz plane: columns run along +x, rows downwards (row 0 is the top one), its normal is -y.
//
//                                 z, axis
//                      row 0   ┌────┼────┐          From above, turning counter-clockwise by θ = phase + angle_deg:
//                              │    │    │            along  u = ( cos θ, sin θ)     columns
//                      row 63  └────┼────┘            normal n = ( sin θ, -cos θ)    towards who looks at it
//                         column 0 … 127              LED    = u·(shift_mm + (column − (columns−1)/2)·column_pitch_mm)
//                                                            + n·offset_mm
//                    Slice s of S is lit while the phase is between s and s + 1 S-ths of a turn; its samples stand
//                    where the LEDs are in the middle of that, at (s + ½)/S of a turn. One frame is one turn. With
//                    `clockwise` the phase runs the other way: θ = −phase + angle_deg.
//
// A frame on the wire, and a page of the device, is in scan-out order:
//
//   slice 0: panel 0: row 0: column 0, 1, 2 …, row 1 …; panel 1 …; slice 1 …
//
// Pixels of a row follow each other without gaps, least significant bit first; each row begins at a byte. Column c of a
// row has the bits c·bpp … c·bpp + bpp − 1. Bits within a pixel, least significant first:
//
//   mono1   lit                      rgb111  R, G, B
//   rgb332  B1 B0, G2…G0, R2…R0      (a byte RRRGGGBB)
//   rgb565  B4…B0, G5…G0, R4…R0      (a little-endian 16-bit word RRRRRGGGGGGBBBBB)
//   rgb888  R7…R0, G7…G0, B7…B0      (bytes R, G, B)
//
// Codes are proportional to light. Freestanding; everyone may include this file.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "voxelizer/status.h"

namespace xorvox {

/// What the panels do. The numbers are part of the geometry digest: never renumber.
enum class DisplayKind : std::uint8_t { StackedPlanes = 1, RotatingPanel = 2 };

/// Bits of a pixel; the drawing at the head of this file. The numbers are on the wire: never renumber.
enum class PixelFormat : std::uint8_t { Mono1 = 1, Rgb111 = 2, Rgb332 = 3, Rgb565 = 4, Rgb888 = 5 };

constexpr std::uint32_t bits_per_pixel(PixelFormat format) {
    switch (format) {
        case PixelFormat::Mono1: return 1;
        case PixelFormat::Rgb111: return 3;
        case PixelFormat::Rgb332: return 8;
        case PixelFormat::Rgb565: return 16;
        case PixelFormat::Rgb888: return 24;
    }
    return 0;
}

constexpr std::string_view to_string(PixelFormat format) {
    switch (format) {
        case PixelFormat::Mono1: return "mono1";
        case PixelFormat::Rgb111: return "rgb111";
        case PixelFormat::Rgb332: return "rgb332";
        case PixelFormat::Rgb565: return "rgb565";
        case PixelFormat::Rgb888: return "rgb888";
    }
    return "unknown";
}

/// A name of at most 31 bytes of UTF-8, zero-padded: it has a fixed place in firmware and on the wire.
struct DisplayName {
    std::array<char, 32> text{};

    constexpr DisplayName() = default;
    /// Cuts after 31 bytes.
    constexpr DisplayName(std::string_view from) {
        for (std::size_t i = 0; i < from.size() && i + 1 < text.size(); ++i) text[i] = from[i];
    }
    constexpr std::string_view view() const {
        std::size_t n = 0;
        while (n < text.size() && text[n] != '\0') ++n;
        return {text.data(), n};
    }
};

/// One flat panel of columns × rows pixels and its place on the display; the drawing at the head of this file.
struct Panel {
    std::uint16_t columns = 0;     ///< 1 … 4096.
    std::uint16_t rows = 0;        ///< 1 … 4096.
    double column_pitch_mm = 1.0;  ///< Between neighbours of a row; positive.
    double row_pitch_mm = 1.0;     ///< Between rows; positive.
    double shift_mm = 0.0;   ///< Of the panel's centre along its columns: half a pitch where the axis is on an LED.
                             ///< Rotating panels only.
    double offset_mm = 0.0;  ///< Of the light from the axis, along the panel's normal. Rotating panels only.
    double lift_mm = 0.0;    ///< Of the panel's centre along z. Rotating panels only.
    double angle_deg =
        0.0;  ///< How it is mounted about the axis: 180 for the back one of a pair. Rotating panels only.
};

inline constexpr std::size_t kMaxPanels = 8;
inline constexpr std::uint32_t kMaxSlices = 4096;

/// A whole display. Build one in firmware as a constexpr, or read it from TOML (driver/display/toml.h).
struct DisplayDescription {
    DisplayName name;
    DisplayKind kind = DisplayKind::StackedPlanes;
    PixelFormat format = PixelFormat::Mono1;
    std::uint32_t slices = 0;        ///< Planes of a stack; slices of a turn. 1 … kMaxSlices.
    double plane_pitch_mm = 1.0;     ///< Stacked planes only.
    double cycles_per_second = 0.0;  ///< Turns or refreshes a second; positive.
    bool clockwise = false;          ///< Seen from above. Rotating panels only.
    std::uint32_t panel_count = 1;   ///< 1 … kMaxPanels; 1 on stacked planes.
    std::array<Panel, kMaxPanels> panels{};
};

/// Bytes of one row of `panel`.
constexpr std::size_t row_bytes(const Panel& panel, PixelFormat format) {
    return (std::size_t{panel.columns} * bits_per_pixel(format) + 7) / 8;
}
/// Bytes of one slice: every row of every panel.
constexpr std::size_t slice_bytes(const DisplayDescription& display) {
    std::size_t bytes = 0;
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        bytes += row_bytes(display.panels[p], display.format) * display.panels[p].rows;
    }
    return bytes;
}
/// Bytes of one frame, which is one page of the device.
constexpr std::size_t frame_bytes(const DisplayDescription& display) {
    return slice_bytes(display) * display.slices;
}
/// Pixels of one frame.
constexpr std::size_t frame_pixels(const DisplayDescription& display) {
    std::size_t pixels = 0;
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        pixels += std::size_t{display.panels[p].columns} * display.panels[p].rows;
    }
    return pixels * display.slices;
}
/// Length of a turn or refresh in nanoseconds.
constexpr std::uint64_t cycle_ns(const DisplayDescription& display) {
    return static_cast<std::uint64_t>(1e9 / display.cycles_per_second + 0.5);
}

/// A number that differs when the meaning of a frame's bytes differs: kind, format, slices and every pose, but neither
/// the name nor the speed. Host and device compare it before a frame is sent. FNV-1a over the fields, 64 bits.
constexpr std::uint64_t geometry_digest(const DisplayDescription& display) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    const auto add = [&hash](std::uint64_t value) {
        for (int byte = 0; byte < 8; ++byte) {
            hash = (hash ^ ((value >> (8 * byte)) & 0xff)) * 0x100000001b3u;
        }
    };
    // -0 is 0; told apart by its bits, because firmware computes this without floating point.
    const auto add_mm = [&add](double value) {
        const auto bits = std::bit_cast<std::uint64_t>(value);
        add(bits == std::uint64_t{1} << 63 ? 0 : bits);
    };
    const bool rotates = display.kind == DisplayKind::RotatingPanel;
    add(static_cast<std::uint64_t>(display.kind));
    add(static_cast<std::uint64_t>(display.format));
    add(display.slices);
    add_mm(rotates ? 0.0 : display.plane_pitch_mm);
    add(rotates && display.clockwise);
    add(display.panel_count);
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        const Panel& panel = display.panels[p];
        add(panel.columns);
        add(panel.rows);
        add_mm(panel.column_pitch_mm);
        add_mm(panel.row_pitch_mm);
        add_mm(panel.shift_mm);
        add_mm(rotates ? panel.offset_mm : 0.0);
        add_mm(rotates ? panel.lift_mm : 0.0);
        add_mm(rotates ? panel.angle_deg : 0.0);
    }
    return hash;
}

}  // namespace xorvox
