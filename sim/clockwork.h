// Clockwork: takes the simulated device half through time. It turns the rotor, lets the device hear its pulses, asks
// for orders when they are due, and has them scanned out, from event to event and in order of time.
//
//   rotor ─ pulses ─► ScanControl ─ orders ─► ScanOut ─► strobes, pins
//                          │ boundary()
//                          ▼
//                       Device
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "driver/device/device.h"
#include "driver/device/scan_control.h"
#include "driver/display/description.h"
#include "sim/rotor.h"
#include "sim/scan_out.h"
#include "sim/strobe.h"
#include "sim/timing.h"

namespace xorvox::sim {

class Clockwork {
public:
    /// All are borrowed, and were initialized; `timing` may be null. Without `rotor` the display keeps to the device's
    /// clock.
    Clockwork(const DisplayDescription& display, device::Device& device, device::ScanControl& control,
              const RotorConditions* rotor, TimingWatch* timing);

    /// Where the display is, in cycles.
    double cycles_at(std::uint64_t time_ns) const;

    /// From the next order on; null: nobody scans out.
    void set_scan(std::unique_ptr<ScanOut> scan);

    /// When the device began the cycle that it is in, as far as it was watched.
    std::uint64_t cycle_begin_ns() const { return cycle_begin_ns_; }

    /// All that happens until `now_ns`. A millisecond takes a step at least, if there is anybody to see it: else only
    /// the boundaries.
    void run_until(std::uint64_t now_ns);

    /// The device has received something at the time that it was run to.
    void device_moved();

    /// When to run it again at the latest.
    std::uint64_t next_ns() const;

private:
    bool is_watched() const { return rotor_ || scan_ != nullptr || timing_ != nullptr; }
    void step(std::uint64_t now_ns);
    void follow();

    const DisplayDescription& display_;
    device::Device& device_;
    device::ScanControl& control_;
    std::optional<Rotor> rotor_;
    TimingWatch* timing_;
    std::unique_ptr<ScanOut> scan_;
    std::uint64_t now_ns_ = 0;
    std::uint64_t order_end_ns_ = 0;
    std::uint32_t cycle_ = 0;  ///< Of the device.
    std::uint64_t cycle_begin_ns_ = 0;
    std::uint32_t order_ = 0;  ///< The number of the one that is being followed.
};

}  // namespace xorvox::sim
