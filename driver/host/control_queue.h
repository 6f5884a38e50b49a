// ControlQueue: settings on their way to the device, one at a time, each again until a DeviceStatus shows that it was
// done. Internal to driver/host.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

#include "driver/wire/messages.h"

namespace xorvox::host {

/// Whether the value is in the range of the operation, and the operation is known.
bool is_valid(const wire::Control& control);

class ControlQueue {
public:
    static constexpr std::size_t kMaxWaiting = 64;

    bool empty() const { return waiting_.empty(); }
    bool full() const { return waiting_.size() >= kMaxWaiting; }
    bool has_next() const { return !waiting_.empty() && !in_flight_; }

    void push(const wire::Control& control) { waiting_.push_back({.control = control}); }
    /// Queues the clearing of a silent host's fault, and of no other, where that is among `faults` (wire::fault_bit)
    /// and it does not wait already.
    void heed(std::uint32_t faults);

    /// The control to be sent now; it stays until it is confirmed, refused or given up by watch().
    const wire::Control& send(std::uint64_t now_ns);
    /// The control to be sent now, where nobody will answer.
    wire::Control take();

    void confirmed_by(const wire::DeviceStatus& status);
    /// The device refused a control. True when it can only be the one in flight, which is given up: a refusal names
    /// none, and one that was sent several times may be refused as often.
    bool refused();
    /// Lets an unconfirmed control be sent again. True when it was given up instead, after `attempts`.
    bool watch(std::uint64_t now_ns, std::uint64_t timeout_ns, std::uint32_t attempts);
    /// What was sent may be lost: it is sent again. No refusals from before come any more.
    void begin_again();

private:
    struct Waiting {
        wire::Control control;
        std::uint32_t attempts = 0;
    };

    void let_clear_fault_pass();
    void pop();

    std::deque<Waiting> waiting_;
    bool in_flight_ = false;  ///< The first one.
    std::uint64_t sent_ns_ = 0;
    std::uint32_t late_refusals_ = 0;  ///< That may still come, of controls that do not wait any more.
};

}  // namespace xorvox::host
