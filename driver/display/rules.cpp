#include "driver/display/rules.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "driver/display/names.h"
#include "driver/display/toml.h"

namespace xorvox::display {
namespace {

/// Looks at each value alone.
class Checker {
public:
    explicit Checker(const DisplayDescription& display) : display_(display) {}

    std::vector<Violation> check_all() {
        named("kind", display_.kind, kKindNames);
        if (!violations_.empty()) return std::move(violations_);
        check_names();
        check_display();
        check_motion();
        check_panels();
        check_sync();
        check_scan();
        range("light.gamma", display_.light.gamma, kGamma);
        known("power.led_ma", display_.power.led_ma, kLedMilliamperes);
        range("power.max_duty", display_.power.max_duty, kDuty);
        known("power.limit_ma", display_.power.limit_ma, kLimitMilliamperes);
        return std::move(violations_);
    }

private:
    bool is(DisplayKind kind) const { return display_.kind == kind; }

    void refuse(std::string_view key, std::string message, std::optional<std::size_t> item = {}) {
        violations_.push_back({key, panel_, std::move(message), item});
    }

    void range(std::string_view key, double value, const Range& range, std::optional<std::size_t> item = {}) {
        if (auto message = check(value, range)) refuse(key, std::move(*message), item);
    }

    /// 0 says that nobody knows it, or that there is none.
    void known(std::string_view key, double value, const Range& allowed) {
        if (value == 0.0) return;
        if (const auto message = check(value, allowed)) refuse(key, *message + ", or 0");
    }

    /// `value` must be in `range` on displays that it `applies` to, and what it is by default on others.
    void range_if(bool applies, std::string_view key, double value, double by_default, const Range& allowed) {
        if (applies) return range(key, value, allowed);
        if (value == by_default) return;
        refuse(key, fmt::format("found {}; allowed: {}, for it does not apply to {}", value, by_default,
                                kind_name(display_.kind)));
    }

    void flag_if(bool applies, std::string_view key, bool value) {
        if (applies || !value) return;
        refuse(key, fmt::format("found true; allowed: false, for it does not apply to {}", kind_name(display_.kind)));
    }

    template <class Enum, std::size_t N>
    void named(std::string_view key, Enum value, const Named<Enum> (&names)[N]) {
        if (find_named(names, value) != nullptr) return;
        refuse(key, fmt::format("found number {}; allowed: {} ({}) to {} ({})", static_cast<int>(value),
                                static_cast<int>(names[0].value), names[0].name, static_cast<int>(names[N - 1].value),
                                names[N - 1].name));
    }

    void check_names() {
        if (bits_per_pixel(display_.format) == 0) {
            refuse("format",
                   fmt::format("found number {}; allowed: 1 (mono1) to 8 (mono4)", static_cast<int>(display_.format)));
        }
        named("motion.profile", display_.motion.profile, kProfileNames);
        named("sync.index", display_.sync.index, kIndexNames);
        named("scan.driver", display_.scan.driver, kDriverNames);
        named("light.response", display_.light.response, kResponseNames);
        const std::size_t most = is(DisplayKind::RotatingPanel) ? kMaxPanels : 1;
        if (display_.panel_count < 1 || display_.panel_count > most) {
            refuse("panel", fmt::format("found {} panels; allowed on {}: {}", display_.panel_count,
                                        kind_name(display_.kind), most == 1 ? "exactly one" : "1 to 8"));
        }
    }

    void check_display() {
        const bool points = is(DisplayKind::FreePoints);
        const bool stack = is(DisplayKind::StackedPlanes);
        const bool uneven = !display_.plane_heights_mm.empty();
        range_if(!points, "slices", display_.slices, 1, kSlices);
        range("cycles_per_second", display_.cycles_per_second, kCyclesPerSecond);
        range_if(stack && !uneven, "plane_pitch_mm", display_.plane_pitch_mm, 1, kPitchMm);
        if (uneven && !stack) {
            refuse("plane_heights_mm", fmt::format("does not apply to {}", kind_name(display_.kind)));
        }
        for (std::size_t i = 0; i < display_.plane_heights_mm.size(); ++i) {
            range("plane_heights_mm", display_.plane_heights_mm[i], kPlaceMm, i);
        }
        if (is(DisplayKind::RotatingPanel)) {
            if (display_.sweep_deg != 360.0 && display_.sweep_deg != 180.0) {
                refuse("sweep_deg", fmt::format("found {}; allowed: 360 or 180", display_.sweep_deg));
            }
        } else {
            range_if(false, "sweep_deg", display_.sweep_deg, 360, kAngleDeg);
        }
        flag_if(is(DisplayKind::RotatingPanel) || is(DisplayKind::Helix), "clockwise", display_.clockwise);
        range_if(is(DisplayKind::Helix), "blades", display_.blades, 1, kBlades);
        if (!points && !display_.points.empty()) {
            refuse("points", fmt::format("does not apply to {}", kind_name(display_.kind)));
        }
        for (std::size_t i = 0; i < display_.points.size(); ++i) {
            range("points", display_.points[i].x, kPlaceMm, i);
            range("points", display_.points[i].y, kPlaceMm, i);
            range("points", display_.points[i].z, kPlaceMm, i);
        }
    }

    void check_motion() {
        const Motion& motion = display_.motion;
        const bool swept = is(DisplayKind::SweptPlane);
        range_if(swept || is(DisplayKind::Helix), "motion.stroke_mm", motion.stroke_mm, 0, kPitchMm);
        if (!swept && motion.profile != MotionProfile::Constant) {
            refuse("motion.profile", fmt::format("does not apply to {}", kind_name(display_.kind)));
        }
        flag_if(swept, "motion.both_ways", motion.both_ways);
        range_if(swept, "motion.dead_zone", motion.dead_zone, 0, kDeadZone);
        if (motion.table_size > kMaxMotionTable) {
            refuse("motion.table",
                   fmt::format("found {} heights; allowed: 2 to {}", motion.table_size, kMaxMotionTable));
        }
    }

    void check_panels() {
        const bool rotor = is(DisplayKind::RotatingPanel);
        for (std::size_t p = 0; p < std::min<std::size_t>(display_.panel_count, kMaxPanels); ++p) {
            const Panel& panel = display_.panels[p];
            panel_ = p;
            range("columns", panel.columns, kPixels);
            range("rows", panel.rows, kPixels);
            range("column_pitch_mm", panel.column_pitch_mm, kPitchMm);
            range("row_pitch_mm", panel.row_pitch_mm, kPitchMm);
            range_if(rotor, "shift_mm", panel.shift_mm, 0, kPlaceMm);
            range_if(rotor, "offset_mm", panel.offset_mm, 0, kPlaceMm);
            range_if(rotor, "lift_mm", panel.lift_mm, 0, kPlaceMm);
            range_if(rotor, "angle_deg", panel.angle_deg, 0, kAngleDeg);
            range_if(rotor, "tilt_deg", panel.tilt_deg, 0, kTiltDeg);
            range_if(rotor, "skew_mm", panel.skew_mm, 0, kPlaceMm);
            flag_if(rotor, "mirrored", panel.mirrored);
            range_if(rotor, "turned", panel.turned, 0, kQuarterTurns);
            range("connector", panel.connector, kConnectors);
            range("chain_position", panel.chain_position, kConnectors);
        }
        panel_.reset();
    }

    void check_sync() {
        const Sync& sync = display_.sync;
        range("sync.index_pulses", sync.index_pulses, kIndexPulses);
        if (!(sync.index_phase >= 0.0 && sync.index_phase < 1.0)) {
            refuse("sync.index_phase", fmt::format("found {}; allowed: a number from 0 to below 1", sync.index_phase));
        }
        known("sync.slowest_cycles_per_second", sync.slowest_cycles_per_second, kCyclesPerSecond);
        known("sync.fastest_cycles_per_second", sync.fastest_cycles_per_second, kCyclesPerSecond);
    }

    void check_scan() {
        const Scan& scan = display_.scan;
        range("scan.pixel_clock_hz", scan.pixel_clock_hz, kClockHz);
        range("scan.latch_ns", scan.latch_ns, kScanNs);
        range("scan.min_on_ns", scan.min_on_ns, kScanNs);
        range("scan.rise_ns", scan.rise_ns, kScanNs);
        range("scan.fall_ns", scan.fall_ns, kScanNs);
        range("scan.row_groups", scan.row_groups, kRowGroups);
        range("scan.bit_planes", scan.bit_planes, kBitPlanes);
        range("scan.strings", scan.strings, kStrings);
        range("scan.planes_per_frame", scan.planes_per_frame, kPlanesPerFrame);
        const std::string_view order(scan.color_order.data(), scan.color_order.size());
        for (const char color : {'r', 'g', 'b'}) {
            if (order.find(color) != order.npos) continue;
            std::string shown(order);
            for (char& c : shown) c = c >= ' ' && c <= '~' ? c : '?';
            return refuse("scan.color_order", fmt::format("found \"{}\"; allowed: each of r, g and b once", shown));
        }
    }

    const DisplayDescription& display_;
    std::optional<std::size_t> panel_;  ///< In hand.
    std::vector<Violation> violations_;
};

}  // namespace

std::string in_words(const Violation& violation, std::string_view joint) {
    const std::string panel = violation.panel ? fmt::format("panel {}{}", *violation.panel, joint) : "";
    const std::string_view colon = violation.key.empty() ? "" : ": ";
    return fmt::format("{}{}{}{}", panel, violation.key, colon, violation.message);
}

std::optional<std::string> check(double value, const Range& range) {
    if (value >= range.lowest && value <= range.highest) return std::nullopt;
    return fmt::format("found {}; allowed: a {} from {} to {}", value, range.whole ? "whole number" : "number",
                       range.lowest, range.highest);
}

bool gives_wiring(const DisplayDescription& display) {
    const DriverChip driver = display.scan.driver;
    if (driver == DriverChip::Hub75 || driver == DriverChip::ShiftRegister595) return true;
    // Not checked yet: it may count more panels than there can be.
    const std::size_t panels = std::min<std::size_t>(display.panel_count, kMaxPanels);
    for (std::size_t p = 0; p < panels; ++p) {
        if (display.panels[p].connector != 0 || display.panels[p].chain_position != 0) return true;
    }
    return false;
}

std::vector<Violation> find_wrong_values(const DisplayDescription& display) {
    return Checker(display).check_all();
}

}  // namespace xorvox::display

namespace xorvox {

Expected<void> validate_display(const DisplayDescription& display) {
    auto violations = display::find_wrong_values(display);
    if (violations.empty()) violations = display::find_contradictions(display, display::gives_wiring(display));
    if (violations.empty()) return {};
    return fail(fmt::format("display \"{}\": {}", display.name.view(), display::in_words(violations.front(), ", ")));
}

}  // namespace xorvox
