// AtomicFile: a file that appears whole or not at all.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "voxelizer/error.h"
#include "voxelizer/io/descriptor.h"

namespace xorvox::io {

/// Writes to a file without a name in the folder of the final one and gives it its name on commit(). Without a
/// successful commit() nothing is left behind and an older file of the same name is as it was, even when the process is
/// killed: the system frees what has no name.
///
/// Two things need a temporary name in the same folder, .xorvox-PID-N.tmp, which a process that is killed just then
/// leaves behind: replacing an older file, which only a rename does at once (the name is there for that moment of
/// commit()); and file systems without unnamed files (O_TMPFILE), such as NFS and FAT (from create() to commit()).
///
/// Error messages begin with the final path, as printable_name(). One thread at a time; different objects, even for one
/// path, may be used by different threads.
class AtomicFile {
public:
    /// Begins a file. `path` must name a regular file or nothing yet, in a folder that exists and can be written to; a
    /// symbolic link is followed. Directories, devices and pipes, so also /dev/stdout, are refused.
    static Expected<AtomicFile> create(const std::string& path);

    AtomicFile(AtomicFile&& other) noexcept;
    AtomicFile& operator=(AtomicFile&& other) noexcept;
    ~AtomicFile();

    /// Appends `bytes`. After an error, destroy the object.
    Expected<void> write(std::string_view bytes);
    /// Gives the file its name and closes it. Call once, last.
    Expected<void> commit();

private:
    AtomicFile(std::string shown, std::string target, std::string name, Descriptor file);
    Expected<void> take_name();
    void discard() noexcept;

    std::string shown_;   // The path as messages have it.
    std::string target_;  // The path with links followed.
    std::string name_;    // The temporary one; empty when there is none to remove.
    Descriptor file_;
};

/// Writes `bytes` to `path` by an AtomicFile: everything, or an error and nothing.
Expected<void> write_file_atomically(const std::string& path, std::string_view bytes);

}  // namespace xorvox::io
