// TomlNode: a parsed display file. What stands between toml++, which toml_tree.cpp alone includes, and the reader.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "driver/display/toml.h"

namespace xorvox::display {

struct TomlNode {
    enum class Type { Text, Whole, Number, Truth, List, Table, Date };
    Type type = Type::Table;
    std::size_t line = 1;  ///< Where it begins, from 1.

    std::string text;                ///< Text.
    std::int64_t whole = 0;          ///< Whole.
    double number = 0.0;             ///< Number, and Whole as well.
    bool truth = false;              ///< Truth.
    std::vector<TomlNode> items;     ///< Of a list or table.
    std::vector<std::string> names;  ///< Of a table: the key of each item.

    /// The value of a table's key; nullptr if there is none, or if this is no table.
    const TomlNode* find(std::string_view key) const;
};

/// The root table of `toml`.
tl::expected<TomlNode, DisplayMistake> parse_toml(std::string_view toml);

/// `text` in quotes for a message: on one line, cut after some 40 bytes.
std::string in_quotes(std::string_view text);

/// Whether `c` is a control character of ASCII.
constexpr bool is_control(char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
}

}  // namespace xorvox::display
