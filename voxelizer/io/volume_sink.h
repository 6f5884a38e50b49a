// Where the bytes of a volume go: a file, packed or not, or a row of pictures. Private to voxelizer/io.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "voxelizer/error.h"

namespace xorvox::io {

class VolumeSink {
public:
    virtual ~VolumeSink() = default;
    /// Appends `bytes`; to a row of pictures, a whole picture. After an error, destroy the object.
    virtual Expected<void> write(std::string_view bytes) = 0;
    /// Appends `bytes` as they are, before any write(): the header of a file whose data alone are packed.
    virtual Expected<void> write_plain(std::string_view bytes) { return write(bytes); }
    /// Lets the file, or the pictures, appear. Call once, last; without it nothing is left behind.
    virtual Expected<void> commit() = 0;
};

/// The file `path`, by an AtomicFile; `gzip`: what write() gets is packed.
Expected<std::unique_ptr<VolumeSink>> file_sink(const std::string& path, bool gzip);

/// Pictures named after `path`: out/slice.png becomes out/slice000.png and so on, with as many digits as `count`
/// pictures need, three at least. They are written to a folder of their own beside, .xorvox-XXXXXX, and get their names
/// one after the other at the end. Pictures of the same names are replaced; others of the row, which would then be
/// taken for more of this stack, are an error.
Expected<std::unique_ptr<VolumeSink>> picture_sink(const std::string& path, std::size_t count);

}  // namespace xorvox::io
