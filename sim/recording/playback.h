// Playback: what the host of a recording sent, packet by packet, for a display that is switched on when it begins.
//
//   Playback playback(reader);
//   while (playback.next() == Status::Ok) { poll the display until playback.due_ns(); send it playback.packet(); }
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "driver/wire/packet.h"
#include "sim/recording/device_clock.h"
#include "sim/recording/reader.h"
#include "voxelizer/status.h"

namespace xorvox::sim {

/// Packets are as they were recorded, bit for bit, but for the moment at which a frame asks to be presented: that is
/// told in the clock of the recorded display, and becomes the same moment of this one's. Where the request that began a
/// session is damaged, one is made. One thread.
class Playback {
public:
    /// Borrows `reader` and reads on from where it is; nobody else moves it meanwhile. At speed 2 all times are half as
    /// long.
    explicit Playback(RecordingReader& reader, double speed = 1.0) : reader_(&reader), speed_(speed) {}

    /// Begins with keyframe_before(frames, time_ns), after the request that began its session. Settings that were sent
    /// before it are not sent again. Ok; Corrupt: damage() says what, and next() begins all the same.
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
    const std::string& damage() const { return damage_; }

    /// Puts into `packet` a Ping of the session that was played last, for a host that stays. False: there is none.
    bool make_ping(std::uint64_t now_ns, std::span<std::byte> packet, std::size_t& size);

private:
    Status note_damage();
    void take(const Block& block);
    void translate(const wire::Header& header, std::span<const std::byte> payload);
    std::uint64_t replayed_ns(std::uint64_t recorded_ns) const;

    RecordingReader* reader_;
    double speed_;
    DeviceClock clock_;
    std::uint64_t begin_ns_ = 0;  ///< Recorded; 0 of this clock.
    bool request_first_ = false;  ///< packet_ is a request that was sent long before.
    bool again_ = false;          ///< next_ follows packet_, a request that was made.
    std::vector<std::byte> next_;
    std::optional<std::uint16_t> session_;
    std::uint32_t sequence_ = 0;  ///< Of the last packet of that session.
    bool missed_ = true;          ///< A request may have been missed.
    std::string damage_;
    std::vector<std::byte> packet_;
    std::uint64_t due_ns_ = 0;
    std::uint64_t time_ns_ = 0;
    std::uint64_t last_present_at_ns_ = 0;
};

}  // namespace xorvox::sim
