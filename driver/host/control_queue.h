// ControlQueue: settings on their way to the device, one at a time, each again until a DeviceStatus shows that it was
// done. Internal to driver/host.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

#include "driver/wire/messages.h"

namespace xorvox::host {

class ControlQueue {
public:
    static constexpr std::size_t kMaxWaiting = 64;

    bool empty() const { return waiting_.empty(); }
    bool full() const { return waiting_.size() >= kMaxWaiting; }
    bool has_next() const { return !waiting_.empty() && !in_flight_; }

    void push(const wire::Control& control);
    /// Queues a ClearFault unless one waits already.
    void push_clear_fault();

    /// The control to be sent now; it stays until it is confirmed(), or refused(), or given up by watch().
    const wire::Control& send(std::uint64_t now_ns);
    /// The control to be sent now, where nobody will answer.
    wire::Control take();

    void confirmed_by(const wire::DeviceStatus& status);
    /// True when a control was in flight, which is given up.
    bool refused();
    /// Lets an unconfirmed control be sent again. True when it was given up instead, after `attempts`.
    bool watch(std::uint64_t now_ns, std::uint64_t timeout_ns, std::uint32_t attempts);
    /// What was sent may be lost: it is sent again.
    void begin_again() { in_flight_ = false; }

private:
    void pop();

    std::deque<wire::Control> waiting_;
    bool in_flight_ = false;  ///< The first one.
    std::uint32_t attempts_ = 0;
    std::uint64_t sent_ns_ = 0;
};

}  // namespace xorvox::host
