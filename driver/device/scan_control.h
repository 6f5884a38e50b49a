// ScanControl: tells the scanner what to light now. It follows the rotation, presents pages at the beginning of a
// cycle, finds the slice, limits its current, and orders dark when anything is wrong, whoever is at the other end of
// the wire.
//
//   index_pulse() encoder() interlock() scan_done()          interrupts
//        └────────────┴──────┬───┴──────────┘
//                            ▼ queued
//   loop:  device.poll(now) ─► pages        poll(now) ─► ScanOrder: show a slice until …, or be dark, and why
//
//   device.init(…); control.init(scan_control_config(kDisplay, …), device, now);
//   for (;;) {
//       const std::uint64_t now = clock();
//       (void)device.poll(now);
//       const ScanOrder& order = control.poll(now);
//       if (order.number != shown) scanner.begin(order), shown = order.number;
//   }
//
// A fault latches in the Device, blanks, is told to the host, and ends only with the host's ClearFault; a cause that
// goes on raises it again. It needs no host and no link for any of it. What the device half cannot guard against is in
// docs/safety.md: it is no substitute for guards that are screwed on.
//
// Interrupts. index_pulse() and encoder() may be called at any time, also in the middle of poll(), by one interrupt
// handler, or by several that do not interrupt each other. The same holds, each by itself, for interlock() and for
// scan_done(). They only store: 32-bit atomics, loads and stores. Everything else is for the one thread, loop or
// handler that calls poll(); it shares the Device with Device::poll() as Device::boundary() does
// (driver/device/device.h: not one in the middle of the other). No heap, no floating point at run time, no clock of its
// own.
#pragma once

#include <cstdint>

#include "driver/device/current.h"
#include "driver/device/device.h"
#include "driver/device/event_ring.h"
#include "driver/device/guard.h"
#include "driver/device/rotation.h"
#include "driver/device/scan_order.h"
#include "driver/device/schedule.h"
#include "voxelizer/status.h"

namespace xorvox::device {

/// driver/device/config.h computes it from a description, in firmware when it is compiled.
struct ScanControlConfig {
    RotationConfig rotation;
    SliceSchedule schedule;
    CurrentConfig current;
    std::uint32_t slice_bytes = 0;  ///< Of the schedule's slices; times their number, no more than a page.
    std::uint64_t late_ns = 0;      ///< How late scan_done() may come after end_ns; 0: it is not called.
    bool has_interlock = false;     ///< There is one: it is open until interlock(true).
};

class ScanControl {
public:
    ScanControl() = default;
    ScanControl(const ScanControl&) = delete;
    ScanControl& operator=(const ScanControl&) = delete;

    /// Ok, or InvalidArgument: a value out of its range. `device` is borrowed for good, and was initialized. Call it
    /// before any interrupt is let in; may be called anew. Without index, cycle 0 begins now.
    Status init(const ScanControlConfig& config, Device& device, std::uint64_t now_ns);

    /// An index pulse, or the encoder's mark, came at `now_ns`, the time of its edge. Interrupt-safe. At most
    /// EventRing::kSize events are kept from poll() to poll(); what is beyond is lost, like a pulse that was missed.
    void index_pulse(std::uint64_t now_ns);
    /// The encoder went on by `steps` since the last call; backwards: negative. Interrupt-safe. At the mark, report the
    /// steps before it first. Sixteen times a turn is often enough.
    void encoder(std::uint64_t now_ns, std::int32_t steps);
    /// The interlock closed or opened. Interrupt-safe. An opening however short is a fault.
    void interlock(bool closed);
    /// The scanner has finished with `order`, which poll() gave as lit, or was cut short by another. Interrupt-safe.
    void scan_done(const ScanOrder& order, std::uint64_t now_ns);

    /// What the scanner has to do at `now_ns`. Call it when the last order's end_ns has come, at least every
    /// millisecond where faults matter, and after Device::poll() had something to do. Calls Device::boundary() for each
    /// cycle that began since, the last kMaxPages of them, and raises faults in the Device. Time that goes back counts
    /// as the same time. The answer is valid until the next call; begin_ns ≤ now_ns < end_ns where it is lit. An event
    /// with a time after `now_ns` waits for it, but is dropped where that is more than a second away.
    const ScanOrder& poll(std::uint64_t now_ns);

    /// When the next cycle begins, as far as is known; the largest time while the rotation is not known.
    std::uint64_t next_boundary_ns() const;

    const RotationTracker& rotation() const { return rotation_; }

private:
    void hear_events();
    void raise(std::uint32_t faults);
    void announce_cycles(std::uint64_t before_ns);
    ScanOrder find_order(Phase& begin);
    ScanOrder dark(Dark why, std::uint64_t end_ns) const;

    ScanControlConfig config_;
    Device* device_ = nullptr;
    EventRing events_;
    Guard guard_;
    RotationTracker rotation_;
    std::uint64_t now_ns_ = 0;
    bool turning_ = false;  ///< Locked at the last poll().
    std::uint32_t cycle_ = 0;
    ScanOrder order_;
    Phase order_begin_ = 0;
};

}  // namespace xorvox::device
