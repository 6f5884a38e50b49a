// What contradicts itself in a description whose numbers are in order one by one.
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "driver/display/lattice.h"
#include "driver/display/names.h"
#include "driver/display/panel_faces.h"
#include "driver/display/rules.h"
#include "driver/display/timing.h"
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

void check_sync(const DisplayDescription& display, Violations& violations) {
    const Sync& sync = display.sync;
    const double speed = display.cycles_per_second;
    const auto refuse = [&](std::string_view key, std::string message) {
        violations.push_back({key, {}, std::move(message), {}});
    };
    if (sync.index == IndexSource::None) {
        const auto check_unused = [&](std::string_view key, double value, double unused) {
            if (value != unused)
                refuse(key, fmt::format("found {}, but index = \"none\"; allowed then: {}", value, unused));
        };
        check_unused("sync.index_pulses", sync.index_pulses, 1.0);
        check_unused("sync.index_phase", sync.index_phase, 0.0);
        check_unused("sync.slowest_cycles_per_second", sync.slowest_cycles_per_second, 0.0);
        check_unused("sync.fastest_cycles_per_second", sync.fastest_cycles_per_second, 0.0);
        return;
    }
    if (sync.slowest_cycles_per_second != 0.0 && !(sync.slowest_cycles_per_second < speed)) {
        refuse("sync.slowest_cycles_per_second",
               fmt::format("found {}; allowed: less than cycles_per_second, which is {}",
                           sync.slowest_cycles_per_second, speed));
    }
    if (sync.fastest_cycles_per_second != 0.0 && !(sync.fastest_cycles_per_second > speed)) {
        refuse("sync.fastest_cycles_per_second",
               fmt::format("found {}; allowed: more than cycles_per_second, which is {}",
                           sync.fastest_cycles_per_second, speed));
    }
    // What driver/device/rotation.h can count.
    const double cycles_a_turn = speed / turns_per_second(display);
    const double slowest = sync.slowest_cycles_per_second != 0.0 ? sync.slowest_cycles_per_second : speed / 2.0;
    const double fastest = sync.fastest_cycles_per_second != 0.0 ? sync.fastest_cycles_per_second : speed * 1.25;
    constexpr double kLongestTurn_s = 2000.0;
    constexpr double kShortestPulse_ns = 16.0;
    if (cycles_a_turn / slowest > kLongestTurn_s) {
        refuse("cycles_per_second",
               fmt::format("found {}; at its slowest a turn would take {:.4g} s; allowed with an index: {} s", speed,
                           cycles_a_turn / slowest, kLongestTurn_s));
    }
    if (const double pulse_ns = 1e9 * cycles_a_turn / fastest / sync.index_pulses; pulse_ns < kShortestPulse_ns) {
        refuse("sync.index_pulses",
               fmt::format("found {}; at its fastest they would come every {:.3g} ns; allowed: {} ns or more",
                           sync.index_pulses, pulse_ns, kShortestPulse_ns));
    }
}

/// Groups of rows are equal, on every panel.
void check_row_groups(const DisplayDescription& display, Violations& violations) {
    const bool two_halves = display.scan.driver == DriverChip::Hub75;
    for (std::size_t p = 0; p < display.panel_count; ++p) {
        const std::uint32_t rows = display.panels[p].rows;
        if (two_halves && rows % 2 != 0) {
            violations.push_back(
                {"rows",
                 p,
                 fmt::format("found {}; allowed with driver \"hub75\", which lights two halves: even", rows),
                 {}});
            return;
        }
        const std::uint32_t lit = two_halves ? rows / 2 : rows;
        if (lit % display.scan.row_groups == 0) continue;
        violations.push_back(
            {"scan.row_groups",
             {},
             fmt::format("found {}; allowed: what divides {}, for panel {} has {} rows{}", display.scan.row_groups, lit,
                         p, rows, two_halves ? ", which hub75 lights in two halves" : ""),
             {}});
        return;
    }
}

void check_strings(const DisplayDescription& display, Violations& violations) {
    const Scan& scan = display.scan;
    const std::string_view driver = name_of(kDriverNames, scan.driver);
    const auto refuse = [&](std::string_view key, std::string message) {
        violations.push_back({key, {}, std::move(message), {}});
    };
    if (!has_strings(display)) {
        if (scan.strings > 1) {
            refuse("scan.strings", fmt::format("found {}; allowed with driver \"{}\": 1", scan.strings, driver));
        }
        if (scan.serpentine) {
            refuse("scan.serpentine", fmt::format("found true; allowed with driver \"{}\": false", driver));
        }
        return;
    }
    if (is_mono(display.format)) {
        refuse("format",
               fmt::format("found \"{}\"; allowed with driver \"{}\", whose LEDs have three colours: rgb111 to"
                           " rgb888",
                           to_string(display.format), driver));
    }
    const std::size_t leds = frame_pixels(display) / (keeps_light(display) ? 1 : display.slices);
    if (leds % scan.strings != 0) {
        refuse("scan.strings", fmt::format("found {}; allowed: what divides the {} LEDs, for strings are equally long",
                                           scan.strings, leds));
    }
    if (scan.row_groups > 1) {
        refuse("scan.row_groups", fmt::format("found {}; allowed with driver \"{}\": 1", scan.row_groups, driver));
    }
}

void check_scan(const DisplayDescription& display, Violations& violations) {
    const Scan& scan = display.scan;
    const std::string_view driver = name_of(kDriverNames, scan.driver);
    const auto refuse = [&](std::string_view key, std::string message) {
        violations.push_back({key, {}, std::move(message), {}});
    };
    const std::uint32_t bits = bits_per_channel(display.format);
    if (scan.bit_planes > bits) {
        refuse("scan.bit_planes", fmt::format("found {}; allowed: at most {}, for {} has no more bits a channel",
                                              scan.bit_planes, bits, to_string(display.format)));
    }
    const std::string_view order(scan.color_order.data(), scan.color_order.size());
    if (order != "rgb" && is_mono(display.format)) {
        refuse("scan.color_order",
               fmt::format("found \"{}\"; allowed with format \"{}\", which has one channel: \"rgb\"", order,
                           to_string(display.format)));
    }
    if (scan.layers_first && scan.driver != DriverChip::ShiftRegister595) {
        refuse("scan.register_order",
               fmt::format("found \"layers-first\"; allowed with driver \"{}\": \"pixels-first\"", driver));
    }
    if (scan.planes_per_frame > 1 && scan.driver != DriverChip::Dlp) {
        refuse("scan.planes_per_frame",
               fmt::format("found {}; allowed with driver \"{}\": 1", scan.planes_per_frame, driver));
    } else if (scan.planes_per_frame > 1 && bits_per_pixel(display.format) != 1) {
        refuse("scan.planes_per_frame", fmt::format("found {}; allowed with format \"{}\": 1, for they are planes of"
                                                    " one bit",
                                                    scan.planes_per_frame, to_string(display.format)));
    }
    const bool edges_known = scan.min_on_ns > 0 && scan.rise_ns > 0 && scan.fall_ns > 0;
    if (edges_known && scan.min_on_ns < scan.rise_ns + scan.fall_ns) {
        refuse("scan.min_on_ns",
               fmt::format("found {}; allowed: at least {}, which rise_ns and fall_ns make, or an LED is"
                           " never fully lit",
                           scan.min_on_ns, scan.rise_ns + scan.fall_ns));
    }
}

void check_power(const DisplayDescription& display, Violations& violations) {
    if (display.power.limit_ma == 0.0 || display.power.led_ma > 0.0) return;
    violations.push_back(
        {"power.limit_ma",
         {},
         fmt::format("found {}, but it needs led_ma, or no current can be reckoned", display.power.limit_ma),
         {}});
}

/// The most slices of a cycle for which `display` can be scanned; 0: not even one.
std::uint32_t fitting_slices(DisplayDescription display) {
    std::uint32_t fits = 0;
    std::uint32_t fails = display.slices;
    while (fails - fits > 1) {
        display.slices = fits + (fails - fits) / 2;
        const bool ok = scan_time_ns(display, shown_bit_planes(display)) <= slice_time_ns(display);
        (ok ? fits : fails) = display.slices;
    }
    return fits;
}

std::string time_text(double ns) {
    return ns < 999'950.0 ? fmt::format("{:.4g} µs", ns / 1e3) : fmt::format("{:.4g} ms", ns / 1e6);
}

void check_rate(const DisplayDescription& display, Violations& violations) {
    const std::uint32_t planes = shown_bit_planes(display);
    const double needed_ns = scan_time_ns(display, planes);
    const double given_ns = slice_time_ns(display);
    if (needed_ns <= given_ns) return;

    std::string fits;
    const auto add = [&fits](std::string_view what) { fits += fmt::format("{}{}", fits.empty() ? "" : ", or ", what); };
    const bool whole_frame = keeps_light(display);
    if (const std::uint32_t fewer = fitting_bit_planes(display); fewer > 0 && fewer < planes) {
        add(fmt::format("{} bit plane{}", fewer, fewer == 1 ? "" : "s"));
    }
    if (const std::uint32_t slices = fitting_slices(display); slices > 0) add(fmt::format("{} slices", slices));
    // Rounded down, to three digits.
    const double cycles = display.cycles_per_second * given_ns / needed_ns;
    const double step = std::pow(10.0, std::floor(std::log10(cycles)) - 2.0);
    add(fmt::format("{:.3g} cycles a second", std::floor(cycles / step) * step));
    const std::string with_planes =
        has_strings(display) ? "" : fmt::format(" for {} bit plane{}", planes, planes == 1 ? "" : "s");
    violations.push_back({"cycles_per_second",
                          {},
                          fmt::format("found {}, at which a {} has {}, but its scan needs {}{}; what fits: {}",
                                      display.cycles_per_second, whole_frame ? "frame" : "slice", time_text(given_ns),
                                      time_text(needed_ns), with_planes, fits),
                          {}});
}

/// The shortest light and the number of bit planes say for how long an LED is lit; a duty below that is none.
void check_duty(const DisplayDescription& display, Violations& violations) {
    if (has_strings(display)) return;
    const double lit_ns = display.scan.min_on_ns * ((1u << shown_bit_planes(display)) - 1.0);
    const bool own_layer = display.kind == DisplayKind::StackedPlanes;  // An LED is in one slice of a cycle only.
    const double of_ns = slice_time_ns(display) * (own_layer ? display.slices : 1.0);
    if (lit_ns <= display.power.max_duty * of_ns) return;
    if (lit_ns > of_ns) return;  // No duty is enough, and check_rate() has said so.
    violations.push_back({"power.max_duty",
                          {},
                          fmt::format("found {}, but scan.min_on_ns lights an LED for {} of {}, a part of {:.3g};"
                                      " allowed: at least that",
                                      display.power.max_duty, time_text(lit_ns), time_text(of_ns), lit_ns / of_ns),
                          {}});
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
    check_sync(display, violations);
    check_scan(display, violations);
    check_strings(display, violations);
    if (!has_strings(display)) check_row_groups(display, violations);
    check_power(display, violations);
    // There is time for the planes that can be shown.
    DisplayDescription shown = display;
    shown.scan.bit_planes =
        static_cast<std::uint8_t>(std::min(shown_bit_planes(display), bits_per_channel(display.format)));
    check_rate(shown, violations);
    check_duty(shown, violations);
    return violations;
}

}  // namespace xorvox::display
