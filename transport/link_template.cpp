// A place to start for the next backend: a link over two byte queues, as the driver of a serial port has them.
//
// Copy this file, give it the name of your medium, and replace ByteQueue by what moves your bytes. It is freestanding:
// firmware can use it as it is. tests/contract/transport includes it and runs the contract on it; add your copy there.
// transport/README.md says, operation by operation, what has to hold.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "transport/framing.h"
#include "transport/link.h"

namespace xorvox::transport {

/// Bytes on their way in one direction, in the caller's memory. Between an interrupt handler and the main loop, `used`
/// and `closed` must be atomic, or the handler masked while the link touches them.
struct ByteQueue {
    std::span<std::byte> ring;
    std::size_t begin = 0;
    std::size_t used = 0;
    bool closed = false;  ///< The writer is gone.

    std::size_t room() const { return ring.size() - used; }
    void write(std::span<const std::byte> bytes) {
        for (const std::byte byte : bytes) ring[(begin + used++) % ring.size()] = byte;
    }
    /// The first bytes that lie in one piece.
    std::span<const std::byte> front() const {
        const std::size_t to_end = ring.size() - begin;
        return ring.subspan(begin, used < to_end ? used : to_end);
    }
    void drop(std::size_t count) {
        begin = (begin + count) % ring.size();
        used -= count;
    }
};

/// The link's object; the caller owns it, and it must outlive the link.
struct QueueLink {
    ByteQueue* outgoing = nullptr;
    ByteQueue* incoming = nullptr;
    FrameDecoder decoder;
    std::uint32_t max_packet_bytes = 0;
    bool has_packet = false;  ///< decoder.packet() was not given yet.

    /// `packet` holds the packet that is being received; its size is the longest that the link takes.
    QueueLink(ByteQueue& out, ByteQueue& in, std::span<std::byte> packet)
        : outgoing(&out), incoming(&in), decoder(packet), max_packet_bytes(static_cast<std::uint32_t>(packet.size())) {}
};

namespace {

LinkInfo queue_info(const void* self) {
    return {"template", static_cast<const QueueLink*>(self)->max_packet_bytes, true};
}

Status queue_send(void* self, std::span<const std::byte> packet) {
    QueueLink& link = *static_cast<QueueLink*>(self);
    if (packet.size() > link.max_packet_bytes) return Status::OutOfRange;
    std::byte header[kFrameHeaderBytes];
    if (encode_frame_header(packet.size(), header) != Status::Ok) return Status::OutOfRange;
    // incoming->closed: who writes to us is the one who reads from us.
    if (link.incoming->closed) return Status::Closed;
    // All or nothing: half a frame in the queue could not be taken back.
    if (link.outgoing->room() < packet.size() + kFrameHeaderBytes) return Status::WouldBlock;
    link.outgoing->write(header);
    link.outgoing->write(packet);
    return Status::Ok;
}

Status queue_receive(void* self, std::span<std::byte> buffer, std::size_t& size) {
    QueueLink& link = *static_cast<QueueLink*>(self);
    while (!link.has_packet) {
        const std::span<const std::byte> bytes = link.incoming->front();
        if (bytes.empty()) return link.incoming->closed ? Status::Closed : Status::WouldBlock;
        std::size_t consumed = 0;
        const Status status = link.decoder.feed(bytes, consumed);
        link.incoming->drop(consumed);
        if (status == Status::Corrupt) return status;
        link.has_packet = status == Status::Ok;
    }
    const std::span<const std::byte> packet = link.decoder.packet();
    size = packet.size();
    if (buffer.size() < packet.size()) return Status::OutOfMemory;
    std::memcpy(buffer.data(), packet.data(), packet.size());
    link.has_packet = false;
    return Status::Ok;
}

Status queue_flush(void* self) {
    // What is in the queue is in the peer's reach already. A backend with a transmitter starts it here.
    return static_cast<QueueLink*>(self)->incoming->closed ? Status::Closed : Status::Ok;
}

void queue_close(void* self) {
    static_cast<QueueLink*>(self)->outgoing->closed = true;
}

constexpr LinkOperations kQueueOperations = {
    .info = queue_info,
    .send = queue_send,
    .receive = queue_receive,
    .flush = queue_flush,
    .wait = nullptr,  // Optional: a main loop without an operating system polls.
    .close = queue_close,
};

}  // namespace

Link make_queue_link(QueueLink& link) {
    return {&kQueueOperations, &link};
}

}  // namespace xorvox::transport
