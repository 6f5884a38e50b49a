#include "tests/roundtrip/displays.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace xorvox::test {
namespace {

DisplayFile flat(std::string_view name, DisplayKind kind, std::uint32_t slices) {
    DisplayFile display;
    display.name = DisplayName(name);
    display.kind = kind;
    display.format = PixelFormat::Rgb332;
    display.slices = slices;
    display.cycles_per_second = 50.0;
    display.panels[0].columns = 13;
    display.panels[0].rows = 9;
    display.panels[0].column_pitch_mm = 2.5;
    display.panels[0].row_pitch_mm = 3.0;
    return display;
}

DisplayFile stack(bool even) {
    DisplayFile display = flat(even ? "odd-stack" : "uneven-stack", DisplayKind::StackedPlanes, 7);
    static constexpr double kHeights_mm[] = {-11.0, -7.5, -3.0, 0.5, 4.0, 8.5, 13.0};
    if (even) display.plane_pitch_mm = 4.0;
    if (!even) display.plane_heights_mm = kHeights_mm;
    return display;
}

DisplayFile swept(std::string_view name, MotionProfile profile, bool both_ways, double dead_zone) {
    DisplayFile display = flat(name, DisplayKind::SweptPlane, 11);
    display.motion.stroke_mm = 36.0;
    display.motion.profile = profile;
    display.motion.both_ways = both_ways;
    display.motion.dead_zone = dead_zone;
    if (profile == MotionProfile::Table) {
        constexpr double kHeights[] = {0.0, 0.05, 0.2, 0.55, 0.85, 1.0};
        display.motion.table_size = std::size(kHeights);
        std::ranges::copy(kHeights, display.motion.table.begin());
    }
    return display;
}

DisplayFile helix(std::uint32_t blades, bool clockwise) {
    DisplayFile display =
        flat(fmt::format("helix-{}{}", blades, clockwise ? "-clockwise" : ""), DisplayKind::Helix, 12);
    display.motion.stroke_mm = 40.0;
    display.blades = blades;
    display.clockwise = clockwise;
    display.panels[0].columns = 15;
    display.panels[0].rows = 15;
    display.panels[0].row_pitch_mm = 2.5;  // square: some pixels are exactly where the screen ends
    return display;
}

/// Points along a spiral in a ball, without any order in space.
DisplayFile points() {
    DisplayFile display = flat("points", DisplayKind::FreePoints, 1);
    display.panels[0].columns = 40;
    display.panels[0].rows = 15;
    static const std::vector<PointMm> kSpiral_mm = [] {
        std::vector<PointMm> all;
        for (int i = 0; i < 600; ++i) {
            const double turn = 2.399963 * i;
            const double radius = 60.0 * std::cbrt((i * 377 % 600 + 0.5) / 600.0);
            const double up = 1.0 - 2.0 * (i + 0.5) / 600.0;
            const double aside = radius * std::sqrt(1.0 - up * up);
            all.push_back({aside * std::cos(turn), aside * std::sin(turn), radius * up});
        }
        return all;
    }();
    display.points = kSpiral_mm;
    return display;
}

/// Two panels, each on its own side of the axis.
DisplayFile rotor(std::string_view name, bool clockwise = false) {
    DisplayFile display;
    display.name = DisplayName(name);
    display.kind = DisplayKind::RotatingPanel;
    display.format = PixelFormat::Rgb332;
    display.slices = 50;
    display.cycles_per_second = 15.0;
    display.clockwise = clockwise;
    display.panel_count = 2;
    for (std::uint32_t p = 0; p < 2; ++p) {
        Panel& panel = display.panels[p];
        panel.columns = 21;
        panel.rows = 11;
        panel.column_pitch_mm = 2.0;
        panel.row_pitch_mm = 3.0;
        panel.offset_mm = 0.7;
        panel.shift_mm = 0.5;
        panel.angle_deg = 180.0 * p;
        panel.chain_position = static_cast<std::uint8_t>(p);
    }
    return display;
}

DisplayFile half_turn() {
    DisplayFile display = rotor("half-turn");
    display.sweep_deg = 180.0;
    display.panel_count = 1;
    display.panels[0].offset_mm = display.panels[0].shift_mm = 0.0;
    return display;
}

/// The second panel hangs two rows lower, and passes many of the first one's places.
DisplayFile lifted() {
    DisplayFile display = rotor("lifted");
    display.panels[0].shift_mm = display.panels[1].shift_mm = 0.0;
    display.panels[1].lift_mm = -6.0;
    return display;
}

/// Panels of different sizes: no two rows need be at one height.
DisplayFile unlike() {
    DisplayFile display = rotor("unlike", true);
    display.panels[1].columns = 17;
    display.panels[1].rows = 8;
    display.panels[1].row_pitch_mm = 3.5;
    display.panels[1].lift_mm = 1.0;
    return display;
}

/// The first panel upright and skewed, the second leaning or not; both of one mounting.
DisplayFile mounted(std::uint8_t turned, bool mirrored, bool leaning) {
    DisplayFile display = rotor(
        fmt::format("turned-{}{}{}", turned, mirrored ? "-mirrored" : "", leaning ? "-leaning" : ""), turned % 2 == 1);
    for (std::uint32_t p = 0; p < 2; ++p) {
        Panel& panel = display.panels[p];
        panel.turned = turned;
        panel.mirrored = mirrored;
        panel.offset_mm = 9.0;
        if (leaning || turned % 2 == 0) panel.skew_mm = 0.6;
        if (leaning) panel.tilt_deg = p == 0 ? 12.0 : -7.5;
    }
    return display;
}

std::vector<DisplayFile> presets_with(bool large) {
    std::vector<DisplayFile> all;
    for (const Preset& preset : presets()) {
        auto display = load_display(std::string(preset.name));
        if (!display) throw std::runtime_error(display.error().message);
        if ((frame_pixels(*display) > kLarge) == large) all.push_back(std::move(*display));
    }
    return all;
}

}  // namespace

std::vector<DisplayFile> odd_displays() {
    std::vector<DisplayFile> all{stack(true),
                                 stack(false),
                                 swept("swept-evenly", MotionProfile::Constant, false, 0.2),
                                 swept("sine", MotionProfile::Sine, true, 0.05),
                                 swept("table", MotionProfile::Table, false, 0.1),
                                 helix(1, false),
                                 helix(2, false),
                                 helix(2, true),
                                 points(),
                                 rotor("odd-rotor"),
                                 rotor("odd-rotor-clockwise", true),
                                 half_turn(),
                                 lifted(),
                                 unlike()};
    for (std::uint8_t turned = 0; turned < 4; ++turned) {
        for (const bool mirrored : {false, true}) {
            for (const bool leaning : {false, true}) all.push_back(mounted(turned, mirrored, leaning));
        }
    }
    return all;
}

std::vector<DisplayFile> small_presets() {
    return presets_with(false);
}

std::vector<DisplayFile> large_presets() {
    return presets_with(true);
}

DisplayFile in_format(DisplayFile display, PixelFormat format) {
    if (format != display.format) display.scan = {};
    display.format = format;
    return display;
}

}  // namespace xorvox::test
