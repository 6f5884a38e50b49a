// Whole files in memory. Private to voxelizer/io.
#pragma once

#include <cstdint>
#include <string>

#include "voxelizer/error.h"

namespace xorvox::io {

/// All bytes of the regular file or pipe at `path`; an error when they are none or more than `most`. Messages call the
/// file `name`, and what it should be `what`, as in "a volume".
Expected<std::string> read_file_bytes(const std::string& path, const std::string& name, std::uint64_t most,
                                      const std::string& what);

}  // namespace xorvox::io
