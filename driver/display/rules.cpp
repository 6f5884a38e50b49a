#include "driver/display/rules.h"

#include <fmt/format.h>

#include "driver/display/toml.h"
#include "voxelizer/lattice.h"

namespace xorvox::display {
namespace {

std::optional<Violation> check_key(std::string_view key, std::optional<std::size_t> panel, double value,
                                   const Range& range) {
    if (auto message = check(value, range)) return Violation{key, panel, std::move(*message)};
    return std::nullopt;
}

std::optional<Violation> check_panel(const DisplayDescription& display, std::size_t index) {
    const Panel& panel = display.panels[index];
    if (auto bad = check_key("columns", index, panel.columns, kPixels)) return bad;
    if (auto bad = check_key("rows", index, panel.rows, kPixels)) return bad;
    if (auto bad = check_key("column_pitch_mm", index, panel.column_pitch_mm, kPitchMm)) return bad;
    if (auto bad = check_key("row_pitch_mm", index, panel.row_pitch_mm, kPitchMm)) return bad;

    const bool rotates = display.kind == DisplayKind::RotatingPanel;
    const auto check_pose = [&](std::string_view key, double value, const Range& range) -> std::optional<Violation> {
        if (!rotates && value != 0.0) {
            return Violation{key, index,
                             fmt::format("found {}; allowed: 0, for planes are not mounted on a rotor", value)};
        }
        return check_key(key, index, value, range);
    };
    if (auto bad = check_pose("shift_mm", panel.shift_mm, kShiftMm)) return bad;
    if (auto bad = check_pose("offset_mm", panel.offset_mm, kShiftMm)) return bad;
    if (auto bad = check_pose("lift_mm", panel.lift_mm, kShiftMm)) return bad;
    if (auto bad = check_pose("angle_deg", panel.angle_deg, kAngleDeg)) return bad;

    // One table of heights serves all columns of the lattice.
    const Panel& first = display.panels[0];
    const auto check_same = [&](std::string_view key, double value, double first_value) -> std::optional<Violation> {
        if (value == first_value) return std::nullopt;
        return Violation{key, index,
                         fmt::format("found {}; allowed: {}, as on panel 1, for the panels of a display must have"
                                     " their rows at the same heights",
                                     value, first_value)};
    };
    if (auto bad = check_same("rows", panel.rows, first.rows)) return bad;
    if (auto bad = check_same("row_pitch_mm", panel.row_pitch_mm, first.row_pitch_mm)) return bad;
    return check_same("lift_mm", panel.lift_mm, first.lift_mm);
}

std::optional<Violation> check_sizes(const DisplayDescription& display) {
    const std::size_t bytes = frame_bytes(display);
    if (bytes > kMaxFrameBytes) {
        return Violation{"slices", std::nullopt,
                         fmt::format("found {}, which makes frames of {} bytes; allowed: at most {}", display.slices,
                                     bytes, kMaxFrameBytes)};
    }
    if (display.kind == DisplayKind::StackedPlanes) return std::nullopt;
    std::size_t columns = 0;
    for (std::size_t p = 0; p < display.panel_count; ++p) columns += display.panels[p].columns;
    if (columns * display.slices > kMaxLatticeColumns) {
        return Violation{
            "slices", std::nullopt,
            fmt::format("found {}, which with {} columns in all panels makes {} columns of samples; allowed: at"
                        " most {}",
                        display.slices, columns, columns * display.slices, kMaxLatticeColumns)};
    }
    return std::nullopt;
}

}  // namespace

std::string_view kind_name(DisplayKind kind) {
    return kind == DisplayKind::StackedPlanes ? "stacked-planes" : "rotating-panel";
}

std::optional<std::string> check(double value, const Range& range) {
    if (value >= range.lowest && value <= range.highest) return std::nullopt;
    return fmt::format("found {}; allowed: a {} from {} to {}", value, range.whole ? "whole number" : "number",
                       range.lowest, range.highest);
}

std::optional<Violation> find_violation(const DisplayDescription& display) {
    const bool rotates = display.kind == DisplayKind::RotatingPanel;
    if (!rotates && display.kind != DisplayKind::StackedPlanes) {
        return Violation{"kind", std::nullopt,
                         fmt::format("found number {}; allowed: 1 (stacked planes) or 2 (rotating panel)",
                                     static_cast<int>(display.kind))};
    }
    if (bits_per_pixel(display.format) == 0) {
        return Violation{
            "format", std::nullopt,
            fmt::format("found number {}; allowed: 1 (mono1) to 5 (rgb888)", static_cast<int>(display.format))};
    }
    if (auto bad = check_key("slices", std::nullopt, display.slices, kSlices)) return bad;
    if (auto bad = check_key("cycles_per_second", std::nullopt, display.cycles_per_second, kCyclesPerSecond))
        return bad;
    if (!rotates) {
        if (auto bad = check_key("plane_pitch_mm", std::nullopt, display.plane_pitch_mm, kPitchMm)) return bad;
        if (display.clockwise) {
            return Violation{"clockwise", std::nullopt, "found true; allowed: false, for planes do not turn"};
        }
    }
    const std::size_t most = rotates ? kMaxPanels : 1;
    if (display.panel_count < 1 || display.panel_count > most) {
        return Violation{"panel", std::nullopt,
                         fmt::format("found {} panels; allowed on {}: {}", display.panel_count, kind_name(display.kind),
                                     rotates ? "1 to 8" : "exactly one")};
    }
    for (std::size_t p = 0; p < display.panel_count; ++p) {
        if (auto bad = check_panel(display, p)) return bad;
    }
    return check_sizes(display);
}

}  // namespace xorvox::display

namespace xorvox {

Expected<void> validate_display(const DisplayDescription& display) {
    const auto bad = display::find_violation(display);
    if (!bad) return {};
    const std::string panel = bad->panel ? fmt::format("panel {}, ", *bad->panel + 1) : "";
    return fail(fmt::format("display \"{}\": {}{}: {}", display.name.view(), panel, bad->key, bad->message));
}

}  // namespace xorvox
