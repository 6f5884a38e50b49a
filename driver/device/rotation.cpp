#include "driver/device/rotation.h"

#include <algorithm>

namespace xorvox::device {

using wire::Fault;

namespace {

constexpr std::uint32_t kOutlierWeight = 2;
constexpr std::uint64_t kCyclesKept = 16;  ///< Before now, in which time_of() is exact without index.

std::uint64_t distance(std::uint64_t a, std::uint64_t b) {
    return a > b ? a - b : b - a;
}

}  // namespace

Status RotationTracker::init(const RotationConfig& config, std::uint64_t now_ns) {
    constexpr std::uint64_t kLongest = std::uint64_t{1} << 41;
    if (config.cycles_per_turn < 1 || config.cycles_per_turn > 8) return Status::InvalidArgument;
    if (config.source == IndexSource::None) {
        if (config.cycle_ns < 1 || config.cycle_ns > kLongest) return Status::InvalidArgument;
    } else if (config.pulses_per_turn < 1 || config.pulses_per_turn > 65536 ||
               config.shortest_turn_ns / 16 < config.pulses_per_turn ||
               config.longest_turn_ns <= config.shortest_turn_ns || config.longest_turn_ns > kLongest) {
        return Status::InvalidArgument;
    }
    *this = RotationTracker{};
    config_ = config;
    now_ns_ = now_ns;
    if (config.source == IndexSource::None) {
        line_ = {now_ns, 0, config.cycle_ns, kCycle, kCycle};
        turn_ns_ = config.cycle_ns * config.cycles_per_turn;
        state_ = State::Locked;
    }
    if (config.source == IndexSource::Encoder) quantum_ = std::max<std::uint32_t>(config.pulses_per_turn / 8, 1);
    return Status::Ok;
}

std::uint32_t RotationTracker::take_faults() {
    const std::uint32_t faults = faults_;
    faults_ = 0;
    return faults;
}

// From observation to observation.
std::uint64_t RotationTracker::interval_ns() const {
    return turn_ns_ * quantum_ / config_.pulses_per_turn;
}

// Intervals between two observations that are still bridged.
std::uint64_t RotationTracker::most_bridged() const {
    return config_.source == IndexSource::Pulses ? std::max<std::uint64_t>(config_.pulses_per_turn / 8, 4) : 4;
}

std::uint64_t RotationTracker::silence_ns() const {
    return interval_ns() * most_bridged() + interval_ns() / 2;
}

std::uint64_t RotationTracker::phase_of_pulses(std::uint64_t pulses) const {
    return pulses * config_.cycles_per_turn * kCycle / config_.pulses_per_turn;
}

void RotationTracker::advance(std::uint64_t now_ns) {
    now_ns_ = std::max(now_ns_, now_ns);
    if (config_.source == IndexSource::None) {
        const std::uint64_t cycles = (now_ns_ - line_.from_ns) / config_.cycle_ns;
        if (cycles > 2 * kCyclesKept) {
            line_.from_ns += (cycles - kCyclesKept) * config_.cycle_ns;
            line_.phase += (cycles - kCyclesKept) * kCycle;
        }
    } else {
        hear(now_ns_);
    }
    if (state_ == State::Locked) phase_ = line_.at(now_ns_);
}

// How long nothing was accepted is judged whenever time goes on, however rarely the caller comes.
void RotationTracker::hear(std::uint64_t time_ns) {
    if (state_ != State::Locked || time_ns <= last_ns_ || time_ns - last_ns_ <= silence_ns()) return;
    lose(config_.source == IndexSource::Encoder ? Fault::Stall : Fault::LostIndex);
}

void RotationTracker::begin(std::uint64_t time_ns) {
    begun_ = true;
    last_ns_ = time_ns;
    turn_count_ = 0;
    observed_ = furthest_;
    if (config_.source == IndexSource::Pulses) position_ = 0;
}

void RotationTracker::pulse(std::uint64_t time_ns) {
    if (config_.source == IndexSource::None) return;
    if (config_.source == IndexSource::Encoder) {
        mark();
        return;
    }
    hear(time_ns);
    if (!begun_) {
        begin(time_ns);
        return;
    }
    if (time_ns <= last_ns_) {
        outlier();
        return;
    }
    const std::uint64_t passed = time_ns - last_ns_;
    if (state_ == State::Locked) {
        const std::uint64_t interval = interval_ns();
        if (passed < interval / 4) return;
        const std::uint64_t count = (passed + interval / 2) / interval;
        if (count < 1 || count > most_bridged() || distance(passed, count * interval) > interval / 4) {
            outlier();
            return;
        }
        position_ += static_cast<std::int64_t>(count);
        accept(time_ns, passed * config_.pulses_per_turn / count);
        return;
    }
    if (passed < config_.shortest_turn_ns / config_.pulses_per_turn / 2) return;
    if (passed > config_.longest_turn_ns * 4 / config_.pulses_per_turn) {
        begin(time_ns);
        return;
    }
    ++position_;
    accept(time_ns, passed * config_.pulses_per_turn);
}

void RotationTracker::encoder(std::uint64_t time_ns, std::int32_t steps) {
    if (config_.source != IndexSource::Encoder) return;
    hear(time_ns);
    const std::int64_t turn = config_.pulses_per_turn;
    position_ += steps;
    if (furthest_ - position_ > (state_ == State::Locked ? std::max<std::int64_t>(turn / 8, 2) : turn)) {
        lose(Fault::Reversed);
        return;
    }
    furthest_ = std::max(furthest_, position_);
    if (marked_ && position_ - marked_at_ > turn * 9 / 2) {
        marked_ = false;
        if (state_ == State::Locked) lose(Fault::LostIndex);
    }
    if (!begun_) {
        begin(time_ns);
    } else if (furthest_ - observed_ >= quantum_ && time_ns > last_ns_) {
        observe_steps(time_ns);
    }
}

void RotationTracker::observe_steps(std::uint64_t time_ns) {
    const std::uint64_t passed = time_ns - last_ns_;
    if (passed > config_.longest_turn_ns * 4) {
        begin(time_ns);
        return;
    }
    const auto steps = static_cast<std::uint64_t>(furthest_ - observed_);
    const std::uint64_t turn = mul_div(passed, config_.pulses_per_turn, steps);
    observed_ = furthest_;
    if (state_ == State::Locked && distance(turn, turn_ns_) > turn_ns_ / 4) {
        last_ns_ = time_ns;
        outlier();
        return;
    }
    accept(time_ns, turn);
}

void RotationTracker::mark() {
    const std::int64_t turn = config_.pulses_per_turn;
    std::int64_t off = position_;
    if (marked_ && state_ == State::Locked) {
        off -= (position_ + turn / 2 + 2 * turn) / turn * turn - 2 * turn;
        if (std::max(off, -off) > std::max<std::int64_t>(turn / 64, 1)) {
            outlier();
            return;
        }
    }
    marked_ = true;
    position_ -= off;
    furthest_ -= off;
    observed_ -= off;
    marked_at_ = position_;
}

void RotationTracker::accept(std::uint64_t time_ns, std::uint64_t turn_ns) {
    last_ns_ = time_ns;
    if (outliers_ > 0) --outliers_;
    turns_[next_turn_] = turn_ns;
    next_turn_ = (next_turn_ + 1) % kWindow;
    if (turn_count_ < kWindow) ++turn_count_;
    if (turn_count_ < kWindow && state_ != State::Locked) return;

    std::array<std::uint64_t, kWindow> sorted = turns_;
    for (std::size_t i = 1; i < kWindow; ++i) {
        for (std::size_t k = i; k > 0 && sorted[k] < sorted[k - 1]; --k) std::swap(sorted[k], sorted[k - 1]);
    }
    const std::uint64_t median = sorted[kWindow / 2];
    turn_ns_ = state_ == State::Locked ? (turn_ns_ + median) / 2 : median;
    if (turn_ns_ < config_.shortest_turn_ns) {
        lose(Fault::Overspeed);
    } else if (state_ == State::Locked) {
        if (turn_ns_ > config_.longest_turn_ns) {
            lose(Fault::Stall);
        } else {
            steer(time_ns);
        }
    } else if (turn_ns_ <= config_.longest_turn_ns && steady(median) &&
               (config_.source == IndexSource::Pulses || marked_)) {
        lock(time_ns);
    }
}

bool RotationTracker::steady(std::uint64_t median) const {
    return std::all_of(turns_.begin(), turns_.end(),
                       [median](std::uint64_t turn) { return distance(turn, median) <= median / 4; });
}

void RotationTracker::outlier() {
    outliers_ += kOutlierWeight;
    if (outliers_ < 2 * most_bridged()) return;
    outliers_ = 0;
    if (state_ == State::Locked) lose(Fault::LostIndex);
}

void RotationTracker::lose(Fault fault) {
    faults_ |= wire::fault_bit(fault);
    state_ = State::Lost;
    begun_ = false;
    marked_ = false;
    outliers_ = 0;
    turn_count_ = 0;
    turn_ns_ = 0;
    furthest_ = position_;
}

// The phase that belongs to the last pulse, or to the last step that was observed. Positions begin again at every turn,
// so that they do not grow.
Phase RotationTracker::pulse_phase() {
    const std::int64_t turn = config_.pulses_per_turn;
    const std::int64_t& at = config_.source == IndexSource::Encoder ? observed_ : position_;
    if (at >= turn) {
        const std::int64_t turns = at / turn;
        turn_phase_ += static_cast<std::uint64_t>(turns) * config_.cycles_per_turn * kCycle;
        position_ -= turns * turn;
        observed_ -= turns * turn;
        furthest_ -= turns * turn;
        marked_at_ -= turns * turn;
    }
    return turn_phase_ + config_.mark_phase +
           phase_of_pulses(static_cast<std::uint64_t>(std::max<std::int64_t>(at, 0)));
}

void RotationTracker::lock(std::uint64_t time_ns) {
    const std::uint64_t turn = config_.cycles_per_turn * kCycle;
    turn_phase_ = phase_ / turn * turn;
    Phase at = pulse_phase();
    while (phase_between(phase_, at) < 0) {
        turn_phase_ += turn;
        at += turn;
    }
    const std::uint64_t step = phase_of_pulses(quantum_);
    line_ = {time_ns, at, interval_ns(), step, step};
    state_ = State::Locked;
}

void RotationTracker::steer(std::uint64_t time_ns) {
    const auto step = static_cast<std::int64_t>(phase_of_pulses(quantum_));
    const std::int64_t error = phase_between(line_.at(time_ns), pulse_phase());
    const auto turn = static_cast<std::int64_t>(config_.cycles_per_turn * kCycle);
    if (std::max(error, -error) > std::max(step / 4, turn / 32)) {
        lose(Fault::LostIndex);
        return;
    }
    const std::int64_t correction = std::clamp(error * 3 / 4, -step / 8, step / 8);
    // Where the phase was already told for a later time, it goes on from there.
    const std::uint64_t from_ns = std::max(time_ns, now_ns_);
    line_ = {from_ns, line_.at(from_ns), interval_ns(), static_cast<std::uint64_t>(step + correction),
             static_cast<std::uint64_t>(step)};
}

}  // namespace xorvox::device
