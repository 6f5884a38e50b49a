#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "driver/display/cpp.h"
#include "driver/display/lattice.h"
#include "driver/display/names.h"
#include "driver/display/timing.h"
#include "driver/display/toml.h"
#include "tools/commands.h"
#include "tools/console.h"

namespace xorvox::tools {
namespace {

using display::name_of;

/// A value of a display.
struct Field {
    std::string key;    ///< In a display file, and in JSON.
    std::string words;  ///< For people: the key, or what is computed in words.
    std::string text;   ///< For people.
    std::string json;
};

/// A table of a display file, or what is computed from it.
struct Section {
    std::string name;  ///< "", "panel", "motion" …
    std::vector<Field> fields;

    template <class Value>
    void add(std::string_view key, const Value& value, std::string_view unit = "") {
        const std::string plain = fmt::format("{}", value);
        const bool bare = std::is_arithmetic_v<Value>;
        add_as(key, key, plain + std::string(unit), bare ? plain : json_string(plain));
    }
    /// A number of which 0 says that nobody knows it, or that there is none.
    template <class Value>
    void add_known(std::string_view key, const Value& value, std::string_view otherwise = "unknown") {
        if (value == Value{}) return add_as(key, key, std::string(otherwise), "null");
        add(key, value);
    }
    void add_as(std::string_view key, std::string_view words, std::string text, std::string json) {
        fields.push_back({std::string(key), std::string(words), std::move(text), std::move(json)});
    }
};

/// `value` with the unit that leaves 1 to 999.9 of it; each of `units` is 1000 of the one before.
std::string measure(double value, std::initializer_list<std::string_view> units) {
    const auto* unit = units.begin();
    for (; std::abs(value) >= 999.95 && unit + 1 != units.end(); ++unit) value /= 1000.0;
    return fmt::format("{:.4g} {}", value, *unit);
}

Section main_section(const DisplayDescription& display) {
    Section section;
    const bool rotor = display.kind == DisplayKind::RotatingPanel;
    const bool helix = display.kind == DisplayKind::Helix;
    section.add("kind", name_of(display::kKindNames, display.kind));
    section.add("format", to_string(display.format));
    section.add("slices", display.slices);
    section.add("cycles_per_second", display.cycles_per_second);
    if (display.kind == DisplayKind::StackedPlanes) {
        if (display.plane_heights_mm.empty()) {
            section.add("plane_pitch_mm", display.plane_pitch_mm);
        } else {
            const auto heights = display.plane_heights_mm;
            section.add_as("plane_heights_mm", "plane_heights_mm",
                           fmt::format("from {} to {}", heights.front(), heights.back()),
                           fmt::format("[{}]", fmt::join(heights, ", ")));
        }
    }
    if (rotor) section.add("sweep_deg", display.sweep_deg);
    if (rotor || helix) section.add("clockwise", display.clockwise);
    if (helix) section.add("blades", display.blades);
    if (!display.points.empty()) {
        std::string json;
        for (const PointMm& point : display.points) {
            json += fmt::format("{}[{}, {}, {}]", json.empty() ? "[" : ", ", point.x, point.y, point.z);
        }
        section.add_as("points", "points", fmt::format("{} places", display.points.size()), json + "]");
    }
    return section;
}

Section motion_section(const DisplayDescription& display) {
    Section section{"motion", {}};
    const Motion& motion = display.motion;
    if (motion.stroke_mm == 0.0) return section;
    section.add("stroke_mm", motion.stroke_mm);
    if (display.kind != DisplayKind::SweptPlane) return section;
    section.add("profile", name_of(display::kProfileNames, motion.profile));
    section.add("both_ways", motion.both_ways);
    section.add("dead_zone", motion.dead_zone);
    if (motion.table_size > 0) {
        const auto end = motion.table.begin() + motion.table_size;
        section.add_as("table", "table", fmt::format("{} heights", motion.table_size),
                       fmt::format("[{}]", fmt::join(motion.table.begin(), end, ", ")));
    }
    return section;
}

Section panel_section(const DisplayDescription& display, const Panel& panel) {
    Section section{"panel", {}};
    section.add("columns", panel.columns);
    section.add("rows", panel.rows);
    section.add("column_pitch_mm", panel.column_pitch_mm);
    section.add("row_pitch_mm", panel.row_pitch_mm);
    if (display.kind == DisplayKind::RotatingPanel) {
        section.add("shift_mm", panel.shift_mm);
        section.add("offset_mm", panel.offset_mm);
        section.add("lift_mm", panel.lift_mm);
        section.add("angle_deg", panel.angle_deg);
        section.add("tilt_deg", panel.tilt_deg);
        section.add("skew_mm", panel.skew_mm);
        section.add("mirrored", panel.mirrored);
        section.add("turned", panel.turned, panel.turned == 1 ? " quarter turn" : " quarter turns");
    }
    section.add("connector", panel.connector);
    section.add("chain_position", panel.chain_position);
    return section;
}

Section sync_section(const DisplayDescription& display) {
    Section section{"sync", {}};
    const Sync& sync = display.sync;
    section.add("index", name_of(display::kIndexNames, sync.index));
    if (sync.index == IndexSource::None) return section;
    section.add("index_pulses", sync.index_pulses);
    section.add("index_phase", sync.index_phase);
    const double speed = display.cycles_per_second;
    const double slowest = sync.slowest_cycles_per_second;
    const double fastest = sync.fastest_cycles_per_second;
    section.add("slowest_cycles_per_second", slowest > 0.0 ? slowest : speed * 0.5);
    section.add("fastest_cycles_per_second", fastest > 0.0 ? fastest : speed * 1.25);
    return section;
}

Section scan_section(const DisplayDescription& display) {
    Section section{"scan", {}};
    const Scan& scan = display.scan;
    section.add("driver", name_of(display::kDriverNames, scan.driver));
    section.add_known("pixel_clock_hz", scan.pixel_clock_hz);
    section.add_known("latch_ns", scan.latch_ns);
    section.add_known("min_on_ns", scan.min_on_ns);
    section.add_known("rise_ns", scan.rise_ns);
    section.add_known("fall_ns", scan.fall_ns);
    section.add("row_groups", scan.row_groups);
    section.add("bit_planes", shown_bit_planes(display), fmt::format(" of {}", bits_per_channel(display.format)));
    section.add("bit_order", name_of(display::kBitOrderNames, scan.msb_first));
    section.add("color_order", std::string_view(scan.color_order.data(), scan.color_order.size()));
    if (has_strings(display)) {
        section.add("strings", scan.strings);
        section.add("serpentine", scan.serpentine);
    }
    if (scan.driver == DriverChip::ShiftRegister595) {
        section.add("register_order", name_of(display::kRegisterOrderNames, scan.layers_first));
    }
    if (scan.driver == DriverChip::Dlp) section.add("planes_per_frame", scan.planes_per_frame);
    return section;
}

Section light_section(const DisplayDescription& display) {
    Section section{"light", {}};
    section.add("response", name_of(display::kResponseNames, display.light.response));
    if (display.light.response == Response::Gamma) section.add("gamma", display.light.gamma);
    return section;
}

Section power_section(const DisplayDescription& display) {
    Section section{"power", {}};
    section.add_known("led_ma", display.power.led_ma);
    section.add("max_duty", display.power.max_duty);
    section.add_known("limit_ma", display.power.limit_ma, "none");
    return section;
}

Section frame_section(const DisplayDescription& display) {
    Section section{"frame", {}};
    const auto number = [&](std::string_view key, std::string_view name, auto value, std::string text) {
        section.add_as(key, name, std::move(text), fmt::format("{}", value));
    };
    const std::size_t bytes = frame_bytes(display);
    const double rate = static_cast<double>(bytes) * display.cycles_per_second;
    number("bytes", "bytes", bytes, thousands(bytes));
    number("pixels", "pixels", frame_pixels(display), thousands(frame_pixels(display)));
    number("bytes_per_second", "data rate", rate, measure(rate, {"B/s", "kB/s", "MB/s", "GB/s", "TB/s"}) + " raw");
    if (display.kind != DisplayKind::StackedPlanes && display.kind != DisplayKind::FreePoints) {
        const double turns = turns_per_second(display);
        const bool sweeps = display.kind == DisplayKind::SweptPlane;
        number("turns_per_second", sweeps ? "sweeps" : "turns", turns,
               fmt::format("{}{} a second", turns, sweeps ? " up and down" : ""));
    }
    const std::string_view of = keeps_light(display) ? "frame" : "slice";
    const auto time = [](double ns) { return measure(ns, {"ns", "µs", "ms", "s"}); };
    const double slice_ns = slice_time_ns(display);
    number("slice_time_ns", fmt::format("time of a {}", of), slice_ns, time(slice_ns));
    if (const double scan_ns = scan_time_ns(display, shown_bit_planes(display)); scan_ns > 0.0) {
        number("scan_time_ns", "time that its scan needs", scan_ns, time(scan_ns));
    } else {
        section.add_as("scan_time_ns", "time that its scan needs", "unknown", "null");
    }
    const DisplayExtent box = extent(display);
    const glm::dvec3 size = box.upper - box.lower;
    section.add_as("size_mm", "size", fmt::format("{:.6g} × {:.6g} × {:.6g} mm", size.x, size.y, size.z),
                   fmt::format("[{}, {}, {}]", size.x, size.y, size.z));
    if (display.power.led_ma > 0.0) {
        const double current_ma = static_cast<double>(leds_at_a_time(display)) * display.power.led_ma;
        number("full_current_ma", "all white", current_ma, measure(current_ma, {"mA", "A", "kA"}));
    }
    const std::string digest = fmt::format("{:016x}", geometry_digest(display));
    section.add_as("geometry_digest", "digest of its geometry", digest, json_string(digest));
    return section;
}

std::vector<Section> sections_of(const DisplayDescription& display) {
    std::vector<Section> sections{main_section(display), motion_section(display)};
    for (std::size_t p = 0; p < display.panel_count; ++p) {
        sections.push_back(panel_section(display, display.panels[p]));
    }
    sections.push_back(sync_section(display));
    sections.push_back(scan_section(display));
    sections.push_back(light_section(display));
    sections.push_back(power_section(display));
    sections.push_back(frame_section(display));
    std::erase_if(sections, [](const Section& section) { return section.fields.empty(); });
    return sections;
}

void print_text(const DisplayFile& display) {
    fmt::print("{}{}{}\n", display.name.view(), display.summary.empty() ? "" : ": ", display.summary);
    std::size_t panel = 0;
    for (const Section& section : sections_of(display)) {
        std::string title = section.name == "frame" ? "a frame" : section.name;
        if (section.name == "panel") title = fmt::format("panel {}", panel++);
        if (!title.empty()) fmt::print("\n{}\n", title);
        for (const Field& field : section.fields) {
            const std::string path = section.name.empty() ? field.key : fmt::format("{}.{}", section.name, field.key);
            const bool assumed = std::ranges::find(display.assumed, path) != display.assumed.end();
            if (assumed) {
                fmt::print("  {:<26} {:<16} assumed\n", field.words, field.text);
            } else {
                fmt::print("  {:<26} {}\n", field.words, field.text);
            }
        }
    }
}

std::string json_list(const std::vector<std::string>& texts) {
    std::string list;
    for (const std::string& text : texts) list += (list.empty() ? "" : ", ") + json_string(text);
    return "[" + list + "]";
}

std::string json_fields(const Section& section) {
    std::string object;
    for (const Field& field : section.fields) {
        object += fmt::format("{}{}: {}", object.empty() ? "" : ", ", json_string(field.key), field.json);
    }
    return object;
}

void print_json(const DisplayFile& display) {
    fmt::print("{{\n  \"name\": {},\n  \"summary\": {},\n  \"assumed\": {}", json_string(display.name.view()),
               json_string(display.summary), json_list(display.assumed));
    std::string panels;
    for (const Section& section : sections_of(display)) {
        if (section.name.empty()) {
            fmt::print(",\n  {}", json_fields(section));
        } else if (section.name == "panel") {
            panels += fmt::format("{}\n    {{{}}}", panels.empty() ? "" : ",", json_fields(section));
        } else {
            fmt::print(",\n  \"{}\": {{{}}}", section.name, json_fields(section));
        }
    }
    fmt::print(",\n  \"panel\": [{}\n  ]\n}}\n", panels);
}

Expected<void> list_presets(bool json) {
    std::size_t width = 0;
    for (const Preset& preset : presets()) width = std::max(width, preset.name.size());
    const char* separator = "";
    if (json) fmt::print("[");
    for (const Preset& preset : presets()) {
        const auto display = parse_display(preset.text, preset.name);
        if (!display) return tl::unexpected<Error>(display.error());
        if (json) {
            fmt::print("{}\n  {{\"name\": {}, \"summary\": {}, \"assumed\": {}}}", separator, json_string(preset.name),
                       json_string(preset.summary), json_list(display->assumed));
            separator = ",";
        } else {
            const std::size_t assumed = display->assumed.size();
            fmt::print("{:<{}}  {} ({} value{} assumed)\n", preset.name, width, preset.summary, assumed,
                       assumed == 1 ? "" : "s");
        }
    }
    if (json) fmt::print("\n]\n");
    return {};
}

}  // namespace

Expected<void> displays(const DisplaysOptions& options) {
    if (options.display.empty()) return list_presets(options.json);
    const auto display = load_display(options.display);
    if (!display) return tl::unexpected<Error>(display.error());
    if (options.cpp) {
        fmt::print("{}", to_cpp(*display));
    } else if (options.json) {
        print_json(*display);
    } else {
        print_text(*display);
    }
    return {};
}

}  // namespace xorvox::tools
