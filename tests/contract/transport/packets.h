// Packets that say which one they are, for the contract suite.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "transport/link.h"

namespace xorvox::transport {

/// Packet `number` of `size` bytes: bytes that depend on both.
inline std::vector<std::byte> make_packet(std::uint32_t number, std::size_t size) {
    std::vector<std::byte> packet(size);
    std::uint32_t state = number * 2654435761u + 1;
    for (std::byte& byte : packet) {
        state = state * 1664525u + 1013904223u;
        byte = static_cast<std::byte>(state >> 24);
    }
    return packet;
}

/// Receives one packet into `packet`; waits for it where the link can. The status of the last receive().
inline Status receive_packet(Link link, std::vector<std::byte>& packet) {
    packet.resize(link.info().max_packet_bytes);
    for (;;) {
        std::size_t size = 0;
        const Status status = link.receive(packet, size);
        if (status == Status::Ok) packet.resize(size);
        if (status != Status::WouldBlock) return status;
        if (link.wait(kLinkReadable, 10'000'000'000) != Status::Ok) return status;
    }
}

}  // namespace xorvox::transport
