// Rotor: how a display really turns or sweeps, and the index pulses that its device hears of it.
//
// It begins at time 0 at phase 0 of cycle 0. A pulse comes whenever the rotor is at one of the places that the
// description's sync names:
//
//   turns  0             index_phase ÷ cycles a turn                        1
//          │                  │ mark      │ + 1/index_pulses   │ + 2/…      │
//
// With several pulses a turn and a phase that is not 0, one that is not the mark may so come first; a device that
// hears pulses alone then takes it for the mark (driver/device/rotation.h), as a real one does.
//
// Deterministic: the same seed gives the same times on every machine. No transcendental functions.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>

#include "driver/device/event_ring.h"
#include "driver/display/description.h"

namespace xorvox::sim {

/// What the drive and its sensor do. A turn is a turn of a rotor or helix, or a sweep up and back.
struct RotorConditions {
    double speed = 1.0;         ///< Times the description's speed, once it is reached; 0.001 … 1000.
    double spin_up_s = 0.0;     ///< From rest to that speed, at even acceleration; 0: it turns from the beginning.
    double acceleration = 0.0;  ///< From then on: change of speed a second, as a part of the description's speed, until
                                ///< it stands or is 1000 times as fast as described.
    double jitter = 0.0;        ///< Each turn is longer or shorter by up to this part, evenly; 0 … 0.5.
    double missed = 0.0;   ///< Probability, of each index pulse or encoder's mark, that the sensor does not see it.
    double doubled = 0.0;  ///< That it gives another one soon after it, at up to a fifth of the way to the next.
    double noise = 0.0;    ///< Of the edge's place: up to this part of a turn early or late, but never more than a
                           ///< quarter of the way to the next. Of an encoder the mark's alone, in whole steps.
    std::optional<double> stall_s;  ///< From then on it stands, at once.
    std::uint64_t seed = 1;
};

class Rotor {
public:
    static constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

    /// `display` must be valid; conditions out of range are taken to its end. Without index the device's clock is the
    /// master: at speed 1 a cycle takes cycle_ns(display). A display at rest without index has no conditions.
    Rotor(const DisplayDescription& display, const RotorConditions& conditions);
    Rotor(Rotor&&) noexcept;
    Rotor& operator=(Rotor&&) noexcept;
    ~Rotor();

    /// Where it is, in cycles of the description: whole ones count frames. Never falls. Any order of times. With jitter
    /// it keeps a number for each turn until the latest time that was asked for.
    double cycles_at(std::uint64_t time_ns) const;

    /// The next pulse, mark or steps of an encoder that the sensor gives and that was not taken; time_ns kNever: there
    /// will be none. Times never fall. Steps are told sixteen times a turn, and before a mark those that came before
    /// it.
    const device::RotationEvent& next_event() const;
    void take_event();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace xorvox::sim
