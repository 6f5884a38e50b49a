// AtomicFile: a file that appears whole or not at all.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "voxelizer/error.h"

namespace xorvox::io {

/// Writes to a temporary file in the folder of the final one (.xorvox-PID-N.tmp) and renames it over the final name on
/// commit(). Destroyed without a successful commit(), it removes what it wrote: a failure leaves nothing behind and an
/// older file of the same name as it was. (A process that is killed leaves the temporary file.) Error messages begin
/// with the final path. One thread at a time; different objects, even for one path, may be used by different threads.
class AtomicFile {
public:
    /// Creates the temporary file. `path` must name a regular file or nothing yet, in a folder that exists and can be
    /// written to; a symbolic link is followed. Directories, devices and pipes, so also /dev/stdout, are refused.
    static Expected<AtomicFile> create(const std::string& path);

    AtomicFile(AtomicFile&& other) noexcept;
    AtomicFile& operator=(AtomicFile&& other) noexcept;
    ~AtomicFile();

    /// Appends `bytes`. After an error, destroy the object.
    Expected<void> write(std::string_view bytes);
    /// Closes the file and gives it its name. Call once, last.
    Expected<void> commit();

private:
    AtomicFile(std::string path, std::string target, std::string temporary, int descriptor);
    void discard() noexcept;

    std::string path_;       // As the caller wrote it: for messages.
    std::string target_;     // The same with links followed.
    std::string temporary_;  // Empty when there is nothing to remove.
    int descriptor_ = -1;
};

/// Writes `bytes` to `path` by an AtomicFile: everything, or an error and nothing.
Expected<void> write_file_atomically(const std::string& path, std::string_view bytes);

}  // namespace xorvox::io
