// read_file: a whole file in memory, for the readers of this folder. Private to voxelizer/io.
#pragma once

#include <cstdint>
#include <string>

#include "voxelizer/error.h"

namespace xorvox::io {

/// What a reader takes, and what its messages call it.
struct FileKind {
    const char* noun;          ///< "a mesh file", "an image file".
    std::uint64_t most_bytes;  ///< A longer one is refused.
    const char* shorten;       ///< What to do with a longer one: "split or simplify the mesh".
};

/// The bytes of the regular file or pipe at `path`, read once from its beginning to its end; an
/// error when there are none. Errors begin with `name`.
/// Throws std::bad_alloc.
Expected<std::string> read_file(const std::string& path, const std::string& name, const FileKind& kind);

}  // namespace xorvox::io
