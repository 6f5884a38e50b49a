// What patterns are drawn with: codes that are wanted by name, places on a panel as it is mounted, and the loop over a
// frame's pixels.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "driver/display/lattice.h"
#include "driver/host/pattern.h"
#include "driver/host/pixel.h"

namespace xorvox::host {

/// The bits of channel 0 … channel_count − 1 (red, green, blue) in a pixel.
inline std::uint32_t channel_mask(PixelFormat format, std::uint32_t channel) {
    if (is_mono(format)) return (1u << bits_per_pixel(format)) - 1;
    return quantize({channel == 0 ? 1.0f : 0.0f, channel == 1 ? 1.0f : 0.0f, channel == 2 ? 1.0f : 0.0f}, format);
}

/// Full light in some of the channels: bit 0 red, bit 1 green, bit 2 blue. Of one colour only: full light.
inline std::uint32_t full_code(PixelFormat format, std::uint32_t rgb) {
    std::uint32_t code = 0;
    for (std::uint32_t channel = 0; channel < channel_count(format); ++channel) {
        if (is_mono(format) || ((rgb >> channel) & 1u) != 0) code |= channel_mask(format, channel);
    }
    return code;
}
inline constexpr std::uint32_t kRed = 1;
inline constexpr std::uint32_t kGreen = 2;
inline constexpr std::uint32_t kBlue = 4;
inline constexpr std::uint32_t kWhite = 7;

/// A panel's own colour; the eighth is white as well as the seventh.
inline std::uint32_t panel_code(PixelFormat format, std::uint32_t panel) {
    constexpr std::uint32_t kColors[kMaxPanels] = {kRed,           kGreen,       kBlue,  kRed | kGreen,
                                                   kGreen | kBlue, kRed | kBlue, kWhite, kWhite};
    return full_code(format, kColors[panel]);
}

/// A pixel of a frame by its place on the wire, and on its panel as whoever looks at it sees it.
struct PatternPixel {
    std::uint32_t slice;
    std::uint32_t panel;
    std::uint32_t row;
    std::uint32_t column;
    UprightPixel place;
};

/// Panels that do not turn lie flat: rows go upwards as seen from above.
inline UprightPixel place_on_panel(const DisplayDescription& display, std::uint32_t panel, std::uint32_t row,
                                   std::uint32_t column) {
    if (display.kind != DisplayKind::RotatingPanel) return {column, row};
    return upright_pixel(display.panels[panel], column, row);
}

/// Writes code_of(pixel) for every pixel of a frame; with `alike` slice 0 is asked for alone, and copied.
template <class CodeOf>
PatternLight paint_pixels(const DisplayDescription& display, std::span<std::byte> frame, bool alike, CodeOf code_of) {
    std::ranges::fill(frame, std::byte{0});
    PatternLight light;
    std::size_t offset = 0;
    for (std::uint32_t slice = 0; slice < (alike ? 1 : display.slices); ++slice) {
        std::uint64_t lit = 0;
        for (std::uint32_t p = 0; p < display.panel_count; ++p) {
            const Panel& panel = display.panels[p];
            const std::size_t bytes = row_bytes(panel, display.format);
            for (std::uint32_t row = 0; row < panel.rows; ++row, offset += bytes) {
                const std::span<std::byte> pixels = frame.subspan(offset, bytes);
                for (std::uint32_t column = 0; column < panel.columns; ++column) {
                    const std::uint32_t code =
                        code_of(PatternPixel{slice, p, row, column, place_on_panel(display, p, row, column)});
                    if (code == 0) continue;
                    put_pixel(pixels, column, display.format, code);
                    ++lit;
                }
            }
        }
        light.pixels += lit;
        light.most_in_slice = std::max(light.most_in_slice, lit);
    }
    if (alike) {
        light.pixels *= display.slices;
        for (std::uint32_t slice = 1; slice < display.slices; ++slice) {
            std::ranges::copy(frame.first(offset), frame.subspan(slice * offset).begin());
        }
    }
    return light;
}

/// The patterns that follow where pixels stand: pattern_geometry.cpp.
PatternLight paint_index(const DisplayDescription& display, std::span<std::byte> frame);
PatternLight paint_axis(const DisplayDescription& display, std::span<std::byte> frame);
PatternLight paint_wedge(const DisplayDescription& display, std::span<std::byte> frame);

}  // namespace xorvox::host
