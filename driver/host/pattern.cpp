#include "driver/host/pattern.h"

#include <array>
#include <string>

#include "driver/host/pattern_canvas.h"

namespace xorvox::host {
namespace {

constexpr std::array kPatterns{
    PatternInfo{Pattern::Panels, "panels", "which panel is which: panel p shows p + 1 bars in its own colour", false,
                true},
    PatternInfo{Pattern::Orientation, "orientation", "is a panel mirrored or turned: an F, the same in every slice",
                false, true},
    PatternInfo{Pattern::Stairs, "stairs", "are slices in order: a staircase without a missing or swapped step"},
    PatternInfo{Pattern::Index, "index",
                "where a cycle begins, and which way it goes: a bright plane, then a thin one"},
    PatternInfo{Pattern::Axis, "axis", "is the axis off, and by whose fault: a wall in bands, one a panel's side"},
    PatternInfo{Pattern::Wedge, "wedge", "is light even: all levels along columns, slices and rows"},
    PatternInfo{Pattern::All, "all", "is a pixel dead: every one at its faintest"},
    PatternInfo{Pattern::Planes, "planes", "is a colour or a bit missing or swapped: each by itself, a second each",
                true},
    PatternInfo{Pattern::Lines, "lines", "is a row or column missing or swapped: one after the other, ten a second",
                true, true},
    PatternInfo{Pattern::Walk, "walk", "is a wire swapped: one voxel after the other, one a cycle", true},
};

/// Cycles for which a step stays that is to be seen for `seconds`.
std::uint64_t cycles_of(const DisplayDescription& display, double seconds) {
    const double cycles = display.cycles_per_second * seconds;
    return cycles < 1.0 ? 1 : static_cast<std::uint64_t>(cycles + 0.5);
}
constexpr double kBitSeconds = 1.0;
constexpr double kLineSeconds = 0.1;

std::uint64_t line_count(const DisplayDescription& display) {
    std::uint64_t lines = 0;
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        lines += std::uint64_t{display.panels[p].rows} + display.panels[p].columns;
    }
    return lines;
}

PatternLight paint_panels(const DisplayDescription& display, std::span<std::byte> frame) {
    return paint_pixels(display, frame, true, [&](const PatternPixel& pixel) -> std::uint32_t {
        const Panel& panel = display.panels[pixel.panel];
        const std::uint32_t bars = pixel.panel + 1;
        const std::uint32_t parts = 2 * bars + 1;
        bool lit = false;
        if (upright_columns(panel) >= parts) {
            lit = pixel.place.column * parts / upright_columns(panel) % 2 == 1;
        } else if (upright_rows(panel) >= parts) {
            lit = pixel.place.row * parts / upright_rows(panel) % 2 == 1;
        } else {
            lit = pixel.row * panel.columns + pixel.column < bars;
        }
        return lit ? panel_code(display.format, pixel.panel) : 0;
    });
}

/// An F that fills a panel: no turn and no mirror makes it itself. On a panel that is too small for its second bar, a
/// hook of unequal arms.
PatternLight paint_orientation(const DisplayDescription& display, std::span<std::byte> frame) {
    return paint_pixels(display, frame, true, [&](const PatternPixel& pixel) -> std::uint32_t {
        const Panel& panel = display.panels[pixel.panel];
        const std::uint32_t columns = upright_columns(panel);
        const std::uint32_t rows = upright_rows(panel);
        const std::uint32_t thick = std::max(1u, std::min(columns, rows) / 8);
        const std::uint32_t from_left = pixel.place.column;
        const std::uint32_t from_top = rows - 1 - pixel.place.row;
        bool lit = from_top < thick;
        if (columns >= 3 && rows >= 5) {
            const std::uint32_t bar = rows / 2 - thick / 2;
            lit =
                lit || from_left < thick || (from_top >= bar && from_top < bar + thick && from_left < columns * 2 / 3);
        } else {
            lit = lit || (from_left == 0 && (columns != rows || from_top < 2));
        }
        return lit ? panel_code(display.format, pixel.panel) : 0;
    });
}

PatternLight paint_stairs(const DisplayDescription& display, std::span<std::byte> frame) {
    return paint_pixels(display, frame, false, [&](const PatternPixel& pixel) -> std::uint32_t {
        const Panel& panel = display.panels[pixel.panel];
        if (display.slices == 1) {
            const std::uint32_t number = pixel.row * panel.columns + pixel.column;
            if (number % 10 != 0) return 0;
            return full_code(display.format, number % 100 == 0 ? kRed : kWhite);
        }
        const std::uint32_t columns = upright_columns(panel);
        const std::uint32_t first = pixel.slice * columns / display.slices;
        const std::uint32_t end = std::max(first + 1, (pixel.slice + 1) * columns / display.slices);
        if (pixel.place.column < first || pixel.place.column >= end) return 0;
        return panel_code(display.format, pixel.panel);
    });
}

PatternLight paint_all(const DisplayDescription& display, std::span<std::byte> frame) {
    std::uint32_t faintest = 0;
    for (std::uint32_t channel = 0; channel < channel_count(display.format); ++channel) {
        const std::uint32_t mask = channel_mask(display.format, channel);
        const auto bits = static_cast<std::uint32_t>(std::popcount(mask));
        const std::uint32_t hidden = bits - std::min(bits, shown_bit_planes(display));
        faintest |= 1u << (static_cast<std::uint32_t>(std::countr_zero(mask)) + hidden);
    }
    return paint_pixels(display, frame, true, [&](const PatternPixel&) { return faintest; });
}

/// Red before green before blue; of each, the most significant bit first.
PatternLight paint_plane(const DisplayDescription& display, std::uint32_t number, std::span<std::byte> frame) {
    std::uint32_t channel = 0;
    std::uint32_t mask = channel_mask(display.format, channel);
    while (number >= static_cast<std::uint32_t>(std::popcount(mask))) {
        number -= static_cast<std::uint32_t>(std::popcount(mask));
        mask = channel_mask(display.format, ++channel);
    }
    const std::uint32_t code = 1u << (static_cast<std::uint32_t>(std::bit_width(mask)) - 1 - number);
    return paint_pixels(display, frame, true, [&](const PatternPixel&) { return code; });
}

PatternLight paint_line(const DisplayDescription& display, std::uint64_t number, std::span<std::byte> frame) {
    std::uint32_t panel = 0;
    while (number >= std::uint64_t{display.panels[panel].rows} + display.panels[panel].columns) {
        number -= std::uint64_t{display.panels[panel].rows} + display.panels[panel].columns;
        ++panel;
    }
    const std::uint32_t rows = display.panels[panel].rows;
    return paint_pixels(display, frame, true, [&](const PatternPixel& pixel) -> std::uint32_t {
        if (pixel.panel != panel) return 0;
        const bool lit = number < rows ? pixel.row == number : pixel.column == number - rows;
        return lit ? panel_code(display.format, panel) : 0;
    });
}

PatternLight paint_walk(const DisplayDescription& display, std::uint64_t number, std::span<std::byte> frame) {
    std::ranges::fill(frame, std::byte{0});
    const std::uint64_t slice_pixels = frame_pixels(display) / display.slices;
    std::size_t offset = number / slice_pixels * slice_bytes(display);
    std::uint64_t rest = number % slice_pixels;
    std::uint32_t p = 0;
    for (; rest >= std::uint64_t{display.panels[p].columns} * display.panels[p].rows; ++p) {
        rest -= std::uint64_t{display.panels[p].columns} * display.panels[p].rows;
        offset += row_bytes(display.panels[p], display.format) * display.panels[p].rows;
    }
    const Panel& panel = display.panels[p];
    const std::size_t bytes = row_bytes(panel, display.format);
    put_pixel(frame.subspan(offset + rest / panel.columns * bytes, bytes),
              static_cast<std::uint32_t>(rest % panel.columns), display.format, full_code(display.format, kWhite));
    return {1, 1};
}

}  // namespace

std::span<const PatternInfo> patterns() {
    return kPatterns;
}

Expected<PatternInfo> find_pattern(std::string_view name) {
    std::string names;
    for (const PatternInfo& info : kPatterns) {
        if (info.name == name) return info;
        names += names.empty() ? "" : ", ";
        names += info.name;
    }
    return fail("there is no pattern '" + std::string(name) + "'; there are " + names);
}

std::uint64_t pattern_frames(const DisplayDescription& display, Pattern pattern) {
    switch (pattern) {
        case Pattern::Planes: return bits_per_pixel(display.format) * cycles_of(display, kBitSeconds);
        case Pattern::Lines: return line_count(display) * cycles_of(display, kLineSeconds);
        case Pattern::Walk: return frame_pixels(display);
        default: return 1;
    }
}

PatternLight paint_pattern(const DisplayDescription& display, Pattern pattern, std::uint64_t number,
                           std::span<std::byte> frame) {
    number %= pattern_frames(display, pattern);
    switch (pattern) {
        case Pattern::Panels: return paint_panels(display, frame);
        case Pattern::Orientation: return paint_orientation(display, frame);
        case Pattern::Stairs: return paint_stairs(display, frame);
        case Pattern::Index: return paint_index(display, frame);
        case Pattern::Axis: return paint_axis(display, frame);
        case Pattern::Wedge: return paint_wedge(display, frame);
        case Pattern::All: return paint_all(display, frame);
        case Pattern::Planes:
            return paint_plane(display, static_cast<std::uint32_t>(number / cycles_of(display, kBitSeconds)), frame);
        case Pattern::Lines: return paint_line(display, number / cycles_of(display, kLineSeconds), frame);
        case Pattern::Walk: return paint_walk(display, number, frame);
    }
    return {};
}

}  // namespace xorvox::host
