// Loopback: two ends of a link in one process, each usable from a thread of its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

#include "transport/link.h"

namespace xorvox::transport {

struct LoopbackOptions {
    std::uint32_t max_packet_bytes = 65536;
    /// What one direction holds before send() answers WouldBlock: packets with 4 bytes each. Raised to one longest
    /// packet.
    std::size_t queue_bytes = 256 * 1024;
};

/// Makes both ends. They share one object, which goes when both are closed; either may be closed first.
std::pair<UniqueLink, UniqueLink> make_loopback(const LoopbackOptions& options = {});

}  // namespace xorvox::transport
