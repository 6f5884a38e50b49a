#include "driver/display/toml_table.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include <fmt/format.h>

namespace xorvox::display {
namespace {

std::string found(const TomlNode& node) {
    switch (node.type) {
        case TomlNode::Type::Text: return fmt::format("the text {}", in_quotes(node.text));
        case TomlNode::Type::Whole: return fmt::format("{}", node.whole);
        case TomlNode::Type::Number: return fmt::format("the number {}", node.number);
        case TomlNode::Type::Truth: return node.truth ? "true" : "false";
        case TomlNode::Type::List: return "a list";
        case TomlNode::Type::Table: return "a table";
        case TomlNode::Type::Date: break;
    }
    return "a date or time";
}

bool is_number(const TomlNode& node) {
    return node.type == TomlNode::Type::Number || node.type == TomlNode::Type::Whole;
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

/// `"a", "b" or "c"`.
std::string alternatives(std::span<const std::string_view> names) {
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const std::string_view joint = i == 0 ? "" : i + 1 == names.size() ? " or " : ", ";
        text += fmt::format("{}\"{}\"", joint, names[i]);
    }
    return text;
}

}  // namespace

std::string_view nearest_name(std::string_view name, std::span<const std::string_view> names) {
    name = name.substr(0, 64);
    return *std::ranges::min_element(names, {}, [name](std::string_view other) { return edit_distance(name, other); });
}

void TomlTable::refuse_unknown(std::span<const Key> keys) {
    std::vector<std::string_view> names;
    for (const Key& key : keys) names.push_back(key.name);
    for (std::size_t i = 0; i < table_.names.size(); ++i) {
        const std::string_view name = table_.names[i];
        if (std::ranges::find(keys, name, &Key::name) != keys.end()) continue;
        std::string known;
        for (const Key& key : keys) known += fmt::format("{}{}", known.empty() ? "" : ", ", key.name);
        misspelt_.push_back(nearest_name(name, names));
        mistakes_.list.push_back(
            {table_.items[i].line, fmt::format("{}unknown key {}; the nearest one is \"{}\" of {}", before(),
                                               in_quotes(path(name)), misspelt_.back(), known)});
    }
}

void TomlTable::check_keys(std::span<const Key> keys, DisplayKind kind) {
    for (const Key& key : keys) {
        const TomlNode* node = find(key.name);
        if (node == nullptr) {
            if (key.required_by.has(kind)) note_missing(key.name);
        } else if (!key.known_to.has(kind)) {
            std::vector<std::string_view> kinds;
            for (const auto& named : kKindNames) {
                if (key.known_to.has(named.value)) kinds.push_back(named.name);
            }
            note(key.name, fmt::format("does not apply to kind \"{}\", only to {}; remove it", kind_name(kind),
                                       alternatives(kinds)));
        }
    }
}

void TomlTable::note_missing(std::string_view key) {
    if (std::ranges::find(misspelt_, key) != misspelt_.end()) return mistakes_.spoil(table_, key);
    const std::string_view header = key == "panel"    ? "; add a [[panel]] table"
                                    : key == "motion" ? "; add a [motion] table"
                                                      : "";
    add(key,
        {table_.line, fmt::format("{}the required key {} is missing{}", before(), in_quotes(path(key)), header), true});
}

void TomlTable::text(std::string_view key, std::string& value) {
    const TomlNode* node = find(key);
    if (node == nullptr) return;
    if (node->type != TomlNode::Type::Text) return wrong(*node, key, "a text in quotes");
    if (std::ranges::any_of(node->text, is_control)) {
        return wrong(*node, key, "a text of one line, without control characters");
    }
    value = node->text;
}

void TomlTable::truth(std::string_view key, bool& value) {
    const TomlNode* node = find(key);
    if (node == nullptr) return;
    if (node->type != TomlNode::Type::Truth) return wrong(*node, key, "true or false");
    value = node->truth;
}

void TomlTable::number(std::string_view key, double& value) {
    const TomlNode* node = find(key);
    if (node == nullptr) return;
    if (!is_number(*node)) return wrong(*node, key, "a number");
    value = node->number;
}

void TomlTable::numbers(std::string_view key, std::vector<double>& values) {
    const TomlNode* node = list(key, "a list of numbers");
    if (node == nullptr) return;
    values.clear();
    for (const TomlNode& item : node->items) {
        if (!is_number(item)) return wrong(item, key, "a list of numbers");
        values.push_back(item.number);
    }
}

void TomlTable::points(std::string_view key, std::vector<PointMm>& values) {
    constexpr std::string_view allowed = "a list of places, each [x, y, z] in millimetres";
    const TomlNode* node = list(key, allowed);
    if (node == nullptr) return;
    values.clear();
    for (const TomlNode& item : node->items) {
        if (item.type != TomlNode::Type::List) return wrong(item, key, allowed);
        if (item.items.size() != 3) {
            return add(key, {item.line, fmt::format("{}{}: found a place of {} numbers; allowed: {}", place_, key,
                                                    item.items.size(), allowed)});
        }
        for (const TomlNode& number : item.items) {
            if (!is_number(number)) return wrong(number, key, allowed);
        }
        values.push_back({item.items[0].number, item.items[1].number, item.items[2].number});
    }
}

void TomlTable::texts(std::string_view key, std::vector<std::string>& values) {
    const TomlNode* node = list(key, "a list of texts in quotes");
    if (node == nullptr) return;
    values.clear();
    for (const TomlNode& item : node->items) {
        if (item.type != TomlNode::Type::Text) return wrong(item, key, "a list of texts in quotes");
        values.push_back(item.text);
    }
}

void TomlTable::note(std::string_view key, std::string_view message) {
    const TomlNode* node = find(key);
    add(key, {node == nullptr ? table_.line : node->line, fmt::format("{}{}: {}", place_, key, message)});
}

void TomlTable::wrong(const TomlNode& node, std::string_view key, std::string_view allowed) {
    add(key, {node.line, fmt::format("{}{}: found {}; allowed: {}", place_, key, found(node), allowed)});
}

void TomlTable::add(std::string_view key, DisplayMistake mistake) {
    mistakes_.list.push_back(std::move(mistake));
    mistakes_.spoil(table_, key);
}

std::optional<std::int64_t> TomlTable::whole_in(std::string_view key, const Range& range) {
    const TomlNode* node = find(key);
    if (node == nullptr) return std::nullopt;
    if (node->type != TomlNode::Type::Whole) {
        wrong(*node, key, fmt::format("a whole number from {} to {}", range.lowest, range.highest));
        return std::nullopt;
    }
    if (const auto message = check(node->number, range)) {
        note(key, *message);
        return std::nullopt;
    }
    return node->whole;
}

std::optional<std::size_t> TomlTable::one_of(std::string_view key, std::span<const std::string_view> names) {
    const TomlNode* node = find(key);
    if (node == nullptr) return std::nullopt;
    const auto name = std::ranges::find(names, std::string_view(node->text));
    if (node->type == TomlNode::Type::Text && name != names.end()) {
        return static_cast<std::size_t>(name - names.begin());
    }
    wrong(*node, key, alternatives(names));
    return std::nullopt;
}

/// `key` with the table's name before it, unless before() says where it is.
std::string TomlTable::path(std::string_view key) const {
    return place_.ends_with('.') ? fmt::format("{}{}", place_, key) : std::string(key);
}

std::string_view TomlTable::before() const {
    return place_.ends_with('.') ? std::string_view() : place_;
}

const TomlNode* TomlTable::list(std::string_view key, std::string_view of_what) {
    const TomlNode* node = find(key);
    if (node == nullptr || node->type == TomlNode::Type::List) return node;
    wrong(*node, key, of_what);
    return nullptr;
}

}  // namespace xorvox::display
