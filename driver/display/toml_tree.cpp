#include "driver/display/toml_tree.h"

#include <algorithm>

#include <fmt/format.h>

// toml++ 3.3 asserts, or under NDEBUG tells the compiler to assume, some things that bad text breaks (as a control
// character after "[" does), just before it finds and reports the error in good order. So neither.
#undef NDEBUG
#define TOML_ASSERT(condition) static_assert(true)
#define TOML_EXCEPTIONS 0
#define TOML_ENABLE_FORMATTERS 0
#include <toml++/toml.h>

#include "driver/display/toml_guard.h"

namespace xorvox::display {
namespace {

/// `text` on one line.
std::string one_line(std::string_view text) {
    std::string line(text);
    std::replace_if(line.begin(), line.end(), is_control, '?');
    return line;
}

/// toml++ limits how deep tables and lists are nested, and so the recursion.
TomlNode copy(const toml::node& from) {
    TomlNode node;
    node.line = from.source().begin.line;
    if (const auto* text = from.as_string()) {
        node.type = TomlNode::Type::Text;
        node.text = text->get();
    } else if (const auto* whole = from.as_integer()) {
        node.type = TomlNode::Type::Whole;
        node.whole = whole->get();
        node.number = static_cast<double>(whole->get());
    } else if (const auto* number = from.as_floating_point()) {
        node.type = TomlNode::Type::Number;
        node.number = number->get();
    } else if (const auto* truth = from.as_boolean()) {
        node.type = TomlNode::Type::Truth;
        node.truth = truth->get();
    } else if (const auto* list = from.as_array()) {
        node.type = TomlNode::Type::List;
        node.items.reserve(list->size());
        for (const toml::node& item : *list) node.items.push_back(copy(item));
    } else if (const auto* table = from.as_table()) {
        node.type = TomlNode::Type::Table;
        for (const auto& [name, item] : *table) {
            node.names.emplace_back(name.str());
            node.items.push_back(copy(item));
        }
    } else {
        node.type = TomlNode::Type::Date;
    }
    return node;
}

}  // namespace

const TomlNode* TomlNode::find(std::string_view key) const {
    const auto name = std::ranges::find(names, key);
    return name == names.end() ? nullptr : &items[static_cast<std::size_t>(name - names.begin())];
}

tl::expected<TomlNode, DisplayMistake> parse_toml(std::string_view toml) {
    if (const auto stray = find_stray(toml)) {
        return tl::unexpected(DisplayMistake{stray->line, fmt::format("not valid here: {}", stray->message)});
    }
    const toml::parse_result result = toml::parse(toml);
    if (!result) {
        return tl::unexpected(
            DisplayMistake{result.error().source().begin.line,
                           fmt::format("not valid TOML: {}", one_line(result.error().description()))});
    }
    return copy(result.table());
}

std::string in_quotes(std::string_view text) {
    constexpr std::size_t most = 40;
    if (text.size() <= most) return fmt::format("\"{}\"", one_line(text));
    std::size_t end = most;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
    return fmt::format("\"{}…\"", one_line(text.substr(0, end)));
}

}  // namespace xorvox::display
