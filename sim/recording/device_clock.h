// DeviceClock: the clock of a recorded device, in which frames ask to be presented, beside the times of the recording.
#pragma once

#include <cstdint>

#include "sim/recording/reader.h"

namespace xorvox::sim {

/// Until a Hello was seen, both clocks are taken to be one.
class DeviceClock {
public:
    /// True: `block` is a Hello, which tells the device's time.
    bool note(const Block& block);

    /// The time in the recording at which the device's clock shows `device_ns`; before its beginning it wraps.
    std::uint64_t recorded_ns(std::uint64_t device_ns) const { return device_ns - ahead_ns_; }

private:
    std::uint64_t ahead_ns_ = 0;  ///< Wraps.
};

}  // namespace xorvox::sim
