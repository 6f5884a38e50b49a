// gzip in memory. Private to voxelizer/io.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "voxelizer/error.h"

namespace xorvox::io {

/// Whether so many bytes can come from `packed`, by the best that deflate can do: 1032 bytes for one.
bool can_inflate_to(std::string_view packed, std::size_t bytes);

/// The first bytes that the gzip file `packed` holds: all that there are, but no more than `most`. `first_byte` is
/// where `packed` begins in its file, for messages. What follows the last gzip member is not looked at.
Expected<std::string> inflate_gzip(std::string_view packed, std::size_t most, std::string_view source,
                                   std::size_t first_byte = 0);

/// The same, of exactly `bytes` bytes; an error says how many there are instead.
Expected<std::string> inflate_gzip_exactly(std::string_view packed, std::size_t bytes, std::string_view source,
                                           std::size_t first_byte = 0);

}  // namespace xorvox::io
