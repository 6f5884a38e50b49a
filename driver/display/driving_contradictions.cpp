// What contradicts itself in how a display is driven: sync, scan, light and power.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "driver/display/names.h"
#include "driver/display/rules.h"
#include "driver/display/timing.h"

namespace xorvox::display {
namespace {

using Violations = std::vector<Violation>;

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
    const std::uint64_t edges_ns = std::uint64_t{scan.rise_ns} + scan.fall_ns;
    if (scan.min_on_ns > 0 && scan.min_on_ns < edges_ns) {
        refuse("scan.min_on_ns",
               fmt::format("found {}; allowed: at least {}, which rise_ns and fall_ns make, or an LED is"
                           " never fully lit",
                           scan.min_on_ns, edges_ns));
    }
}

void check_light(const DisplayDescription& display, Violations& violations) {
    const Light& light = display.light;
    if (light.response == Response::Gamma || light.gamma == Light{}.gamma) return;
    violations.push_back({"light.gamma",
                          {},
                          fmt::format("found {}; allowed with response \"{}\": {}", light.gamma,
                                      name_of(kResponseNames, light.response), Light{}.gamma),
                          {}});
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

/// A one at the place of the third digit of `number`.
double third_digit(double number) {
    return std::pow(10.0, std::floor(std::log10(number)) - 2.0);
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
    const double step = third_digit(cycles);
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
bool has_time_to_be_lit(const DisplayDescription& display, Violations& violations) {
    if (has_strings(display)) return true;
    const double lit_ns = display.scan.min_on_ns * ((1u << shown_bit_planes(display)) - 1.0);
    const bool own_layer = display.kind == DisplayKind::StackedPlanes;  // An LED is in one slice of a cycle only.
    const double of_ns = slice_time_ns(display) * (own_layer ? display.slices : 1.0);
    if (lit_ns <= display.power.max_duty * of_ns) return true;
    if (lit_ns > of_ns) return true;  // No duty is enough, and check_rate() has said so.
    violations.push_back({"power.max_duty",
                          {},
                          fmt::format("found {}, but scan.min_on_ns lights an LED for {} of {}, a part of {:.3g};"
                                      " allowed: at least that",
                                      display.power.max_duty, time_text(lit_ns), time_text(of_ns), lit_ns / of_ns),
                          {}});
    return false;
}

/// The device keeps to the duty by its brightness, which has 255 steps.
void check_duty(const DisplayDescription& display, Violations& violations) {
    if (!has_time_to_be_lit(display, violations) || most_brightness(display) > 0) return;
    const double least = full_duty(display) / 255.0;
    const double step = third_digit(least);
    violations.push_back({"power.max_duty",
                          {},
                          fmt::format("found {}, for which the least brightness, 1 of 255, is too much, so that the"
                                      " display would stay dark; allowed: at least {:.3g}",
                                      display.power.max_duty, std::ceil(least / step) * step),
                          {}});
}

}  // namespace

void find_driving_contradictions(const DisplayDescription& display, Violations& violations) {
    check_sync(display, violations);
    check_scan(display, violations);
    check_strings(display, violations);
    if (!has_strings(display)) check_row_groups(display, violations);
    check_light(display, violations);
    check_power(display, violations);
    // There is time for the planes that can be shown.
    DisplayDescription shown = display;
    shown.scan.bit_planes =
        static_cast<std::uint8_t>(std::min(shown_bit_planes(display), bits_per_channel(display.format)));
    check_rate(shown, violations);
    check_duty(shown, violations);
}

}  // namespace xorvox::display
