// NewFile: a file that is written from its beginning to its end and has its name once it is complete.
#pragma once

#include <cstddef>
#include <cstdio>
#include <memory>
#include <span>
#include <string>

#include "voxelizer/error.h"

namespace xorvox::transport {

/// Writes to a temporary file of its own (.xorvox-PID-N.tmp) in the folder of its path, which gets its name in
/// commit(). Without that it is deleted with the object, and an older file of the name is as it was. A process that is
/// killed leaves the temporary file with what was flushed. Of several for one path, the last that is committed stays.
/// One thread.
class NewFile {
public:
    /// A symbolic link is followed; directories, devices and pipes are refused. Messages begin with `path`.
    static Expected<NewFile> create(const std::string& path);

    NewFile(NewFile&& other) noexcept;
    NewFile& operator=(NewFile&&) = delete;
    ~NewFile();

    /// Appends. After a first failure nothing more is written, and commit() says what it was.
    void write(std::span<const std::byte> bytes);
    /// What was written so far outlives the process.
    void flush();
    bool failed() const { return error_ != 0; }
    /// No: commit() was called.
    bool is_open() const { return file_ != nullptr; }

    /// Everything is on the disk and has its name; once more does nothing.
    Expected<void> commit();

private:
    struct CloseFile {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    using File = std::unique_ptr<std::FILE, CloseFile>;
    NewFile(File file, std::string path, std::string target, std::string temporary);

    File file_;
    std::string path_;       ///< As messages have it.
    std::string target_;     ///< With links followed.
    std::string temporary_;  ///< Empty: moved from.
    int error_ = 0;
    bool committed_ = false;
};

}  // namespace xorvox::transport
