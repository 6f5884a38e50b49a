// What a JSON text may cost before it is parsed. Private to voxelizer/io.
#pragma once

#include <cstddef>
#include <string_view>

#include "voxelizer/error.h"

namespace xorvox::io {

/// A JSON tree takes many times the memory of its text, and its parser a frame of the stack for each level.
inline constexpr std::size_t kMostJsonDepth = 64;
inline constexpr std::size_t kMostJsonValues = std::size_t{1} << 22;
inline constexpr std::size_t kMostJsonObjects = std::size_t{1} << 20;

struct JsonCounts {
    std::size_t values = 0;   ///< At most: the commas and the brackets that open.
    std::size_t objects = 0;  ///< Opened by a brace.
    std::size_t depth = 0;
    /// Objects right in the arrays that stand under the key asked for at the top; and in those under keys with a
    /// backslash, which may mean the same.
    std::size_t objects_under_key = 0;
};

/// Counts without understanding: whatever `text` is, a parser makes no more of it.
JsonCounts count_json(std::string_view text, std::string_view key);

/// An error when `counts` are beyond the limits.
Expected<void> check_json(const JsonCounts& counts, std::string_view source);

}  // namespace xorvox::io
