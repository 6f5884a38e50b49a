// SideFiles: the files that a model file names: buffers, images, materials, voxels. Private to voxelizer/io.
#pragma once

#include <string>
#include <string_view>

#include "voxelizer/error.h"
#include "voxelizer/io/read_file.h"

namespace xorvox::io {

/// Reads only what is in the folder of the model file or below it: a model that a stranger made must not choose which
/// files of this machine are opened.
class SideFiles {
public:
    /// There are none: every read() is refused.
    SideFiles() = default;
    explicit SideFiles(const std::string& model_path);

    /// The bytes of the file called `mention` in `source`, the model file. Refused with an error that begins with
    /// `source`: absolute names, names with "..", URLs, what is no regular file, what is longer than `kind` allows.
    Expected<std::string> read(std::string_view mention, std::string_view source, const FileKind& kind) const;

    /// The same, for formats whose files have paths of the machine on which they were made: when `mention` is refused
    /// or missing, its last part is looked for beside the model.
    Expected<std::string> read_by_name(std::string_view mention, std::string_view source, const FileKind& kind) const;

private:
    bool any_ = false;
    std::string folder_;  // Empty, or ends with a slash.
};

/// `uri` with %20 and the like replaced by the bytes that they stand for; what is malformed stays.
std::string percent_decoded(std::string_view uri);

}  // namespace xorvox::io
