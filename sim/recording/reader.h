// RecordingReader: a recording (.xvr), block by block.
//
//   open ─► display(), frames() ─► next(), next() … ─► Closed
//                        seek() ─────┘
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "driver/display/toml.h"
#include "sim/recording/format.h"
#include "sim/recording/source.h"
#include "voxelizer/error.h"
#include "voxelizer/status.h"

namespace xorvox::sim {

/// What open() does with a recording that is not whole.
enum class Damage : std::uint8_t {
    Refused,  ///< Fails, if head, description, index or end are not right. The blocks between show when they are read.
    Tolerated,  ///< Takes what is whole, and finds the frames by reading all of it.
};

struct Block {
    BlockKind kind{};
    std::uint64_t offset = 0;            ///< In the file, of its header.
    std::uint64_t time_ns = 0;           ///< Since the first packet.
    std::span<const std::byte> payload;  ///< Valid until the next call.
};

/// Never more memory than the file is long, and some 64 KiB. One thread.
class RecordingReader {
public:
    /// Messages name the file and the byte, and say what to do. A newer major version is refused in any case, and so is
    /// what has no block of a recording in it at all.
    static Expected<RecordingReader> open(ByteSource source, Damage damage = Damage::Refused);

    const std::string& name() const { return source_.name; }
    /// What was recorded; null, where damage is tolerated: its description is not whole.
    const DisplayFile* display() const { return display_ ? &*display_ : nullptr; }
    /// Of every whole frame, in the file's order.
    std::span<const FrameEntry> frames() const { return frames_; }
    /// From the first packet to the last.
    std::uint64_t duration_ns() const { return duration_ns_; }
    /// What was wrong at open(), where that is tolerated; empty: nothing.
    const std::string& fault() const { return fault_; }

    /// The next block of any kind, also of ones that are not known. Ok; Closed at the end of the file; Corrupt: here is
    /// damage, damage() says what; going on is right, and what comes next is the next whole block. Said once for each
    /// damaged place.
    Status next(Block& block);
    /// The end of a message about damage: what to do. Empty where damage is tolerated.
    const char* advice() const;
    /// One line, of the last Corrupt.
    const std::string& damage() const { return damage_; }

    /// What next() gives next: the block at `offset`, as a FrameEntry has it.
    void seek(std::uint64_t offset) { at_ = offset; }
    /// The first block after the description.
    void rewind() { at_ = first_block_; }

private:
    RecordingReader(ByteSource source, Damage damage)
        : source_(std::move(source)), damage_is_(damage), end_(source_.size) {}

    Expected<void> read_head();
    Expected<void> read_display();
    Expected<void> read_index();
    Error no_end();
    void rebuild_index();
    bool take_header(std::uint64_t offset, BlockHeader& header);
    Status corrupt(std::uint64_t offset, const std::string& what, std::uint64_t go_on_at);
    std::uint64_t next_header(std::uint64_t from);
    std::string at(std::uint64_t offset, const std::string& what) const;

    ByteSource source_;
    Damage damage_is_;
    std::uint64_t end_;  ///< Behind its last block.
    std::optional<DisplayFile> display_;
    std::vector<FrameEntry> frames_;
    std::uint64_t duration_ns_ = 0;
    std::uint64_t first_block_ = kRecordingHeadBytes;
    std::uint64_t at_ = kRecordingHeadBytes;
    std::vector<std::byte> payload_;
    std::string fault_;
    std::string damage_;
};

/// open_source() and RecordingReader::open().
Expected<RecordingReader> open_recording(const std::string& path, Damage damage = Damage::Refused);

/// The frame to begin with so that everything is there that the recording shows from `time_ns` on: the last keyframe
/// not after the frame that was whole last at that time. Nothing: begin at the beginning.
std::optional<std::size_t> keyframe_before(std::span<const FrameEntry> frames, std::uint64_t time_ns);

}  // namespace xorvox::sim
