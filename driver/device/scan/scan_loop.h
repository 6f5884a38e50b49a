// ScanLoop: what a device's program does again and again: ScanControl says what to light, a scanner lights it slot by
// slot, and ScanControl hears when it has finished, or was cut short: with the next order.
//
//   device.init(…); control.init(kControl, device, clock()); scanner.init(kScan, lines, buffer);
//   ScanLoop loop(control, scanner);
//   if (loop.stop() != Status::Ok) …                      // dark from the beginning
//   while (running) {
//       (void)device.poll(clock());
//       if (loop.poll(clock()) != Status::Ok) …           // the lines fail: tell someone, or reset
//   }
//   (void)loop.stop();                                    // dark at the end
//
// Each round is one step of the scanner (plane_scanner.h says how long), so a fault, or the end of a slice, waits no
// longer than that. The steps' own times are exact; what device.poll() and ScanControl take comes on top of each slot.
#pragma once

#include <algorithm>
#include <cstdint>

#include "driver/device/scan_control.h"
#include "driver/device/scan_order.h"
#include "voxelizer/status.h"

namespace xorvox::device {

/// `Scanner` is a PlaneScanner. One thread; no destructor, see plane_scanner.h.
template <class Scanner>
class ScanLoop {
public:
    /// Both are borrowed for good, and initialized before the first poll().
    ScanLoop(ScanControl& control, Scanner& scanner) : control_(&control), scanner_(&scanner) {}

    /// Asks ScanControl, begins an order that is new, or does the next step of the present one. Ok, or what the lines
    /// answer. After that it tries to be dark until the lines obey, and nothing is lit before ScanControl has ordered
    /// dark. Where scan_done() is expected it will: a slice that failed is not reported as done.
    Status poll(std::uint64_t now_ns) {
        const ScanOrder& order = control_->poll(now_ns);
        const bool is_new = order.number != shown_.number;
        if (is_new) {
            if (shown_.lit() && !failed_) control_->scan_done(shown_, now_ns);
            shown_ = order;
        }
        if (failed_) {
            const Status status = dark_ ? Status::Ok : stop();
            failed_ = order.lit() || status != Status::Ok;
            return status;
        }
        const std::uint64_t available_ns = order.end_ns - std::min(order.end_ns, now_ns);
        const Status status = is_new ? scanner_->begin(order, available_ns) : scanner_->step();
        failed_ = status != Status::Ok;
        dark_ = false;
        return status;
    }

    /// Dark at once, whatever ScanControl says; the next poll() goes on with the next new order. Ok, or what the lines
    /// answer: then poll() goes on as after a failure of its own.
    Status stop() {
        const Status status = scanner_->blank();
        dark_ = status == Status::Ok;
        failed_ = failed_ || !dark_;
        return status;
    }

private:
    ScanControl* control_;
    Scanner* scanner_;
    ScanOrder shown_;
    bool failed_ = false;  ///< Since it was last ordered dark.
    bool dark_ = false;    ///< The lines obeyed the last blank, and nothing was begun since.
};

}  // namespace xorvox::device
