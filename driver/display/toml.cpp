#include "driver/display/toml.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "driver/display/names.h"
#include "driver/display/rules.h"
#include "driver/display/toml_table.h"
#include "driver/display/toml_tree.h"

namespace xorvox {
namespace {

using display::kAllKinds;
using display::Key;
using display::Kinds;
using display::Mistakes;
using display::TomlNode;
using display::TomlTable;

constexpr Kinds kNone{};
constexpr Kinds kStack{DisplayKind::StackedPlanes};
constexpr Kinds kRotor{DisplayKind::RotatingPanel};
constexpr Kinds kSwept{DisplayKind::SweptPlane};
constexpr Kinds kHelix{DisplayKind::Helix};
constexpr Kinds kTurns{DisplayKind::RotatingPanel, DisplayKind::Helix};
constexpr Kinds kStroke{DisplayKind::SweptPlane, DisplayKind::Helix};
constexpr Kinds kFree{DisplayKind::FreePoints};
constexpr Kinds kFlat{DisplayKind::StackedPlanes, DisplayKind::RotatingPanel, DisplayKind::SweptPlane,
                      DisplayKind::Helix};

constexpr Key kDisplayKeys[] = {
    {"name", kAllKinds},
    {"summary"},
    {"assumed"},
    {"kind", kAllKinds},
    {"format", kAllKinds},
    {"slices", kFlat, kFlat},
    {"cycles_per_second", kAllKinds},
    {"plane_pitch_mm", kNone, kStack},
    {"plane_heights_mm", kNone, kStack},
    {"sweep_deg", kNone, kRotor},
    {"clockwise", kNone, kTurns},
    {"blades", kNone, kHelix},
    {"points", kFree, kFree},
    {"motion", kStroke, kStroke},
    {"sync"},
    {"scan"},
    {"light"},
    {"power"},
    {"panel", kAllKinds},
};

constexpr Key kPanelKeys[] = {
    {"columns", kAllKinds},
    {"rows", kAllKinds},
    {"column_pitch_mm", kFlat},
    {"row_pitch_mm", kFlat},
    {"shift_mm", kNone, kRotor},
    {"offset_mm", kNone, kRotor},
    {"lift_mm", kNone, kRotor},
    {"angle_deg", kNone, kRotor},
    {"tilt_deg", kNone, kRotor},
    {"skew_mm", kNone, kRotor},
    {"mirrored", kNone, kRotor},
    {"turned", kNone, kRotor},
    {"connector"},
    {"chain_position"},
};

constexpr Key kMotionKeys[] = {
    {"stroke_mm", kStroke},       {"profile", kNone, kSwept}, {"both_ways", kNone, kSwept},
    {"dead_zone", kNone, kSwept}, {"table", kNone, kSwept},
};

constexpr Key kSyncKeys[] = {
    {"index"}, {"index_pulses"}, {"index_phase"}, {"slowest_cycles_per_second"}, {"fastest_cycles_per_second"}};

constexpr Key kScanKeys[] = {{"driver"},           {"pixel_clock_hz"}, {"latch_ns"},   {"min_on_ns"},  {"rise_ns"},
                             {"fall_ns"},          {"row_groups"},     {"bit_planes"}, {"strings"},    {"bit_order"},
                             {"planes_per_frame"}, {"register_order"}, {"serpentine"}, {"color_order"}};

constexpr Key kLightKeys[] = {{"response"}, {"gamma"}};

constexpr Key kPowerKeys[] = {{"led_ma"}, {"max_duty"}, {"limit_ma"}};

/// Reads one parsed file.
class Reader {
public:
    explicit Reader(const TomlNode& root) : root_(root), top_(root, "", mistakes_) {}

    /// Mistakes by line; none: the display is whole.
    std::vector<DisplayMistake> read() {
        top_.refuse_unknown(kDisplayKeys);
        if (top_.find("kind") == nullptr) top_.note_missing("kind");
        top_.choice("kind", display::kKindNames, display_.kind);
        knows_kind_ = !mistakes_.is_spoilt(root_, "kind");
        read_display();
        if (knows_kind_) check_numbers();
        if (mistakes_.list.empty()) check_contradictions();
        std::ranges::stable_sort(mistakes_.list, [](const DisplayMistake& a, const DisplayMistake& b) {
            return a.missing != b.missing ? b.missing : a.line < b.line;
        });
        return std::move(mistakes_.list);
    }

    DisplayFile take() { return std::move(display_); }

private:
    void read_display() {
        check_keys(top_, kDisplayKeys);
        read_name();
        top_.text("summary", display_.summary);
        top_.choice("format", display::kFormatNames, display_.format);
        display_.slices = 1;
        top_.whole("slices", display::kSlices, display_.slices);
        top_.number("cycles_per_second", display_.cycles_per_second);
        top_.number("plane_pitch_mm", display_.plane_pitch_mm);
        top_.number("sweep_deg", display_.sweep_deg);
        top_.truth("clockwise", display_.clockwise);
        top_.whole("blades", display::kBlades, display_.blades);
        read_plane_heights();
        read_points();
        read_table("motion", kMotionKeys, &Reader::read_motion);
        read_table("sync", kSyncKeys, &Reader::read_sync);
        read_table("scan", kScanKeys, &Reader::read_scan);
        read_table("light", kLightKeys, &Reader::read_light);
        read_table("power", kPowerKeys, &Reader::read_power);
        read_panels();
        read_assumed();
    }

    /// Without a kind, nobody knows which keys are needed.
    void check_keys(TomlTable& table, std::span<const Key> keys) {
        if (knows_kind_) table.check_keys(keys, display_.kind);
    }

    void read_name() {
        std::string name;
        top_.text("name", name);
        const TomlNode* node = top_.find("name");
        if (node == nullptr || node->type != TomlNode::Type::Text) return;
        if (node->text.empty() || node->text.size() >= DisplayName{}.text.size()) {
            return top_.note("name", fmt::format("found {} bytes; allowed: 1 to 31", node->text.size()));
        }
        display_.name = DisplayName(name);
    }

    void read_plane_heights() {
        const bool uneven = top_.find("plane_heights_mm") != nullptr;
        const bool even = top_.find("plane_pitch_mm") != nullptr;
        if (knows_kind_ && display_.kind == DisplayKind::StackedPlanes && uneven == even) {
            if (even) {
                mistakes_.spoil(root_, "plane_pitch_mm");
                return top_.note("plane_heights_mm", "found beside plane_pitch_mm; allowed: one of the two");
            }
            top_.note_missing("plane_pitch_mm");
        }
        if (!uneven) return;
        std::vector<double> heights;
        top_.numbers("plane_heights_mm", heights);
        display_.plane_heights_memory = std::make_shared<const std::vector<double>>(std::move(heights));
        display_.plane_heights_mm = *display_.plane_heights_memory;
    }

    void read_points() {
        if (top_.find("points") == nullptr) return;
        std::vector<PointMm> points;
        top_.points("points", points);
        display_.points_memory = std::make_shared<const std::vector<PointMm>>(std::move(points));
        display_.points = *display_.points_memory;
    }

    /// A table of its own, if the file has it; `fields` reads them.
    void read_table(std::string_view name, std::span<const Key> keys, void (Reader::*fields)(TomlTable&)) {
        const TomlNode* node = top_.find(name);
        if (node == nullptr) return;
        if (node->type != TomlNode::Type::Table) return top_.wrong(*node, name, fmt::format("a [{}] table", name));
        const std::string place = fmt::format("{}.", name);
        TomlTable table(*node, place, mistakes_);
        table.refuse_unknown(keys);
        check_keys(table, keys);
        (this->*fields)(table);
    }

    void read_motion(TomlTable& table) {
        Motion& motion = display_.motion;
        table.number("stroke_mm", motion.stroke_mm);
        table.choice("profile", display::kProfileNames, motion.profile);
        table.truth("both_ways", motion.both_ways);
        table.number("dead_zone", motion.dead_zone);
        std::vector<double> heights;
        table.numbers("table", heights);
        if (heights.size() > kMaxMotionTable) {
            return table.note("table",
                              fmt::format("found {} heights; allowed: 2 to {}", heights.size(), kMaxMotionTable));
        }
        motion.table_size = static_cast<std::uint32_t>(heights.size());
        std::ranges::copy(heights, motion.table.begin());
    }

    void read_sync(TomlTable& table) {
        Sync& sync = display_.sync;
        table.choice("index", display::kIndexNames, sync.index);
        table.whole("index_pulses", display::kIndexPulses, sync.index_pulses);
        table.number("index_phase", sync.index_phase);
        table.number("slowest_cycles_per_second", sync.slowest_cycles_per_second);
        table.number("fastest_cycles_per_second", sync.fastest_cycles_per_second);
    }

    void read_scan(TomlTable& table) {
        Scan& scan = display_.scan;
        table.choice("driver", display::kDriverNames, scan.driver);
        table.whole("pixel_clock_hz", display::kClockHz, scan.pixel_clock_hz);
        table.whole("latch_ns", display::kScanNs, scan.latch_ns);
        table.whole("min_on_ns", display::kScanNs, scan.min_on_ns);
        table.whole("rise_ns", display::kScanNs, scan.rise_ns);
        table.whole("fall_ns", display::kScanNs, scan.fall_ns);
        table.whole("row_groups", display::kRowGroups, scan.row_groups);
        table.whole("bit_planes", display::kBitPlanes, scan.bit_planes);
        table.whole("strings", display::kStrings, scan.strings);
        table.whole("planes_per_frame", display::kPlanesPerFrame, scan.planes_per_frame);
        table.choice("bit_order", display::kBitOrderNames, scan.msb_first);
        table.choice("register_order", display::kRegisterOrderNames, scan.layers_first);
        table.truth("serpentine", scan.serpentine);
        std::string order(scan.color_order.begin(), scan.color_order.end());
        table.text("color_order", order);
        if (order.size() != scan.color_order.size()) {
            return table.note("color_order",
                              fmt::format("found {}; allowed: each of r, g and b once", display::in_quotes(order)));
        }
        std::ranges::copy(order, scan.color_order.begin());
    }

    void read_light(TomlTable& table) {
        Light& light = display_.light;
        table.choice("response", display::kResponseNames, light.response);
        const TomlNode* response = table.find("response");
        const bool is_gamma = light.response == Response::Gamma;
        const bool misspelt = response != nullptr && is_spoilt({"light.response", {}, "", {}});
        if (table.find("gamma") != nullptr && !is_gamma && !misspelt) {
            return table.note("gamma", fmt::format("found with response \"{}\"; allowed: with \"gamma\" alone",
                                                   name_of(display::kResponseNames, light.response)));
        }
        table.number("gamma", light.gamma);
    }

    void read_power(TomlTable& table) {
        table.number("led_ma", display_.power.led_ma);
        table.number("max_duty", display_.power.max_duty);
        table.number("limit_ma", display_.power.limit_ma);
    }

    void read_panels() {
        const TomlNode* list = top_.find("panel");
        if (list == nullptr) return;
        constexpr std::string_view allowed = "one [[panel]] table for each panel";
        if (list->type != TomlNode::Type::List) return top_.wrong(*list, "panel", allowed);
        for (const TomlNode& panel : list->items) {
            if (panel.type != TomlNode::Type::Table) return top_.wrong(panel, "panel", allowed);
        }
        if (list->items.empty() || list->items.size() > kMaxPanels) {
            return top_.note("panel", fmt::format("found {} panels; allowed: 1 to {}", list->items.size(), kMaxPanels));
        }
        display_.panel_count = static_cast<std::uint32_t>(list->items.size());
        for (std::size_t p = 0; p < list->items.size(); ++p) read_panel(list->items[p], p);
    }

    void read_panel(const TomlNode& node, std::size_t index) {
        Panel& panel = display_.panels[index];
        const std::string place = fmt::format("panel {}: ", index);
        TomlTable table(node, place, mistakes_);
        table.refuse_unknown(kPanelKeys);
        check_keys(table, kPanelKeys);
        table.whole("columns", display::kPixels, panel.columns);
        table.whole("rows", display::kPixels, panel.rows);
        table.number("column_pitch_mm", panel.column_pitch_mm);
        table.number("row_pitch_mm", panel.row_pitch_mm);
        table.number("shift_mm", panel.shift_mm);
        table.number("offset_mm", panel.offset_mm);
        table.number("lift_mm", panel.lift_mm);
        table.number("angle_deg", panel.angle_deg);
        table.number("tilt_deg", panel.tilt_deg);
        table.number("skew_mm", panel.skew_mm);
        table.truth("mirrored", panel.mirrored);
        table.whole("turned", display::kQuarterTurns, panel.turned);
        table.whole("connector", display::kConnectors, panel.connector);
        table.whole("chain_position", display::kConnectors, panel.chain_position);
        if (node.find("connector") != nullptr || node.find("chain_position") != nullptr) wiring_given_ = true;
    }

    void read_assumed() {
        top_.texts("assumed", display_.assumed);
        const TomlNode* list = top_.find("assumed");
        for (std::size_t i = 0; i < display_.assumed.size(); ++i) {
            const TomlNode* value = find_first(display_.assumed[i]);
            const std::size_t line = list->items[i].line;
            if (value == nullptr) {
                mistakes_.list.push_back({line, fmt::format("assumed: found {}, which is no key of this file",
                                                            display::in_quotes(display_.assumed[i]))});
            } else if (value == root_.find(display_.assumed[i]) && is_table(*value)) {
                mistakes_.list.push_back(
                    {line, fmt::format("assumed: found {}, which is a table; name its keys, as in"
                                       " \"{}.{}\"",
                                       display::in_quotes(display_.assumed[i]), display_.assumed[i],
                                       display_.assumed[i] == "panel" ? "rows" : "…")});
            }
        }
    }

    static bool is_table(const TomlNode& node) {
        return node.type == TomlNode::Type::Table || (node.type == TomlNode::Type::List && !node.items.empty() &&
                                                      node.items.front().type == TomlNode::Type::Table);
    }

    /// The value of "key" or "table.key"; of "panel.key" on the first panel that has it. nullptr: none.
    const TomlNode* find_first(std::string_view path) const {
        const std::size_t dot = path.find('.');
        const TomlNode* node = root_.find(path.substr(0, dot));
        if (node == nullptr || dot == path.npos) return node;
        const std::string_view key = path.substr(dot + 1);
        if (node->type == TomlNode::Type::Table) return node->find(key);
        if (path.substr(0, dot) != "panel") return nullptr;
        for (const TomlNode& panel : node->items) {
            if (const TomlNode* value = panel.find(key)) return value;
        }
        return nullptr;
    }

    /// A key that is spoilt already has nothing to be looked at.
    void check_numbers() {
        for (const display::Violation& violation : display::find_wrong_values(display_)) {
            if (!is_spoilt(violation))
                mistakes_.list.push_back({line_of(violation), display::in_words(violation, ": ")});
        }
    }

    bool is_spoilt(const display::Violation& violation) const {
        const auto is_bad = [&](std::string_view table, std::string_view key, std::size_t item) {
            if (mistakes_.is_spoilt(root_, table)) return true;
            const TomlNode* node = root_.find(table);
            if (node == nullptr || key.empty()) return false;
            return mistakes_.is_spoilt(node->type == TomlNode::Type::List ? node->items[item] : *node, key);
        };
        if (violation.panel) return is_bad("panel", violation.key, *violation.panel);
        const std::size_t dot = std::min(violation.key.find('.'), violation.key.size());
        return is_bad(violation.key.substr(0, dot), violation.key.substr(std::min(dot + 1, violation.key.size())), 0);
    }

    void check_contradictions() {
        const bool wiring_given = wiring_given_ || display::gives_wiring(display_);
        for (const display::Violation& violation : display::find_contradictions(display_, wiring_given)) {
            mistakes_.list.push_back({line_of(violation), display::in_words(violation, ": "), false, true});
        }
    }

    /// Of the key, or of the table that lacks it.
    std::size_t line_of(const display::Violation& violation) const {
        if (violation.panel) {
            const TomlNode& panel = root_.find("panel")->items[*violation.panel];
            const TomlNode* node = panel.find(violation.key);
            return node == nullptr ? panel.line : node->line;
        }
        const TomlNode* node = find_first(violation.key);
        if (node == nullptr) node = root_.find(violation.key.substr(0, violation.key.find('.')));
        if (node == nullptr) return root_.line;
        return violation.item ? node->items[*violation.item].line : node->line;
    }

    const TomlNode& root_;
    Mistakes mistakes_;
    TomlTable top_;
    DisplayFile display_;
    bool knows_kind_ = false;
    bool wiring_given_ = false;
};

}  // namespace

std::vector<DisplayMistake> find_mistakes(std::string_view toml) {
    const auto root = display::parse_toml(toml);
    if (!root) return {root.error()};
    return Reader(*root).read();
}

Expected<DisplayFile> parse_display(std::string_view toml, std::string_view source) {
    const auto refuse = [source](const DisplayMistake& mistake) {
        return fail(fmt::format("{}: line {}: {}", source, mistake.line, mistake.message));
    };
    const auto root = display::parse_toml(toml);
    if (!root) return refuse(root.error());
    Reader reader(*root);
    if (const auto mistakes = reader.read(); !mistakes.empty()) return refuse(mistakes.front());
    DisplayFile display = reader.take();
    display.text = toml;
    return display;
}

}  // namespace xorvox
