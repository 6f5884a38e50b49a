// RecordedFrames: the frames of a recording, one after the other, decoded.
#pragma once

#include <cstdint>
#include <string>

#include "driver/display/description.h"
#include "sim/recording/assembler.h"
#include "sim/recording/device_clock.h"
#include "sim/recording/reader.h"

namespace xorvox::sim {

/// One thread.
class RecordedFrames {
public:
    /// Borrows `reader` and reads on from where it is; nobody else moves it meanwhile. `display` is what was recorded.
    RecordedFrames(RecordingReader& reader, const DisplayDescription& display)
        : reader_(&reader), assembler_(frame_bytes(display)) {
        assembler_.missed();
    }

    /// Goes to keyframe_before(frames, time_ns), and makes ready for what it builds on.
    Status seek(std::uint64_t time_ns);

    /// Ok: frame() is the next one that is whole. Closed: there are no more. Corrupt: damage() says what; go on. That
    /// is what the reader calls so, a frame that should be whole here and is not, or is another one than was recorded,
    /// an index that does not name the frames that follow, and a time that is before the one before it. What follows
    /// from damage that was told is not told again.
    Status next();

    const AssembledFrame& frame() const { return assembler_.frame(); }
    /// When it was whole, since the first packet.
    std::uint64_t time_ns() const { return time_ns_; }
    /// When it was to be shown, since the first packet: the moment that it asked for, else when it was whole.
    std::uint64_t shown_ns() const;
    /// The latest time of any packet so far, whatever it carries.
    std::uint64_t latest_ns() const { return latest_ns_; }
    /// Of the last Corrupt.
    const std::string& damage() const { return damage_; }

private:
    std::string fault_of(const Block& entry);
    std::string at(const Block& block, const char* what) const;

    RecordingReader* reader_;
    FrameAssembler assembler_;
    DeviceClock clock_;
    std::uint64_t time_ns_ = 0;
    std::uint64_t block_ns_ = 0;  ///< Of the block before.
    std::uint64_t latest_ns_ = 0;
    std::size_t number_ = 0;      ///< In the index, of the next frame.
    bool index_is_right_ = true;  ///< As far as it was compared.
    bool excused_ = false;        ///< Damage was told, and no frame was whole since.
    std::string next_damage_;     ///< Of what was taken nevertheless.
    std::string damage_;
};

}  // namespace xorvox::sim
