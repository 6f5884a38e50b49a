// TOML files from disk.
#pragma once

#include <string>
#include <string_view>

#include "voxelizer/error.h"

namespace xorvox::display {

/// The text of a file of at most 1 MiB. `what` names it in messages: "display file".
Expected<std::string> read_file(const std::string& path, std::string_view what);

}  // namespace xorvox::display
