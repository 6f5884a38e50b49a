// Receiver: puts one frame together in a free page, chunk by chunk, and accepts it when it is whole.
//
//            begin ok                 end ok: the page is accepted
//     None ────────────► Receiving ────────────────────────────────► Finished: what still comes of this frame
//                           └──── any refusal, drop() ─────────────►           is not looked at
#pragma once

#include <cstdint>

#include "driver/device/pages.h"
#include "driver/wire/messages.h"

namespace xorvox::device {

/// The steps answer why the frame must be dropped, or this.
inline constexpr wire::NackReason kNoRefusal{};

class Receiver {
public:
    /// Starts a frame, giving up the one being received.
    wire::NackReason begin(const wire::FrameBegin& begin, const Pages& pages);
    /// Decodes a chunk into its place; a delta is XORed onto the base right there.
    wire::NackReason chunk(const wire::Chunk& chunk, const Pages& pages);
    /// Checks that the frame is whole and gives its page to `pages`, due at once or when the host asked for it.
    wire::NackReason end(const wire::FrameEnd& end, Pages& pages, std::uint64_t now_ns);

    /// From now on nothing of `frame` is looked at.
    void drop(std::uint32_t frame);
    void reset() { *this = Receiver{}; }

    bool receiving() const { return state_ == State::Receiving; }
    bool finished(std::uint32_t frame) const { return state_ == State::Finished && begin_.frame == frame; }
    std::uint32_t frame() const { return begin_.frame; }

private:
    enum class State : std::uint8_t { None, Receiving, Finished };

    bool is_receiving(std::uint32_t frame) const { return receiving() && begin_.frame == frame; }

    State state_ = State::None;
    wire::FrameBegin begin_;
    std::uint32_t page_ = Pages::kNone;
    std::uint32_t covered_ = 0;  ///< Bytes of the page, from its start.
    std::uint32_t crc_ = 0;      ///< Of the covered bytes.
};

}  // namespace xorvox::device
