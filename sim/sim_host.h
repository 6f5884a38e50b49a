// SimHost: the least that can call itself a host: it sends pages raw, and keeps the watchdog quiet. For a rig whose
// test is not about hosts; the real one is driver/host/session.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "driver/wire/messages.h"
#include "transport/link.h"

namespace xorvox::sim {

class SimHost {
public:
    /// `link` is borrowed, and carries nothing else. Begins a session.
    SimHost(Link link, std::uint64_t now_ns);

    /// Queues the packets of a keyframe; its id.
    std::uint32_t send_frame(std::span<const std::byte> page, std::uint64_t present_at_ns);
    /// Sends what the link takes, hears the answers out, and says something now and then.
    void poll(std::uint64_t now_ns);

private:
    template <class Message>
    void queue(const Message& message);

    Link link_;
    std::vector<std::byte> buffer_;
    std::deque<std::vector<std::byte>> packets_;
    std::uint32_t sequence_ = 0;
    std::uint32_t frame_ = 0;
    std::uint64_t said_ns_ = 0;
};

}  // namespace xorvox::sim
