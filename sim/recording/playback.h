// Playback: what the host of a recording sent, packet by packet, for a display that is switched on when it begins.
//
//   Playback playback(reader);
//   while (playback.next() == Status::Ok) { poll the display until playback.due_ns(); send it playback.packet(); }
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sim/recording/device_clock.h"
#include "sim/recording/reader.h"
#include "voxelizer/status.h"

namespace xorvox::sim {

/// Packets are as they were recorded, bit for bit, but for the moment at which a frame asks to be presented: that is
/// told in the clock of the recorded display, and becomes the same moment of this one's. One thread.
class Playback {
public:
    /// Borrows `reader` and reads on from where it is; nobody else moves it meanwhile. At speed 2 all times are half as
    /// long.
    explicit Playback(RecordingReader& reader, double speed = 1.0) : reader_(&reader), speed_(speed) {}

    /// Begins with keyframe_before(frames, time_ns), after the request that began its session. Settings that were sent
    /// before it are not sent again. Ok; Corrupt: as next().
    Status seek(std::uint64_t time_ns);

    /// Ok: packet() is the next one of the host. Closed: there are no more. Corrupt: damage() says what; go on.
    Status next();

    /// Borrowed until the next call.
    std::span<const std::byte> packet() const { return packet_; }
    /// On the clock of a display that was switched on at 0.
    std::uint64_t due_ns() const { return due_ns_; }
    /// When packet() was recorded.
    std::uint64_t time_ns() const { return time_ns_; }
    /// The latest moment at which a frame asked to be presented, on that clock.
    std::uint64_t last_present_at_ns() const { return last_present_at_ns_; }
    /// Of the last Corrupt.
    const std::string& damage() const { return reader_->damage(); }

private:
    void take(const Block& block);
    std::uint64_t replayed_ns(std::uint64_t recorded_ns) const;

    RecordingReader* reader_;
    double speed_;
    DeviceClock clock_;
    std::uint64_t begin_ns_ = 0;  ///< Recorded; 0 of this clock.
    bool hello_first_ = false;    ///< packet_ is a request that was sent long before.
    std::vector<std::byte> packet_;
    std::uint64_t due_ns_ = 0;
    std::uint64_t time_ns_ = 0;
    std::uint64_t last_present_at_ns_ = 0;
};

}  // namespace xorvox::sim
