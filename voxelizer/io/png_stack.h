// The names of a stack of pictures: a row of files that are numbered. Private to voxelizer/io.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "voxelizer/error.h"

namespace xorvox::io {

/// "dir/slice007.png" taken apart: what is before the number, and how many digits it has.
struct NumberedName {
    std::string folder;  ///< "." where the path has none.
    std::string before;  ///< "slice".
    std::string digits;  ///< "007"; empty: there is no number.
};

NumberedName numbered_name(const std::string& path);

/// The paths of the pictures in the stack at `path`, by their numbers: of the row that the file belongs to, or of the
/// one row in the folder. Errors: no picture, two rows in a folder, a number that is missing or there twice.
Expected<std::vector<std::string>> stack_paths(const std::string& path);

}  // namespace xorvox::io
