#include "driver/display/cpp.h"

#include <fmt/format.h>

#include "driver/display/names.h"

namespace xorvox {
namespace {

using display::Named;

bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/// `text` as a string of C++, quotes included.
std::string quoted(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\' || c == '?') {  // "??/" and its like mean something else to older compilers
            out += '\\';
            out += c;
        } else if (c >= ' ' && c <= '~') {
            out += c;
        } else {
            out += fmt::format("\\{:03o}", static_cast<unsigned char>(c));
        }
    }
    return out + '"';
}

/// The shortest decimals that give `number` back.
std::string literal(double number) {
    std::string digits = fmt::format("{}", number);
    if (digits.find_first_of(".e") == digits.npos) digits += ".0";
    return digits;
}
std::string literal(bool truth) {
    return truth ? "true" : "false";
}
template <class Integer>
std::string literal(Integer number) {
    return fmt::format("{}", number);
}

/// Writes assignments to the fields of `display`.
class Writer {
public:
    template <class Value>
    void field(std::string_view name, const Value& value) {
        text_ += fmt::format("    display.{} = {};\n", name, literal(value));
    }
    template <class Value>
    void field_unless(std::string_view name, const Value& value, const Value& by_default) {
        if (value != by_default) field(name, value);
    }
    template <class Enum, std::size_t N>
    void named(std::string_view name, std::string_view type, Enum value, const Named<Enum> (&names)[N]) {
        text_ += fmt::format("    display.{} = {}::{};\n", name, type, display::find_named(names, value)->cpp);
    }
    void line(std::string_view text) { text_ += fmt::format("    {}\n", text); }

    const std::string& text() const { return text_; }

private:
    std::string text_;
};

void write_motion(Writer& out, const Motion& motion) {
    const Motion none;
    out.field_unless("motion.stroke_mm", motion.stroke_mm, none.stroke_mm);
    if (motion.profile != none.profile) {
        out.named("motion.profile", "MotionProfile", motion.profile, display::kProfileNames);
    }
    out.field_unless("motion.both_ways", motion.both_ways, none.both_ways);
    out.field_unless("motion.dead_zone", motion.dead_zone, none.dead_zone);
    out.field_unless("motion.table_size", motion.table_size, none.table_size);
    for (std::size_t i = 0; i < motion.table_size; ++i) {
        out.field(fmt::format("motion.table[{}]", i), motion.table[i]);
    }
}

void write_panel(Writer& out, const Panel& panel, std::size_t index) {
    const Panel plain;
    const auto name = [index](std::string_view field) { return fmt::format("panels[{}].{}", index, field); };
    out.field(name("columns"), panel.columns);
    out.field(name("rows"), panel.rows);
    out.field(name("column_pitch_mm"), panel.column_pitch_mm);
    out.field(name("row_pitch_mm"), panel.row_pitch_mm);
    out.field_unless(name("shift_mm"), panel.shift_mm, plain.shift_mm);
    out.field_unless(name("offset_mm"), panel.offset_mm, plain.offset_mm);
    out.field_unless(name("lift_mm"), panel.lift_mm, plain.lift_mm);
    out.field_unless(name("angle_deg"), panel.angle_deg, plain.angle_deg);
    out.field_unless(name("tilt_deg"), panel.tilt_deg, plain.tilt_deg);
    out.field_unless(name("skew_mm"), panel.skew_mm, plain.skew_mm);
    out.field_unless(name("mirrored"), panel.mirrored, plain.mirrored);
    out.field_unless(name("turned"), panel.turned, plain.turned);
    out.field_unless(name("connector"), panel.connector, plain.connector);
    out.field_unless(name("chain_position"), panel.chain_position, plain.chain_position);
}

void write_driving(Writer& out, const DisplayDescription& display) {
    const Sync free;
    const Sync& sync = display.sync;
    if (sync.index != free.index) out.named("sync.index", "IndexSource", sync.index, display::kIndexNames);
    out.field_unless("sync.index_pulses", sync.index_pulses, free.index_pulses);
    out.field_unless("sync.index_phase", sync.index_phase, free.index_phase);
    out.field_unless("sync.slowest_cycles_per_second", sync.slowest_cycles_per_second, 0.0);
    out.field_unless("sync.fastest_cycles_per_second", sync.fastest_cycles_per_second, 0.0);

    const Scan plain;
    const Scan& scan = display.scan;
    if (scan.driver != plain.driver) out.named("scan.driver", "DriverChip", scan.driver, display::kDriverNames);
    out.field_unless("scan.pixel_clock_hz", scan.pixel_clock_hz, plain.pixel_clock_hz);
    out.field_unless("scan.latch_ns", scan.latch_ns, plain.latch_ns);
    out.field_unless("scan.min_on_ns", scan.min_on_ns, plain.min_on_ns);
    out.field_unless("scan.rise_ns", scan.rise_ns, plain.rise_ns);
    out.field_unless("scan.fall_ns", scan.fall_ns, plain.fall_ns);
    out.field_unless("scan.row_groups", scan.row_groups, plain.row_groups);
    out.field_unless("scan.bit_planes", scan.bit_planes, plain.bit_planes);
    out.field_unless("scan.strings", scan.strings, plain.strings);
    out.field_unless("scan.planes_per_frame", scan.planes_per_frame, plain.planes_per_frame);
    out.field_unless("scan.msb_first", scan.msb_first, plain.msb_first);
    out.field_unless("scan.layers_first", scan.layers_first, plain.layers_first);
    out.field_unless("scan.serpentine", scan.serpentine, plain.serpentine);
    const auto& order = scan.color_order;
    if (order != plain.color_order) {
        out.line(fmt::format("display.scan.color_order = {{'{}', '{}', '{}'}};", order[0], order[1], order[2]));
    }

    const Light& light = display.light;
    if (light.response != Light{}.response) {
        out.named("light.response", "Response", light.response, display::kResponseNames);
    }
    out.field_unless("light.gamma", light.gamma, Light{}.gamma);

    const Power none;
    out.field_unless("power.led_ma", display.power.led_ma, none.led_ma);
    out.field_unless("power.max_duty", display.power.max_duty, none.max_duty);
    out.field_unless("power.limit_ma", display.power.limit_ma, none.limit_ma);
}

}  // namespace

std::string cpp_name(std::string_view display_name) {
    std::string name = "k";
    bool first_of_word = true;
    for (const char c : display_name) {
        const bool kept = is_letter(c) || is_digit(c);
        if (kept) name += first_of_word && c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
        first_of_word = !kept;
    }
    return name == "k" ? "kDisplay" : name;
}

std::string to_cpp(const DisplayDescription& display) {
    const std::string name = cpp_name(display.name.view());
    const DisplayDescription plain;

    Writer out;
    out.line(fmt::format("display.name = DisplayName({});", quoted(display.name.view())));
    out.named("kind", "DisplayKind", display.kind, display::kKindNames);
    out.named("format", "PixelFormat", display.format, display::kFormatNames);
    out.field("slices", display.slices);
    out.field("cycles_per_second", display.cycles_per_second);
    out.field_unless("plane_pitch_mm", display.plane_pitch_mm, plain.plane_pitch_mm);
    out.field_unless("sweep_deg", display.sweep_deg, plain.sweep_deg);
    out.field_unless("clockwise", display.clockwise, plain.clockwise);
    out.field_unless("blades", display.blades, plain.blades);
    write_motion(out, display.motion);
    out.field("panel_count", display.panel_count);
    for (std::size_t p = 0; p < display.panel_count; ++p) write_panel(out, display.panels[p], p);

    std::string tables;
    if (!display.points.empty()) {
        tables += fmt::format("inline constexpr PointMm {}Points[] = {{\n", name);
        for (const PointMm& point : display.points) {
            tables += fmt::format("    {{{}, {}, {}}},\n", literal(point.x), literal(point.y), literal(point.z));
        }
        tables += "};\n\n";
        out.line(fmt::format("display.points = {}Points;", name));
    }
    if (!display.plane_heights_mm.empty()) {
        tables += fmt::format("inline constexpr double {}PlaneHeightsMm[] = {{\n", name);
        for (const double height : display.plane_heights_mm) tables += fmt::format("    {},\n", literal(height));
        tables += "};\n\n";
        out.line(fmt::format("display.plane_heights_mm = {}PlaneHeightsMm;", name));
    }
    write_driving(out, display);

    constexpr std::size_t countable = 1000;
    const std::string check =
        display.points.size() > countable
            ? ""
            : fmt::format("static_assert(geometry_digest({}) == 0x{:016x}u);\n", name, geometry_digest(display));
    return fmt::format(
        "// The display {}. Written by xorvox, from its display file.\n"
        "#pragma once\n\n"
        "#include \"driver/display/description.h\"\n\n"
        "namespace xorvox::displays {{\n\n"
        "{}"
        "inline constexpr DisplayDescription {} = [] {{\n"
        "    DisplayDescription display;\n"
        "{}"
        "    return display;\n"
        "}}();\n"
        "{}\n"
        "}}  // namespace xorvox::displays\n",
        quoted(display.name.view()), tables, name, out.text(), check);
}

}  // namespace xorvox
