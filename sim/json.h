// JSON: text in quotes.
#pragma once

#include <string>
#include <string_view>

namespace xorvox::sim {

/// `text` as a JSON string, with its quotes.
std::string json_quoted(std::string_view text);

}  // namespace xorvox::sim
