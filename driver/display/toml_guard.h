// A look at a display file before toml++ sees it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace xorvox::display {

/// Something that TOML forbids, or that a display file has no use for.
struct Stray {
    std::size_t line;     ///< From 1.
    std::string message;  ///< What was found.
};

/// toml++ 3.3 runs into undefined behaviour on letters such as "ä" where it looks for white space. They are valid only
/// in comments and texts, so this finds the first one elsewhere; and the first text of several lines, in which toml++
/// looks for white space as well.
std::optional<Stray> find_stray(std::string_view toml);

}  // namespace xorvox::display
