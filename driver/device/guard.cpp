#include "driver/device/guard.h"

#include "driver/wire/messages.h"

namespace xorvox::device {

using wire::Fault;
using wire::fault_bit;

void Guard::init(std::uint64_t late_ns, bool has_interlock) {
    closed_.store(!has_interlock, std::memory_order_relaxed);
    openings_.store(0, std::memory_order_relaxed);
    late_scans_.store(0, std::memory_order_relaxed);
    done_.store(0, std::memory_order_relaxed);
    late_ns_ = late_ns;
    seen_openings_ = 0;
    seen_late_scans_ = 0;
    oldest_ = {};
    last_ = {};
}

void Guard::interlock(bool closed) {
    if (!closed) openings_.store(openings_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
    closed_.store(closed, std::memory_order_release);
}

void Guard::scan_done(const ScanOrder& order, std::uint64_t now_ns) {
    if (now_ns > order.end_ns && now_ns - order.end_ns > late_ns_) {
        late_scans_.store(late_scans_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    }
    done_.store(order.number, std::memory_order_release);
}

void Guard::ordered(const ScanOrder& order) {
    if (late_ns_ == 0 || !order.lit()) return;
    last_ = {order.number, order.end_ns + late_ns_, true};
    if (!oldest_.open) oldest_ = last_;
}

std::uint32_t Guard::faults(std::uint64_t now_ns) {
    std::uint32_t faults = 0;
    const bool closed = closed_.load(std::memory_order_acquire);
    const std::uint32_t openings = openings_.load(std::memory_order_acquire);
    if (!closed || openings != seen_openings_) faults |= fault_bit(Fault::Interlock);
    seen_openings_ = openings;
    if (late_ns_ == 0) return faults;

    const std::uint32_t done = done_.load(std::memory_order_acquire);
    const std::uint32_t late_scans = late_scans_.load(std::memory_order_relaxed);
    const auto is_done = [done](std::uint32_t number) { return static_cast<std::int32_t>(done - number) >= 0; };
    if (last_.open && is_done(last_.number)) last_.open = false;
    if (oldest_.open && is_done(oldest_.number)) oldest_ = last_;
    const bool overdue = oldest_.open && now_ns > oldest_.until_ns;
    if (overdue || late_scans != seen_late_scans_) {
        faults |= fault_bit(Fault::LateScan);
        // What is late is late once: the scanner is dark from here on, and begins anew after the fault is cleared.
        oldest_ = {};
        last_ = {};
    }
    seen_late_scans_ = late_scans;
    return faults;
}

}  // namespace xorvox::device
