// FrameClient: one program that draws, as the server of shared frames (driver/host/frame_share.h) sees it: its end of
// the socket, and its segment. The protocol: driver/host/shared_frames.h. Linux.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "driver/display/description.h"
#include "driver/host/descriptor.h"
#include "driver/host/frame_segment.h"
#include "driver/host/framebuffer.h"
#include "driver/host/page_exchange.h"
#include "driver/host/shared_frames.h"

namespace xorvox::host {

/// What came of the programs that drew.
struct ShareStatistics {
    std::uint64_t clients = 0;      ///< That were let in.
    std::uint64_t by_message = 0;   ///< Frames taken.
    std::uint64_t by_exchange = 0;  ///< Frames taken; those between that were not looked at are not counted.
    /// Clients and frames that were refused, by xorvox_frames_status.
    std::array<std::uint64_t, XORVOX_FRAMES_STATUSES> refused{};

    std::uint64_t frames() const { return by_message + by_exchange; }
};

/// What a frame must be: the server's own knowledge of its display, which nothing in a segment changes.
struct FrameTerms {
    std::uint64_t frame_bytes = 0;
    std::uint64_t geometry_digest = 0;
    std::uint32_t pixel_format = 0;

    explicit FrameTerms(const DisplayDescription& display);
};

/// Whether `message` publishes a page that can be taken. Ok, and `request` is the message; or any of
/// XORVOX_FRAMES_WRONG_*, and `request` is the message if it was understood, else as it was.
xorvox_frames_status check_request(std::span<const std::byte> message, const FrameTerms& terms,
                                   xorvox_frames_request& request);

/// The first message on a connection, sent on `socket`, with the descriptor of `segment` where `status` is Ok; null
/// otherwise. Whether it was sent.
bool send_hello(int socket, const FrameTerms& terms, xorvox_frames_status status, const FrameSegment* segment);

/// One thread at a time. Nothing waits or allocates.
class FrameClient {
public:
    /// `socket` is connected, of type SOCK_SEQPACKET. Borrows `frames`, whose writer it is while poll() runs, and
    /// `statistics`. All of them are of the same display.
    FrameClient(Descriptor socket, FrameSegment segment, const FrameTerms& terms, Framebuffer& frames,
                ShareStatistics& statistics);

    /// Takes the frames that were published and replies to messages, at most kMessagesAtOnce; of a client that is gone
    /// all of them. False: the connection has come to its end, by the client's doing or because it does not keep to the
    /// protocol.
    bool poll();

    int socket() const { return socket_.get(); }
    FrameSegment& segment() { return segment_; }

private:
    static constexpr int kMessagesAtOnce = 64;

    /// Whether its client is heard further.
    bool answer(std::span<const std::byte> message);
    void take_latest();
    void take(std::uint32_t page, std::uint64_t tag);

    Descriptor socket_;
    FrameSegment segment_;
    FrameTerms terms_;
    Framebuffer& frames_;
    ShareStatistics& statistics_;
    PageReader<> reader_;
    std::uint32_t seen_ = kNoPage;  ///< What the reader has.
    bool gone_ = false;             ///< Nobody reads replies any more.
};

}  // namespace xorvox::host
