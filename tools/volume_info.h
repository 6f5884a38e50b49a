// What a volume file holds, for `xorvox info`.
#pragma once

#include <string>

#include "tools/commands.h"
#include "voxelizer/error.h"

namespace xorvox::tools {

/// Reads the volume at `path` and prints what it is, as text or as one JSON object.
Expected<void> volume_info(const std::string& path, const VolumeOptions& options, bool json);

}  // namespace xorvox::tools
