// ByteSource: bytes that can be read at any place: a file, or memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "voxelizer/error.h"

namespace xorvox::sim {

struct ByteSource {
    std::string name;  ///< Messages begin with it.
    std::uint64_t size = 0;
    /// Fills the span with what is at the offset. False: it could not be read; never asked for beyond `size`.
    std::function<bool(std::uint64_t, std::span<std::byte>)> read;
};

/// A regular file, which stays open with the source.
Expected<ByteSource> open_source(const std::string& path);

/// Bytes of its own.
ByteSource memory_source(std::vector<std::byte> bytes, std::string name);

}  // namespace xorvox::sim
