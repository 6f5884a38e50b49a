// RecordingWriter: packets, as they pass, into a file (.xvr).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "driver/display/toml.h"
#include "sim/recording/format.h"
#include "voxelizer/error.h"

namespace xorvox::sim {

/// The file has its name once commit() has made it whole; before, it is .xorvox-PID-N.tmp in the same folder, deleted
/// with the writer. Of a process that is killed this file stays, and every frame that was whole can be played
/// (RecordingReader with Damage::Tolerated). What it holds follows from the packets and their times alone. One thread.
class RecordingWriter {
public:
    /// The text of the display's file goes into the recording, so that this can be played without any other file.
    /// Messages begin with `path`.
    static Expected<RecordingWriter> create(const std::string& path, const DisplayFile& display);
    RecordingWriter(RecordingWriter&&) noexcept;
    RecordingWriter& operator=(RecordingWriter&&) noexcept;
    ~RecordingWriter();

    /// A packet of 1 … 65536 bytes, whole or damaged; others are left out. `kind` is FromHost or FromDevice. Times
    /// count from the first packet's; one that is before the last is taken as that. A failure to write shows in
    /// commit().
    void packet(BlockKind kind, std::uint64_t time_ns, std::span<const std::byte> bytes);

    /// Frames that were whole so far.
    std::uint64_t frames() const;
    std::uint64_t duration_ns() const;

    /// Writes the index; the file has its name. Nothing may be recorded afterwards.
    Expected<void> commit();

private:
    struct Impl;
    explicit RecordingWriter(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace xorvox::sim
