// Guard: watches what ScanControl cannot see in the rotation: the interlock, and the scanner.
#pragma once

#include <atomic>
#include <cstdint>

#include "driver/device/scan_order.h"

namespace xorvox::device {

class Guard {
public:
    /// `late_ns`: how long after the end of a slice its scan-out may still be reported; 0: scanners report nothing.
    /// `has_interlock`: the interlock is open until interlock(true); else it is closed until interlock(false).
    void init(std::uint64_t late_ns, bool has_interlock);

    /// One interrupt handler, or thread, calls each of these two; anything may run meanwhile, faults() too.
    void interlock(bool closed);
    /// The scan-out of `order` ended at `now_ns`, whole or cut short.
    void scan_done(const ScanOrder& order, std::uint64_t now_ns);

    /// The scanner was given `order`.
    void ordered(const ScanOrder& order);
    /// fault_bit() of what is wrong at `now_ns`, or was since the last call: Interlock (also one that opened for a
    /// moment), LateScan (a slice was reported too late, or is not reported by then).
    std::uint32_t faults(std::uint64_t now_ns);

private:
    // Counters with one writer each need loads and stores only, which every Cortex-M has; a flag that both sides write
    // would need more.
    std::atomic<bool> closed_{true};
    std::atomic<std::uint32_t> openings_{0};
    std::atomic<std::uint32_t> late_scans_{0};
    std::atomic<std::uint32_t> done_{0};  ///< Number of the order that was reported last.

    std::uint64_t late_ns_ = 0;
    std::uint32_t seen_openings_ = 0;
    std::uint32_t seen_late_scans_ = 0;
    struct Awaited {
        std::uint32_t number = 0;
        std::uint64_t until_ns = 0;
        bool open = false;
    };
    Awaited oldest_;  ///< The first order that was not reported.
    Awaited last_;
};

}  // namespace xorvox::device
