// How much memory there is: a small file may ask for more. Private to voxelizer/io and the tools.
#pragma once

#include <cstdint>
#include <string_view>

#include "voxelizer/error.h"

namespace xorvox::io {

/// Bytes that this process can still get without swapping; all of them where the system does not say.
std::uint64_t available_bytes();

/// An error when the voxels of `source` need more than available_bytes(): asking for so much may succeed, and end the
/// process later.
Expected<void> check_memory(std::uint64_t bytes, std::string_view source);

}  // namespace xorvox::io
