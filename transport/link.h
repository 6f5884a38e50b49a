// Link: moves packets between the host half and the device half. The contract, operation by operation.
//
// A link carries whole packets of 1 … LinkInfo::max_packet_bytes bytes, in both directions, in order. It may cut them
// in pieces on the way (transport/framing.h does for byte streams); the other end gets them whole or not at all. A link
// does not look into packets, and does not promise that every one arrives: the wire protocol notices what is missing.
//
// A backend is a LinkOperations table and an object; Link is the borrowed pair. Operations marked optional may be null:
// the functions of Link then answer Status::Unsupported. Freestanding: a microcontroller implements the same table.
// transport/README.md is the guide for writing a backend, transport/link_template.cpp a place to start.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "voxelizer/status.h"

namespace xorvox {

/// What a link is; constant while it is open.
struct LinkInfo {
    const char* name = "";               ///< "loopback", "tcp", "file", …; static storage.
    std::uint32_t max_packet_bytes = 0;  ///< The longest packet that send() takes.
    bool two_way = true;                 ///< False: nothing will ever be received (a file).
};

/// What Link::wait() waits for; may be combined.
enum LinkEvents : std::uint32_t { kLinkReadable = 1, kLinkWritable = 2 };

/// The operations of a backend. `self` is the object that Link::self points to. None may throw; unless noted, none may
/// block. One thread at a time may call them for one object; the two ends of a link may live in different threads.
struct LinkOperations {
    /// Called any time. May answer the same forever.
    LinkInfo (*info)(const void* self);

    /// Takes one packet, copying it before return. Ok: the packet will be delivered, in order, unless the link breaks.
    /// WouldBlock: no room; nothing was taken, try again after wait() or later. Closed: the peer is gone.
    /// OutOfRange: longer than max_packet_bytes, or empty. This is the back-pressure of bytes.
    Status (*send)(void* self, std::span<const std::byte> packet);

    /// Gives the next whole packet that has arrived: copies it to the start of `buffer` and sets `size`. WouldBlock:
    /// none is there. OutOfMemory: `buffer` is too small; `size` says what is needed and the packet stays. Closed: the
    /// peer is gone and all that it sent was given. Corrupt: bytes were lost or damaged here; going on to receive is
    /// right.
    Status (*receive)(void* self, std::span<std::byte> buffer, std::size_t& size);

    /// Optional. Moves bytes that send() took but the peer has not been given yet. Ok: none are left. WouldBlock: some
    /// are. Closed: the peer is gone. send() and receive() do this on their own as far as they can without waiting.
    Status (*flush)(void* self);

    /// Optional; the only operation that may block: until one of `events` (LinkEvents) is likely to succeed, the link
    /// is closed by the peer, or `timeout_ns` has passed. Ok or Timeout; Closed only when no operation can succeed any
    /// more.
    Status (*wait)(void* self, std::uint32_t events, std::int64_t timeout_ns);

    /// Ends the link and frees the object. Packets that send() took are pushed out as far as that goes without waiting;
    /// call flush() and wait() before if they matter. Nothing may be called afterwards.
    void (*close)(void* self);
};

/// A borrowed link; copy it freely. The functions mean what LinkOperations says.
struct Link {
    const LinkOperations* operations = nullptr;
    void* self = nullptr;

    explicit operator bool() const { return operations != nullptr; }
    LinkInfo info() const { return operations->info(self); }
    Status send(std::span<const std::byte> packet) const { return operations->send(self, packet); }
    Status receive(std::span<std::byte> buffer, std::size_t& size) const {
        return operations->receive(self, buffer, size);
    }
    Status flush() const { return operations->flush ? operations->flush(self) : Status::Unsupported; }
    Status wait(std::uint32_t events, std::int64_t timeout_ns) const {
        return operations->wait ? operations->wait(self, events, timeout_ns) : Status::Unsupported;
    }
};

/// Owns a link and closes it; movable. Freestanding (the backend's close() knows how its object is freed).
class UniqueLink {
public:
    UniqueLink() = default;
    explicit UniqueLink(Link link) : link_(link) {}
    UniqueLink(UniqueLink&& other) noexcept : link_(other.link_) { other.link_ = {}; }
    UniqueLink& operator=(UniqueLink&& other) noexcept {
        if (this != &other) {
            reset();
            link_ = other.link_;
            other.link_ = {};
        }
        return *this;
    }
    UniqueLink(const UniqueLink&) = delete;
    UniqueLink& operator=(const UniqueLink&) = delete;
    ~UniqueLink() { reset(); }

    void reset() {
        if (link_) link_.operations->close(link_.self);
        link_ = {};
    }
    Link get() const { return link_; }
    const Link* operator->() const { return &link_; }
    explicit operator bool() const { return static_cast<bool>(link_); }

private:
    Link link_;
};

}  // namespace xorvox
