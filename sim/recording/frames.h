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
        : reader_(&reader), assembler_(frame_bytes(display)) {}

    /// Goes to keyframe_before(frames, time_ns), and makes ready for what it builds on.
    Status seek(std::uint64_t time_ns);

    /// Ok: frame() is the next one that is whole. Closed: there are no more. Corrupt: damage() says what; go on.
    Status next();

    const AssembledFrame& frame() const { return assembler_.frame(); }
    /// When it was whole, since the first packet.
    std::uint64_t time_ns() const { return time_ns_; }
    /// When it was to be shown, since the first packet: the moment that it asked for, else when it was whole.
    std::uint64_t shown_ns() const;
    /// Of the last Corrupt.
    const std::string& damage() const { return damage_; }
    /// See FrameAssembler.
    std::uint64_t broken() const { return assembler_.broken(); }

private:
    RecordingReader* reader_;
    FrameAssembler assembler_;
    DeviceClock clock_;
    std::uint64_t time_ns_ = 0;
    std::string damage_;
};

}  // namespace xorvox::sim
