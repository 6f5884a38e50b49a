// Names of files: their extension, and how they stand in a message.
#pragma once

#include <string>
#include <string_view>

namespace xorvox::io {

/// From the last dot of the last part of `path`, in lower case: ".ply". Empty when there is no dot.
std::string extension_of(std::string_view path);

/// extension_of(), but for names such as scan.nii.gz both extensions: ".nii.gz".
std::string volume_extension_of(std::string_view path);

/// `name` for a message of one line: control characters (below space, delete, and U+0080 to U+009F in UTF-8) as \xNN,
/// everything else as it is. All errors of voxelizer/io that begin with a path begin with this.
std::string printable_name(std::string_view name);

}  // namespace xorvox::io
