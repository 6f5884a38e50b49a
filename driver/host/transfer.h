// Transfer: the frame on its way to the device, through all its attempts, and what was accepted before it. It knows
// neither link nor clock; the session does. Internal to driver/host.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "driver/host/encoder.h"
#include "driver/host/session.h"
#include "driver/wire/messages.h"

namespace xorvox::host {

class Transfer {
public:
    enum class Phase : std::uint8_t { None, Queued, Sending, Waiting };

    /// Counts what happens to frames in `statistics`, which is borrowed.
    explicit Transfer(SessionStatistics& statistics);

    Phase phase() const { return phase_; }
    bool began() const { return phase_ == Phase::Sending || phase_ == Phase::Waiting; }
    std::uint32_t failed_attempts() const { return failed_attempts_; }
    const char* refusal_text() const;  ///< Why the last attempt failed.
    std::uint32_t last_accepted() const { return last_accepted_; }
    std::uint32_t last_presented() const { return last_presented_; }

    /// Another session with the device: no delta can be based on what it had, and of the frames that it accepted it
    /// keeps the last one at most. With `other_clock` it is not the device that it was, or was reset: times of the
    /// clock before mean nothing any more.
    void begin_with(const EncoderLimits& limits, bool other_clock);

    /// None to Queued: a copy of `content` is to be sent.
    void submit(std::span<const std::byte> content, std::uint64_t present_at_ns);
    /// Queued to Sending, under a new id; as a delta where `delta` allows it and there is a base.
    void encode(bool delta);
    /// Whether the attempt that is running is one.
    bool is_delta() const { return encoder_.is_delta(); }
    /// Sending: the next payload.
    Payload next_payload() { return encoder_.payload(next_payload_++); }
    bool all_given() const { return phase_ == Phase::Sending && next_payload_ == encoder_.payload_count(); }
    /// Sending to Waiting; where nobody will answer, to None.
    void sent(bool two_way) { phase_ = two_way ? Phase::Waiting : Phase::None; }
    /// Back to Queued: the next attempt is a keyframe.
    void again(wire::NackReason reason);

    /// True when the message accepts the frame on its way, which is done then.
    bool accept(const wire::Acknowledge& message);
    /// True when it refuses the attempt that is running.
    bool is_refused_by(const wire::Nack& message) const { return began() && message.frame == id_; }
    /// `frame`, whose page has this CRC, is being shown: an id alone may be of another session. True when that is news
    /// of an accepted frame; those that were due before it will never be shown. Counted once for each accepted frame.
    /// `device_time_ns`: since when, 0 where nobody said.
    bool presented(std::uint32_t frame, std::uint32_t page_crc, std::uint64_t device_time_ns);
    /// The oldest fate that was not asked for yet; false when there is none.
    bool next_fate(FrameFate& fate);
    /// Whether an accepted frame is not known to be shown.
    bool awaits_presentation() const { return !unpresented_.empty(); }
    /// Whether one of these is due at this time of the device's clock.
    bool awaits_presentation_at(std::uint64_t device_time_ns) const;

private:
    /// A frame that was accepted, under one of its ids. The device may have accepted, and show, it under each of them.
    struct Unpresented {
        std::uint64_t number;
        std::uint32_t first_id;
        std::uint32_t last_id;
        std::uint32_t accepted_id;
        std::uint32_t page_crc;
        std::uint64_t due_ns;  ///< Device clock.

        bool is_due_before(const Unpresented& other) const;
    };

    bool is_an_attempt(std::uint32_t frame) const;
    void note(const FrameFate& fate);
    template <class Condition>
    void give_up(Condition condition);

    SessionStatistics* statistics_;
    FrameEncoder encoder_;
    Phase phase_ = Phase::None;
    std::vector<std::byte> content_;
    std::uint64_t number_ = 0;
    std::uint64_t present_at_ns_ = 0;
    std::uint32_t id_ = 0;        ///< Of the last attempt.
    std::uint32_t first_id_ = 0;  ///< Of the first attempt with the same content.
    std::uint32_t failed_attempts_ = 0;
    std::size_t next_payload_ = 0;
    wire::NackReason refusal_{};  ///< 0: it was silence.

    std::vector<std::byte> base_;  ///< Content of the frame accepted last.
    std::uint32_t base_id_ = 0;
    bool has_base_ = false;
    std::uint32_t last_accepted_ = 0;
    std::uint32_t last_presented_ = 0;
    std::vector<Unpresented> unpresented_;  ///< In the order of acceptance.
    std::vector<FrameFate> fates_;          ///< The oldest first.
};

}  // namespace xorvox::host
