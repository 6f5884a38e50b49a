// A rotor on a desk: it turns as fast as a test says, its sensor gives the pulses that a test spoils, and a tracker
// follows it. What it measures is the truth to compare with: its own angle, in floating point.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <random>

#include "driver/device/rotation.h"
#include "tests/catch.h"

namespace xorvox::test {

using device::kCycle;
using device::Phase;
using device::RotationConfig;
using device::RotationTracker;

/// What is wrong with the sensor; times as parts of the pulses' interval.
struct Sensor {
    double jitter = 0.0;         ///< Every pulse is up to so much early or late.
    double missing = 0.0;        ///< Part of the pulses that do not come.
    double doubled = 0.0;        ///< Part of the pulses that come twice,
    double doubled_after = 0.1;  ///< the second time so much later; 0: anywhere up to the next.
    std::uint32_t seed = 1;
};

/// 20 turns a second, a stall below 10, an overspeed above 25.
inline RotationConfig pulses_at_20(std::uint32_t pulses_per_turn = 1, std::uint32_t cycles_per_turn = 1) {
    return {.source = IndexSource::Pulses,
            .pulses_per_turn = pulses_per_turn,
            .cycles_per_turn = cycles_per_turn,
            .cycle_ns = 50'000'000 / cycles_per_turn,
            .shortest_turn_ns = 40'000'000,
            .longest_turn_ns = 100'000'000};
}
inline RotationConfig encoder_at_20(std::uint32_t steps_per_turn) {
    RotationConfig config = pulses_at_20(steps_per_turn);
    config.source = IndexSource::Encoder;
    return config;
}

class Rotor {
public:
    static constexpr std::uint64_t kStepNs = 50'000;

    RotationConfig config;
    Sensor sensor;
    RotationTracker tracker;
    std::uint64_t now_ns = 1'000'000'000;
    double turns = 0.9;  ///< Where it is; the mark is at whole turns.
    std::uint32_t faults = 0;

    // While locked, since forget():
    double worst_error = 0.0;     ///< Of the phase, in turns.
    double greatest_rate = 0.0;   ///< Of the phase, in turns a second.
    double locked_seconds = 0.0;  ///< How long it was locked.

    Rotor(const RotationConfig& with, const Sensor& sensor_of = {})
        : config(with), sensor(sensor_of), random_(sensor_of.seed) {
        REQUIRE(tracker.init(config, now_ns) == Status::Ok);
    }

    bool locked() const { return tracker.state() == RotationTracker::State::Locked; }
    void forget() { worst_error = greatest_rate = locked_seconds = 0.0; }

    /// Turns for so long, at `speed` (seconds since the call) turns a second.
    void turn(double seconds, const std::function<double(double)>& speed) {
        const auto steps = static_cast<std::uint64_t>(seconds * 1e9 / kStepNs + 0.5);
        for (std::uint64_t i = 0; i < steps; ++i) step(speed(static_cast<double>(i) * kStepNs * 1e-9));
    }
    void turn(double seconds, double speed) {
        turn(seconds, [speed](double) { return speed; });
    }

private:
    double uniform() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }

    void step(double speed) {
        const Phase phase_before = tracker.phase();
        const bool locked_before = locked();
        const double per_turn = config.pulses_per_turn;
        const double before = turns * per_turn;
        turns += speed * kStepNs * 1e-9;
        const double after = turns * per_turn;
        const auto at = [&](double crossing) {
            return now_ns + static_cast<std::uint64_t>((crossing - before) / (after - before) * kStepNs);
        };
        if (config.source == IndexSource::Encoder) {
            const auto steps = static_cast<std::int32_t>(std::floor(after) - std::floor(before));
            const bool mark = std::floor(turns) > std::floor(before / per_turn);
            if (mark) {
                const auto rest = static_cast<std::int32_t>(std::floor(after) - std::floor(turns) * per_turn);
                tracker.encoder(at(std::floor(turns) * per_turn), steps - rest);
                if (uniform() >= sensor.missing) tracker.pulse(at(std::floor(turns) * per_turn));
                tracker.encoder(now_ns + kStepNs, rest);
            } else {
                tracker.encoder(now_ns + kStepNs, steps);
            }
        } else if (std::floor(after) > std::floor(before)) {
            const double interval_ns = 1e9 / (speed * per_turn);
            const double jitter = sensor.jitter * (2.0 * uniform() - 1.0) * interval_ns;
            const auto due = at(std::floor(after)) + static_cast<std::uint64_t>(static_cast<std::int64_t>(jitter));
            if (uniform() >= sensor.missing) waiting_.emplace(std::max(due, now_ns), 0);
            if (uniform() < sensor.doubled) {
                const double later = sensor.doubled_after > 0.0 ? sensor.doubled_after : uniform();
                waiting_.emplace(std::max(due, now_ns) + static_cast<std::uint64_t>(later * interval_ns), 0);
            }
        }
        now_ns += kStepNs;
        while (!waiting_.empty() && waiting_.begin()->first <= now_ns) {
            tracker.pulse(waiting_.begin()->first);
            waiting_.erase(waiting_.begin());
        }
        tracker.advance(now_ns);
        faults |= tracker.take_faults();
        measure(phase_before, locked_before && locked());
    }

    void measure(Phase before, bool went_on) {
        const std::int64_t gone = device::phase_between(before, tracker.phase());
        REQUIRE(gone >= 0);
        if (!went_on) offset_known_ = false;
        if (!locked()) {
            REQUIRE(gone == 0);
            return;
        }
        const double turn = static_cast<double>(kCycle) * config.cycles_per_turn;
        double error = static_cast<double>(tracker.phase()) / turn - turns;
        if (!offset_known_) {
            // Which pulse was taken for the mark is chance; and the tracker counts its own turns.
            const double marks = config.source == IndexSource::Pulses ? config.pulses_per_turn : 1;
            offset_ = std::round(error * marks) / marks;
            offset_known_ = true;
        }
        error -= offset_;
        worst_error = std::max(worst_error, std::abs(error));
        locked_seconds += kStepNs * 1e-9;
        if (went_on) greatest_rate = std::max(greatest_rate, static_cast<double>(gone) / turn / (kStepNs * 1e-9));
    }

    std::mt19937 random_;
    std::multimap<std::uint64_t, int> waiting_;
    bool offset_known_ = false;
    double offset_ = 0.0;
};

}  // namespace xorvox::test
