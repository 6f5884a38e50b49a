#include "driver/display/toml.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <system_error>

#include <fmt/format.h>

// toml++ 3.3 asserts, or under NDEBUG tells the compiler to assume, some things that bad text breaks (as a control
// character after "[" does), just before it finds and reports the error in good order. So neither.
#undef NDEBUG
#define TOML_ASSERT(condition) static_assert(true)
#define TOML_EXCEPTIONS 0
#define TOML_ENABLE_FORMATTERS 0
#include <toml++/toml.h>

#include "driver/display/rules.h"
#include "driver/display/toml_guard.h"

namespace xorvox {
namespace {

constexpr std::size_t kMaxFileBytes = std::size_t{1} << 20;

/// A key that a table may have.
struct Key {
    std::string_view name;
    bool required = false;
    std::optional<DisplayKind> only_for;
};

constexpr Key kDisplayKeys[] = {
    {"name", true},
    {"summary"},
    {"kind", true},
    {"format", true},
    {"slices", true},
    {"plane_pitch_mm", true, DisplayKind::StackedPlanes},
    {"cycles_per_second", true},
    {"clockwise", false, DisplayKind::RotatingPanel},
    {"panel", true},
};

constexpr Key kPanelKeys[] = {
    {"columns", true},
    {"rows", true},
    {"column_pitch_mm", true},
    {"row_pitch_mm", true},
    {"shift_mm", false, DisplayKind::RotatingPanel},
    {"offset_mm", false, DisplayKind::RotatingPanel},
    {"lift_mm", false, DisplayKind::RotatingPanel},
    {"angle_deg", false, DisplayKind::RotatingPanel},
};

bool is_control(char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
}

/// `text` on one line.
std::string one_line(std::string_view text) {
    std::string line(text);
    std::replace_if(line.begin(), line.end(), is_control, '?');
    return line;
}

/// `text` in quotes, on one line, cut after some 40 bytes.
std::string in_quotes(std::string_view text) {
    constexpr std::size_t most = 40;
    if (text.size() <= most) return fmt::format("\"{}\"", one_line(text));
    std::size_t end = most;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
    return fmt::format("\"{}…\"", one_line(text.substr(0, end)));
}

std::string found(const toml::node& node) {
    if (const auto* text = node.as_string()) return fmt::format("the text {}", in_quotes(text->get()));
    if (const auto* whole = node.as_integer()) return fmt::format("{}", whole->get());
    if (const auto* number = node.as_floating_point()) return fmt::format("the number {}", number->get());
    if (const auto* truth = node.as_boolean()) return truth->get() ? "true" : "false";
    if (node.is_table()) return "a table";
    if (node.is_array()) return "a list";
    return "a date or time";
}

/// Levenshtein's distance: how many letters must be added, removed or changed to make `a` into `b`.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = std::exchange(row[0], i + 1);
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t changed = diagonal + (a[i] != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = std::min({changed, row[j] + 1, diagonal + 1});
        }
    }
    return row[b.size()];
}

std::string_view nearest_key(std::string_view name, std::span<const Key> keys) {
    return std::ranges::min_element(keys, {}, [name](const Key& key) { return edit_distance(name, key.name); })->name;
}

/// Reads one parsed file. Each step answers false once `error_` is set.
class Reader {
public:
    explicit Reader(std::string_view source) : source_(source) {}

    Expected<DisplayDescription> read(const toml::table& root) {
        root_ = &root;
        if (!read_display() || !check_rules()) return tl::unexpected<Error>(std::move(error_));
        return display_;
    }

private:
    bool read_display() {
        const toml::table& root = *root_;
        if (!refuse_unknown(root, kDisplayKeys) || !read_kind() || !check_keys(root, kDisplayKeys)) return false;
        return read_name() && read_summary() && read_format() && whole("slices", display::kSlices, display_.slices) &&
               number("plane_pitch_mm", display_.plane_pitch_mm) &&
               number("cycles_per_second", display_.cycles_per_second) && truth("clockwise", display_.clockwise) &&
               read_panels();
    }

    bool read_panels() {
        const toml::node& node = *root_->get("panel");
        const toml::array* list = node.as_array();
        if (list == nullptr) return wrong(node, "panel", "one [[panel]] table for each panel");
        if (list->empty() || list->size() > kMaxPanels) {
            return at(node, fmt::format("panel: found {} panels; allowed: 1 to {}", list->size(), kMaxPanels));
        }
        display_.panel_count = static_cast<std::uint32_t>(list->size());
        for (std::size_t p = 0; p < list->size(); ++p) {
            const toml::table* table = list->get(p)->as_table();
            if (table == nullptr) return wrong(*list->get(p), "panel", "one [[panel]] table for each panel");
            panel_ = p;
            if (!read_panel(*table, display_.panels[p])) return false;
        }
        panel_.reset();
        return true;
    }

    bool read_panel(const toml::table& table, Panel& panel) {
        return refuse_unknown(table, kPanelKeys) && check_keys(table, kPanelKeys) &&
               whole("columns", display::kPixels, panel.columns) && whole("rows", display::kPixels, panel.rows) &&
               number("column_pitch_mm", panel.column_pitch_mm) && number("row_pitch_mm", panel.row_pitch_mm) &&
               number("shift_mm", panel.shift_mm) && number("offset_mm", panel.offset_mm) &&
               number("lift_mm", panel.lift_mm) && number("angle_deg", panel.angle_deg);
    }

    bool read_name() {
        std::string name;
        if (!text("name", name)) return false;
        if (name.empty() || name.size() >= DisplayName{}.text.size()) {
            return at(*root_->get("name"), fmt::format("name: found {} bytes; allowed: 1 to 31", name.size()));
        }
        display_.name = DisplayName(name);
        return true;
    }

    bool read_summary() {
        std::string summary;
        return root_->get("summary") == nullptr || text("summary", summary);
    }

    bool read_kind() {
        const toml::node* node = root_->get("kind");
        if (node == nullptr) return missing(*root_, "kind");
        const std::string kind = node->value_or(std::string());
        for (const DisplayKind known : {DisplayKind::StackedPlanes, DisplayKind::RotatingPanel}) {
            if (kind == display::kind_name(known)) {
                display_.kind = known;
                return true;
            }
        }
        return wrong(*node, "kind", "\"stacked-planes\" or \"rotating-panel\"");
    }

    bool read_format() {
        const toml::node& node = *root_->get("format");
        const std::string format = node.value_or(std::string());
        for (const PixelFormat known :
             {PixelFormat::Mono1, PixelFormat::Rgb111, PixelFormat::Rgb332, PixelFormat::Rgb565, PixelFormat::Rgb888}) {
            if (format == to_string(known)) {
                display_.format = known;
                return true;
            }
        }
        return wrong(node, "format", "\"mono1\", \"rgb111\", \"rgb332\", \"rgb565\" or \"rgb888\"");
    }

    // Values of the table in hand: panel panel_'s if set, else the display's own. A key that is absent keeps its
    // default.

    const toml::node* find(std::string_view key) const { return table_of(panel_).get(key); }

    bool text(std::string_view key, std::string& value) {
        const toml::node& node = *find(key);
        if (!node.is_string()) return wrong(node, key, "a text in quotes");
        value = node.as_string()->get();
        if (std::ranges::any_of(value, is_control))
            return wrong(node, key, "a text of one line, without control characters");
        return true;
    }

    bool truth(std::string_view key, bool& value) {
        const toml::node* node = find(key);
        if (node == nullptr) return true;
        if (!node->is_boolean()) return wrong(*node, key, "true or false");
        value = node->as_boolean()->get();
        return true;
    }

    /// The range is checked here, before `value`'s type cuts the number.
    template <class Integer>
    bool whole(std::string_view key, const display::Range& range, Integer& value) {
        const toml::node& node = *find(key);
        if (!node.is_integer()) {
            return wrong(node, key, fmt::format("a whole number from {} to {}", range.lowest, range.highest));
        }
        const std::int64_t number = node.as_integer()->get();
        if (const auto message = display::check(static_cast<double>(number), range)) {
            return at(node, fmt::format("{}: {}", key, *message));
        }
        value = static_cast<Integer>(number);
        return true;
    }

    bool number(std::string_view key, double& value) {
        const toml::node* node = find(key);
        if (node == nullptr) return true;
        if (!node->is_number()) return wrong(*node, key, "a number");
        value = node->is_integer() ? static_cast<double>(node->as_integer()->get()) : node->as_floating_point()->get();
        return true;
    }

    // What is wrong, and where.

    bool refuse_unknown(const toml::table& table, std::span<const Key> keys) {
        for (const auto& [name, node] : table) {
            if (std::ranges::find(keys, name.str(), &Key::name) != keys.end()) continue;
            std::string known;
            for (const Key& key : keys) known += fmt::format("{}{}", known.empty() ? "" : ", ", key.name);
            return at(node, fmt::format("unknown key {}; the nearest one is \"{}\" of {}", in_quotes(name.str()),
                                        nearest_key(std::string_view(name.str()).substr(0, 64), keys), known));
        }
        return true;
    }

    bool check_keys(const toml::table& table, std::span<const Key> keys) {
        for (const Key& key : keys) {
            const toml::node* node = table.get(key.name);
            const bool applies = !key.only_for || *key.only_for == display_.kind;
            if (node != nullptr && !applies) {
                return at(*node, fmt::format("{}: does not apply to kind \"{}\", only to \"{}\"; remove it", key.name,
                                             display::kind_name(display_.kind), display::kind_name(*key.only_for)));
            }
            if (node == nullptr && applies && key.required) return missing(table, key.name);
        }
        return true;
    }

    bool check_rules() {
        const auto bad = display::find_violation(display_);
        if (!bad) return true;
        panel_ = bad->panel;
        const toml::node* node = find(bad->key);
        return at(node != nullptr ? *node : table_of(panel_), fmt::format("{}: {}", bad->key, bad->message));
    }

    bool missing(const toml::table& table, std::string_view key) {
        const std::string_view header = key == "panel" ? "; add a [[panel]] table" : "";
        return at(table, fmt::format("the required key \"{}\" is missing{}", key, header));
    }

    bool wrong(const toml::node& node, std::string_view key, std::string_view allowed) {
        return at(node, fmt::format("{}: found {}; allowed: {}", key, found(node), allowed));
    }

    bool at(const toml::node& node, std::string_view message) {
        const std::string panel = panel_ ? fmt::format("panel {}: ", *panel_ + 1) : "";
        error_.message = fmt::format("{}: line {}: {}{}", source_, node.source().begin.line, panel, message);
        return false;
    }

    const toml::table& table_of(std::optional<std::size_t> panel) const {
        return panel ? *root_->get("panel")->as_array()->get(*panel)->as_table() : *root_;
    }

    std::string_view source_;
    const toml::table* root_ = nullptr;
    DisplayDescription display_;
    std::optional<std::size_t> panel_;  ///< The panel that is being read.
    Error error_;
};

Expected<std::string> read_file(const std::string& path) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) {
        return fail(fmt::format("{}: is a directory; a display file (.toml) was expected", path));
    }
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
    if (file == nullptr) {
        return fail(fmt::format("{}: cannot open the display file: {}", path, std::generic_category().message(errno)));
    }
    std::string text(kMaxFileBytes + 1, '\0');
    text.resize(std::fread(text.data(), 1, text.size(), file.get()));
    if (std::ferror(file.get()) != 0) {
        return fail(fmt::format("{}: cannot read the display file: {}", path, std::generic_category().message(errno)));
    }
    if (text.size() > kMaxFileBytes) {
        return fail(fmt::format("{}: longer than {} bytes, which no display file is", path, kMaxFileBytes));
    }
    return text;
}

}  // namespace

Expected<DisplayDescription> parse_display(std::string_view toml, std::string_view source) {
    if (const auto stray = display::find_stray(toml)) {
        return fail(fmt::format("{}: line {}: not valid here: {}", source, stray->line, stray->message));
    }
    const toml::parse_result result = toml::parse(toml, source);
    if (!result) {
        return fail(fmt::format("{}: line {}: not valid TOML: {}", source, result.error().source().begin.line,
                                one_line(result.error().description())));
    }
    return Reader(source).read(result.table());
}

Expected<DisplayDescription> load_display(const std::string& name_or_path) {
    if (name_or_path.find('/') != std::string::npos || name_or_path.ends_with(".toml")) {
        const auto text = read_file(name_or_path);
        if (!text) return tl::unexpected<Error>(text.error());
        return parse_display(*text, name_or_path);
    }
    std::string names;
    for (const Preset& preset : presets()) {
        if (preset.name == name_or_path) return parse_display(preset.text, preset.name);
        names += fmt::format("{}{}", names.empty() ? "" : ", ", preset.name);
    }
    return fail(fmt::format("unknown display \"{}\"; presets: {}; or give the path of a display file, ending in .toml",
                            one_line(name_or_path), names));
}

}  // namespace xorvox
