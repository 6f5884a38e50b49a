// FrameAssembler: from the packets of a host to the frames that they carry, by driver/PROTOCOL.md, without a device.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "driver/wire/messages.h"
#include "driver/wire/packet.h"

namespace xorvox::sim {

/// One frame, whole and checked.
struct AssembledFrame {
    std::uint32_t id = 0;
    bool keyframe = false;
    std::uint64_t present_at_ns = 0;   ///< As the host asked; 0: the next boundary.
    std::uint64_t hello = 0;           ///< The `place` of the HelloRequest of its session,
    std::uint64_t begin = 0;           ///< and of its FrameBegin.
    std::span<const std::byte> bytes;  ///< In scan-out order; valid until the next take().
};

/// Takes what a device would, had it always a free page. One thread.
class FrameAssembler {
public:
    /// Of frames so long. Takes twice that of memory. Throws std::bad_alloc.
    explicit FrameAssembler(std::size_t frame_bytes) : base_(frame_bytes), current_(frame_bytes) {}

    /// The next packet of the host; `place` is any number, that frame() gives back. True: it completed a frame.
    /// Packets that are damaged, repeated, of other sessions or of another version do nothing.
    bool take(std::span<const std::byte> packet, std::uint64_t place = 0);

    /// What came before is not known: the session of the next FrameBegin is taken, though its request was not seen. The
    /// `hello` of its frames is then the place of that FrameBegin.
    void missed() { adopts_ = true; }

    /// The frame that take() completed.
    const AssembledFrame& frame() const { return frame_; }

private:
    void begin_session(const wire::Header& header, std::uint64_t place);
    bool take_hello(const wire::Header& header, std::span<const std::byte> payload, std::uint64_t place);
    void take_begin(std::span<const std::byte> payload, std::uint64_t place);
    void take_chunk(std::span<const std::byte> payload);
    bool take_end(std::span<const std::byte> payload);

    std::vector<std::byte> base_;     ///< The frame that was completed last.
    std::vector<std::byte> current_;  ///< The one that is being received.
    AssembledFrame frame_;

    bool adopts_ = false;
    bool in_session_ = false;
    std::uint16_t session_ = 0;
    std::uint32_t sequence_ = 0;
    std::uint64_t hello_time_ns_ = 0;
    std::uint64_t hello_place_ = 0;

    bool has_base_ = false;
    std::uint32_t base_id_ = 0;
    bool receiving_ = false;
    wire::FrameBegin begin_;
    std::uint64_t begin_place_ = 0;
    std::size_t covered_ = 0;
};

}  // namespace xorvox::sim
