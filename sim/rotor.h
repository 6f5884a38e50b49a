// Rotor: how a display really turns or sweeps, and the index pulses that its device hears of it.
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
    double speed = 1.0;         ///< Times the description's speed, once it is reached; above 0.
    double spin_up_s = 0.0;     ///< From rest to that speed, at even acceleration; 0: it turns from the beginning.
    double acceleration = 0.0;  ///< From then on: change of speed a second, as a part of the description's speed.
    double jitter = 0.0;        ///< Each turn is longer or shorter by up to this part, evenly; 0 … 0.5.
    double missed = 0.0;        ///< Probability, of each index pulse, that the sensor does not see it.
    double doubled = 0.0;       ///< That it gives another one soon after it, at up to a fifth of the way to the next.
    double noise = 0.0;         ///< Of the edge's time: up to this part of a turn early or late.
    std::optional<double> stall_s;  ///< From then on it stands.
    std::uint64_t seed = 1;
};

class Rotor {
public:
    static constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

    /// `display` must be valid; conditions out of range are taken to its end. Copies what it needs.
    Rotor(const DisplayDescription& display, const RotorConditions& conditions);
    Rotor(Rotor&&) noexcept;
    Rotor& operator=(Rotor&&) noexcept;
    ~Rotor();

    /// Where it is, in cycles of the description: whole ones count frames. Never falls. Any order of times, but going
    /// far back costs time.
    double cycles_at(std::uint64_t time_ns) const;

    /// The next pulse, mark or steps of an encoder that the sensor gives and that was not taken; time_ns kNever: there
    /// is none (ever, or not until the caller has taken more than a second of time).
    const device::RotationEvent& next_event() const;
    void take_event();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace xorvox::sim
