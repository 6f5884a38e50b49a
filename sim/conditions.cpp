#include "sim/conditions.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "driver/display/toml_file.h"
#include "driver/display/toml_table.h"
#include "driver/display/toml_tree.h"
#include "sim/fault_keys.h"

namespace xorvox::sim {
namespace {

using display::Key;
using display::Mistakes;
using display::Range;
using display::TomlNode;
using display::TomlTable;

/// As many as a double counts one by one.
constexpr Range kSeed{0, 9007199254740991.0, true};
constexpr std::size_t kMostFaults = 1000;

struct RotorKey {
    std::string_view name;
    double RotorConditions::*field;  ///< nullptr: stall_s.
    Range range;

    void set(RotorConditions& rotor, double value) const {
        if (field == nullptr) {
            rotor.stall_s = value;
        } else {
            rotor.*field = value;
        }
    }
    /// On a command line, where times are in seconds.
    std::string_view typed() const { return name.ends_with("_s") ? name.substr(0, name.size() - 2) : name; }
};
constexpr RotorKey kRotorKeys[] = {
    {"speed", &RotorConditions::speed, {0.001, 1000}},
    {"spin_up_s", &RotorConditions::spin_up_s, {0, 3600}},
    {"acceleration", &RotorConditions::acceleration, {-1000, 1000}},
    {"jitter", &RotorConditions::jitter, {0, 0.5}},
    {"missed", &RotorConditions::missed, {0, 1}},
    {"doubled", &RotorConditions::doubled, {0, 1}},
    {"noise", &RotorConditions::noise, {0, 0.5}},
    {"stall_s", nullptr, {0, 1e6}},
};

std::optional<double> read(TomlTable& table, std::string_view key, const Range& range) {
    double value = 0.0;
    if (table.find(key) == nullptr) return std::nullopt;
    if (range.whole) {
        table.whole(key, range, value);
        return value;
    }
    table.number(key, value);
    if (const auto wrong = display::check(value, range)) table.note(key, *wrong);
    return value;
}

void read_rotor(TomlTable& top, std::optional<RotorConditions>& conditions, Mistakes& mistakes) {
    const TomlNode* node = top.find("rotor");
    if (node == nullptr) return;
    RotorConditions& rotor = conditions.emplace();
    if (node->type != TomlNode::Type::Table) return top.wrong(*node, "rotor", "a [rotor] table");
    TomlTable table(*node, "rotor.", mistakes);
    std::vector<Key> keys;
    for (const RotorKey& key : kRotorKeys) keys.push_back({key.name});
    table.refuse_unknown(keys);
    for (const RotorKey& key : kRotorKeys) {
        if (const auto value = read(table, key.name, key.range)) key.set(rotor, *value);
    }
}

void read_fault(const TomlNode& node, std::string_view place, Faults& faults, Mistakes& mistakes) {
    TomlTable table(node, place, mistakes);
    std::string name;
    if (node.find("kind") == nullptr) return table.note_missing("kind");
    table.text("kind", name);
    if (mistakes.is_spoilt(node, "kind")) return;
    const Expected<FaultKind> kind = find_fault_kind(name);
    if (!kind) return table.note("kind", kind.error().message);
    std::vector<Key> keys{{"kind"}};
    for (const FaultKey& key : fault_keys(*kind)) keys.push_back({key.name});
    table.refuse_unknown(keys);
    Fault fault;
    fault.kind = *kind;
    for (const FaultKey& key : fault_keys(*kind)) {
        if (key.required && node.find(key.name) == nullptr) table.note_missing(key.name);
        if (const auto value = read(table, key.name, key.range)) key.set(fault, *value);
    }
    faults.list.push_back(fault);
}

void read_faults(TomlTable& top, Faults& faults, Mistakes& mistakes) {
    const TomlNode* list = top.find("fault");
    if (list == nullptr) return;
    constexpr std::string_view kAllowed = "a [[fault]] table for each";
    if (list->type != TomlNode::Type::List) return top.wrong(*list, "fault", kAllowed);
    if (list->items.size() > kMostFaults) {
        return top.note("fault", fmt::format("found {} faults; allowed: up to {}", list->items.size(), kMostFaults));
    }
    for (std::size_t i = 0; i < list->items.size(); ++i) {
        const TomlNode& node = list->items[i];
        if (node.type != TomlNode::Type::Table) return top.wrong(node, "fault", kAllowed);
        read_fault(node, fmt::format("fault {}: ", i + 1), faults, mistakes);
    }
}

}  // namespace

Expected<Conditions> parse_conditions(std::string_view toml, std::string_view source) {
    const auto root = display::parse_toml(toml);
    if (!root) return fail(fmt::format("{}: line {}: {}", source, root.error().line, root.error().message));
    Conditions conditions;
    Mistakes mistakes;
    TomlTable top(*root, "", mistakes);
    constexpr Key kKeys[] = {{"seed"}, {"rotor"}, {"fault"}};
    top.refuse_unknown(kKeys);
    read_rotor(top, conditions.rotor, mistakes);
    read_faults(top, conditions.faults, mistakes);
    if (const auto seed = read(top, "seed", kSeed)) {
        conditions.faults.seed = static_cast<std::uint64_t>(*seed);
        if (conditions.rotor) conditions.rotor->seed = conditions.faults.seed;
    }
    if (mistakes.list.empty()) return conditions;
    const auto first = std::ranges::min_element(mistakes.list, {}, &DisplayMistake::line);
    return fail(fmt::format("{}: line {}: {}", source, first->line, first->message));
}

Expected<Conditions> load_conditions(const std::string& path) {
    const Expected<std::string> text = display::read_file(path, "file for --sim");
    if (!text) return tl::unexpected(text.error());
    return parse_conditions(*text, path);
}

Expected<RotorConditions> parse_rotor(std::string_view text) {
    const auto settings = split_settings(text);
    if (!settings) return tl::unexpected(settings.error());
    std::vector<std::string_view> known;
    for (const RotorKey& key : kRotorKeys) known.push_back(key.typed());
    known.push_back("seed");
    RotorConditions rotor;
    for (const Setting& setting : *settings) {
        const auto key = std::ranges::find_if(kRotorKeys, [&](const RotorKey& known_key) {
            return setting.name == known_key.typed() || setting.name == known_key.name;
        });
        const bool is_seed = setting.name == "seed";
        if (key == std::end(kRotorKeys) && !is_seed) return fail(unknown_name("key", setting.name, known));
        const Expected<double> value = read_number(setting, is_seed ? kSeed : key->range);
        if (!value) return tl::unexpected(value.error());
        if (is_seed) {
            rotor.seed = static_cast<std::uint64_t>(*value);
        } else {
            key->set(rotor, *value);
        }
    }
    return rotor;
}

}  // namespace xorvox::sim
