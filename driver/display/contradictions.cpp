// What contradicts itself in a description whose numbers are in order one by one: where the light is. How it is driven:
// driving_contradictions.cpp.
#include <algorithm>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "driver/display/lattice.h"
#include "driver/display/panel_faces.h"
#include "driver/display/rules.h"
#include "voxelizer/lattice.h"

namespace xorvox::display {
namespace {

using Violations = std::vector<Violation>;

void check_sizes(const DisplayDescription& display, Violations& violations) {
    const std::size_t bytes = frame_bytes(display);
    if (bytes > kMaxFrameBytes) {
        violations.push_back({"slices",
                              {},
                              fmt::format("found {}, which makes frames of {} bytes; allowed: at most {}",
                                          display.slices, bytes, kMaxFrameBytes),
                              {}});
    }
    const std::size_t columns = lattice_columns(display);
    if (columns <= kMaxLatticeColumns) return;
    const std::string_view why = display.kind != DisplayKind::RotatingPanel || is_upright(display)
                                     ? ""
                                     : "; a pixel counts as one, for the panels have no upright columns in common";
    violations.push_back({"slices",
                          {},
                          fmt::format("found {}, which makes {} columns of samples; allowed: at most {}{}",
                                      display.slices, columns, kMaxLatticeColumns, why),
                          {}});
}

void check_half_sweep(const DisplayDescription& display, Violations& violations) {
    if (display.kind != DisplayKind::RotatingPanel || display.sweep_deg == 360.0) return;
    if (display.panel_count > 1) {
        violations.push_back(
            {"sweep_deg",
             {},
             fmt::format("found 180 with {} panels; allowed with several panels: 360", display.panel_count),
             {}});
    }
    const Panel& panel = display.panels[0];
    const auto check_zero = [&](std::string_view key, double value) {
        if (value == 0.0) return;
        violations.push_back({key,
                              0,
                              fmt::format("found {}; allowed with sweep_deg = 180: 0, for half a turn later the"
                                          " panel must stand at the same place, mirrored",
                                          value),
                              {}});
    };
    check_zero("shift_mm", panel.shift_mm);
    check_zero("offset_mm", panel.offset_mm);
    check_zero("skew_mm", panel.skew_mm);
    check_zero("tilt_deg", panel.tilt_deg);
}

void check_motion(const DisplayDescription& display, Violations& violations) {
    const Motion& motion = display.motion;
    const bool has_table = motion.profile == MotionProfile::Table;
    if (has_table ? motion.table_size < 2 : motion.table_size != 0) {
        const std::string_view allowed = has_table ? "2 to 64" : "none, or profile = \"table\"";
        violations.push_back(
            {"motion.table", {}, fmt::format("found {} heights; allowed: {}", motion.table_size, allowed), {}});
        return;
    }
    if (!has_table) return;
    const auto refuse = [&](std::size_t i, std::string message) {
        violations.push_back({"motion.table", {}, std::move(message), i});
    };
    const std::size_t last = motion.table_size - 1;
    if (motion.table[0] != 0.0) {
        return refuse(0, fmt::format("found {} as the first height; allowed: 0", motion.table[0]));
    }
    for (std::size_t i = 1; i <= last; ++i) {
        if (motion.table[i] - motion.table[i - 1] >= kLeastTableStep) continue;
        return refuse(i, fmt::format("found {} after {}; allowed: heights that increase from 0 to 1 by {} or more",
                                     motion.table[i], motion.table[i - 1], kLeastTableStep));
    }
    if (motion.table[last] != 1.0) {
        refuse(last, fmt::format("found {} as the last height; allowed: 1", motion.table[last]));
    }
}

void check_plane_heights(const DisplayDescription& display, Violations& violations) {
    const auto heights = display.plane_heights_mm;
    if (heights.empty()) return;
    if (heights.size() != display.slices) {
        violations.push_back(
            {"plane_heights_mm",
             {},
             fmt::format("found {} heights; allowed: {}, one for each slice", heights.size(), display.slices),
             {}});
    }
    for (std::size_t i = 1; i < heights.size(); ++i) {
        if (heights[i] - heights[i - 1] >= kPitchMm.lowest) continue;
        violations.push_back({"plane_heights_mm",
                              {},
                              fmt::format("found {} after {}; allowed: heights that increase by"
                                          " {} or more",
                                          heights[i], heights[i - 1], kPitchMm.lowest),
                              i});
        return;
    }
}

void check_points(const DisplayDescription& display, Violations& violations) {
    if (display.kind != DisplayKind::FreePoints) return;
    const auto points = display.points;
    const std::size_t pixels = std::size_t{display.panels[0].columns} * display.panels[0].rows;
    if (points.size() != pixels) {
        violations.push_back({"points",
                              {},
                              fmt::format("found {} places; allowed: {}, one for each of {} × {} pixels", points.size(),
                                          pixels, display.panels[0].columns, display.panels[0].rows),
                              {}});
        return;
    }
    std::vector<std::size_t> order(points.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto place = [&](std::size_t i) { return std::tuple(points[i].x, points[i].y, points[i].z, i); };
    std::ranges::sort(order, {}, place);
    const auto twice = std::ranges::adjacent_find(order, [&](std::size_t a, std::size_t b) {
        return points[a].x == points[b].x && points[a].y == points[b].y && points[a].z == points[b].z;
    });
    if (twice == order.end()) return;
    const std::size_t first = *twice;
    const std::size_t second = *std::next(twice);
    violations.push_back({"points",
                          {},
                          fmt::format("found [{}, {}, {}] for LED {} and for LED {}; allowed: one LED a"
                                      " place",
                                      points[first].x, points[first].y, points[first].z, first, second),
                          second});
}

void check_wiring(const DisplayDescription& display, Violations& violations) {
    const auto is_at = [&](std::size_t p, std::uint8_t connector, std::uint8_t position) {
        return display.panels[p].connector == connector && display.panels[p].chain_position == position;
    };
    for (std::size_t p = 0; p < display.panel_count; ++p) {
        const Panel& panel = display.panels[p];
        for (std::size_t q = 0; q < p; ++q) {
            if (!is_at(q, panel.connector, panel.chain_position)) continue;
            violations.push_back({"chain_position",
                                  p,
                                  fmt::format("found {} on connector {}, where panel {} is already;"
                                              " give each panel its own place",
                                              panel.chain_position, panel.connector, q),
                                  {}});
            break;
        }
        bool has_previous = panel.chain_position == 0;
        for (std::size_t q = 0; q < display.panel_count && !has_previous; ++q) {
            has_previous = is_at(q, panel.connector, static_cast<std::uint8_t>(panel.chain_position - 1));
        }
        if (has_previous) continue;
        violations.push_back({"chain_position",
                              p,
                              fmt::format("found {}, but no panel is at {} on connector {};"
                                          " allowed: chains without gaps, from 0 on",
                                          panel.chain_position, panel.chain_position - 1, panel.connector),
                              {}});
    }
}

void check_faces(const DisplayDescription& display, Violations& violations) {
    for (std::size_t p = 0; p < display.panel_count; ++p) {
        for (std::size_t q = 0; q < p; ++q) {
            if (!faces_cross(display.panels[q], display.panels[p])) continue;
            violations.push_back({"",
                                  p,
                                  fmt::format("its face passes through or covers that of panel {}; move one of"
                                              " them by shift_mm, offset_mm, lift_mm or angle_deg",
                                              q),
                                  {}});
            break;
        }
    }
}

}  // namespace

std::vector<Violation> find_contradictions(const DisplayDescription& display, bool wiring_given) {
    Violations violations;
    check_sizes(display, violations);
    check_half_sweep(display, violations);
    check_motion(display, violations);
    check_plane_heights(display, violations);
    check_points(display, violations);
    if (wiring_given) check_wiring(display, violations);
    check_faces(display, violations);
    find_driving_contradictions(display, violations);
    return violations;
}

}  // namespace xorvox::display
