// EventRing: what interrupts bring, in order, for the loop that looks at it later. One writer, one reader, neither
// waits.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace xorvox::device {

/// An index pulse or mark (steps 0), or so many steps of an encoder.
struct RotationEvent {
    std::uint64_t time_ns = 0;
    std::int32_t steps = 0;
};

class EventRing {
public:
    static constexpr std::uint32_t kSize = 16;

    /// The writer's. False: full, the event is lost.
    bool push(const RotationEvent& event) {
        const std::uint32_t head = head_.load(std::memory_order_relaxed);
        if (head - tail_.load(std::memory_order_acquire) == kSize) return false;
        events_[head % kSize] = event;
        head_.store(head + 1, std::memory_order_release);
        return true;
    }
    /// The reader's: the oldest event, which stays until pop(); null: there is none.
    const RotationEvent* front() const {
        const std::uint32_t tail = tail_.load(std::memory_order_relaxed);
        return head_.load(std::memory_order_acquire) == tail ? nullptr : &events_[tail % kSize];
    }
    void pop() { tail_.store(tail_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }

    /// Neither side may be at work.
    void clear() {
        head_.store(0, std::memory_order_relaxed);
        tail_.store(0, std::memory_order_relaxed);
    }

private:
    static_assert(std::atomic<std::uint32_t>::is_always_lock_free, "interrupts must not wait");

    std::array<RotationEvent, kSize> events_{};
    std::atomic<std::uint32_t> head_{0};
    std::atomic<std::uint32_t> tail_{0};
};

}  // namespace xorvox::device
