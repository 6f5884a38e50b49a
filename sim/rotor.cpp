#include "sim/rotor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <deque>
#include <vector>

#include "driver/device/config.h"
#include "transport/random.h"

namespace xorvox::sim {
namespace {

using transport::Random;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kFastest = 1000.0;  ///< Times the description's speed.
constexpr std::int64_t kReportsPerTurn = 16;

/// Turns against time, as the drive would make them without jitter. Times in nanoseconds.
class Drive {
public:
    /// `rate`: the description's speed, in turns a nanosecond.
    Drive(double rate, const RotorConditions& conditions) {
        double speed = std::clamp(conditions.speed, 1.0 / kFastest, kFastest) * rate;
        const double spin_up_ns = std::max(conditions.spin_up_s, 0.0) * 1e9;
        if (spin_up_ns > 0.0) add({0.0, 0.0, 0.0, speed / spin_up_ns}, spin_up_ns);
        const double acceleration = conditions.acceleration * rate * 1e-9;
        if (acceleration != 0.0) {
            const double last = acceleration > 0.0 ? std::max(kFastest * rate, speed) : 0.0;
            add({from_ns_, from_, speed, acceleration}, (last - speed) / acceleration);
            speed = last;
        }
        add({from_ns_, from_, speed, 0.0}, kInfinity);
    }

    double turns_at(double time_ns) const {
        const Part* part = &parts_[count_ - 1];
        while (part->from_ns > time_ns && part != parts_.data()) --part;
        const double passed = time_ns - part->from_ns;
        return part->turns + passed * (part->rate + passed * part->acceleration / 2.0);
    }

    /// When it has made `turns`; infinity: never.
    double time_of(double turns) const {
        const Part* part = &parts_[count_ - 1];
        while (part->turns > turns && part != parts_.data()) --part;
        const double further = turns - part->turns;
        if (further <= 0.0) return part->from_ns;
        if (part->acceleration == 0.0) return part->rate > 0.0 ? part->from_ns + further / part->rate : kInfinity;
        const double square = part->rate * part->rate + 2.0 * part->acceleration * further;
        return part->from_ns + 2.0 * further / (part->rate + std::sqrt(std::max(square, 0.0)));
    }

private:
    struct Part {
        double from_ns = 0.0;
        double turns = 0.0;         ///< At its beginning, as is the rate.
        double rate = 0.0;          ///< Turns a nanosecond,
        double acceleration = 0.0;  ///< and the change of that a nanosecond.
    };

    void add(const Part& part, double length_ns) {
        parts_[count_++] = part;
        if (length_ns == kInfinity) return;
        from_ns_ = part.from_ns + length_ns;
        from_ = part.turns + length_ns * (part.rate + length_ns * part.acceleration / 2.0);
    }

    std::array<Part, 3> parts_;
    std::size_t count_ = 0;
    double from_ns_ = 0.0;  ///< Where the next part begins.
    double from_ = 0.0;
};

/// The same with jitter: turn k takes 1 + stretch(k) times as long. The drive's own time is what would have passed
/// without.
class Turning {
public:
    Turning(const Drive& drive, double jitter, std::uint64_t seed) : drive_(drive), jitter_(jitter), seed_(seed) {}

    double turns_at(double time_ns) {
        if (jitter_ == 0.0) return drive_.turns_at(time_ns);
        while (begin_of(delays_.size() - 1) <= time_ns) add_turn();
        const std::size_t turn = turn_at(time_ns);
        const double begin = drive_.time_of(static_cast<double>(turn));
        const double own = begin + (time_ns - begin - delays_[turn]) / (1.0 + stretch(turn));
        return drive_.turns_at(std::min(own, drive_.time_of(static_cast<double>(turn + 1))));
    }

    double time_of(double turns) {
        const double own = drive_.time_of(turns);
        if (jitter_ == 0.0 || own == kInfinity) return own;
        const auto turn = static_cast<std::size_t>(turns);
        while (delays_.size() <= turn) add_turn();
        return own + delays_[turn] + (own - drive_.time_of(static_cast<double>(turn))) * stretch(turn);
    }

private:
    double begin_of(std::size_t turn) const { return drive_.time_of(static_cast<double>(turn)) + delays_[turn]; }

    double stretch(std::size_t turn) const {
        return jitter_ * (2.0 * Random(seed_ + turn * 0x9e3779b97f4a7c15u).unit() - 1.0);
    }

    void add_turn() {
        const std::size_t turn = delays_.size() - 1;
        const double length = drive_.time_of(static_cast<double>(turn + 1)) - drive_.time_of(static_cast<double>(turn));
        delays_.push_back(length == kInfinity ? 0.0 : delays_[turn] + length * stretch(turn));
    }

    std::size_t turn_at(double time_ns) {
        const auto within = [&](std::size_t turn) {
            return turn + 1 < delays_.size() && begin_of(turn) <= time_ns && time_ns < begin_of(turn + 1);
        };
        if (within(turn_)) return turn_;
        if (within(turn_ + 1)) return ++turn_;
        std::size_t below = 0;
        std::size_t above = delays_.size() - 1;
        while (above - below > 1) {
            const std::size_t middle = below + (above - below) / 2;
            (begin_of(middle) <= time_ns ? below : above) = middle;
        }
        return turn_ = below;
    }

    Drive drive_;
    double jitter_;
    std::uint64_t seed_;
    std::vector<double> delays_{0.0};  ///< Of each turn's beginning, in nanoseconds.
    std::size_t turn_ = 0;             ///< That was asked for last.
};

/// A place at which the sensor gives something.
struct Edge {
    double turns = 0.0;
    std::int32_t steps = 0;  ///< 0: a pulse or mark.
};

/// Pulses, all alike, `pulses` a turn.
class PulseSensor {
public:
    PulseSensor(double mark, std::uint32_t pulses, const RotorConditions& conditions)
        : conditions_(conditions),
          random_(~conditions.seed),
          pulses_(pulses),
          first_(mark * pulses_ - std::floor(mark * pulses_)),
          noise_(std::clamp(conditions.noise * pulses_, 0.0, 0.25)) {}

    Edge next() {
        if (conditions_.missed >= 1.0) return {kInfinity};
        while (waiting_.empty()) add();
        const Edge edge{waiting_.front()};
        waiting_.pop_front();
        return edge;
    }

private:
    void add() {
        const double place = first_ + static_cast<double>(number_++);
        // Every pulse takes as many numbers, so that one probability does not change what another one hits.
        const double off = noise_ * (2.0 * random_.unit() - 1.0);
        const bool missed = random_.chance(conditions_.missed);
        const bool doubled = random_.chance(conditions_.doubled);
        const double later = 0.2 * (1.0 - random_.unit());
        if (missed) return;
        const double seen = std::max(place + off, 0.0);
        waiting_.push_back(seen / pulses_);
        if (doubled) waiting_.push_back((seen + later) / pulses_);
    }

    RotorConditions conditions_;
    Random random_;
    double pulses_;
    double first_;  ///< In distances of pulses, as is noise_.
    double noise_;
    std::uint64_t number_ = 0;
    std::deque<double> waiting_;
};

/// Steps, `steps` a turn, counted from the first mark.
class EncoderSensor {
public:
    EncoderSensor(double mark, std::uint32_t steps, const RotorConditions& conditions)
        : conditions_(conditions),
          random_(~conditions.seed),
          mark_(mark),
          steps_(steps),
          group_(std::max<std::int64_t>(steps / kReportsPerTurn, 1)),
          noise_(std::clamp(conditions.noise, 0.0, 0.25) * steps),
          told_(-static_cast<std::int64_t>(std::ceil(mark * steps))) {}

    Edge next() {
        std::int64_t report = told_ / group_ * group_;
        while (report <= told_) report += group_;
        while (next_mark_ * steps_ - static_cast<std::int64_t>(noise_) - 1 <= report) add_mark();
        const bool at_mark = !marks_.empty() && marks_.front() <= report;
        const std::int64_t step = at_mark ? std::max(marks_.front(), told_) : report;
        const double place = std::max(mark_ + static_cast<double>(step) / static_cast<double>(steps_), 0.0);
        const auto steps = static_cast<std::int32_t>(step - told_);
        told_ = step;
        if (at_mark && steps == 0) marks_.pop_front();
        return {place, steps};
    }

private:
    void add_mark() {
        const double off = noise_ * (2.0 * random_.unit() - 1.0);
        const bool missed = random_.chance(conditions_.missed);
        const bool doubled = random_.chance(conditions_.doubled);
        const double later = 0.2 * random_.unit() * static_cast<double>(steps_);
        const std::int64_t step = next_mark_++ * steps_ + static_cast<std::int64_t>(off);
        if (missed) return;
        marks_.push_back(step);
        if (doubled) marks_.push_back(step + 1 + static_cast<std::int64_t>(later));
    }

    RotorConditions conditions_;
    Random random_;
    double mark_;
    std::int64_t steps_;
    std::int64_t group_;  ///< That are told at once.
    double noise_;        ///< In steps.
    std::int64_t told_;
    std::int64_t next_mark_ = 0;
    std::deque<std::int64_t> marks_;  ///< Steps at which marks are seen.
};

bool moves(const DisplayDescription& display) {
    const bool rests = display.kind == DisplayKind::StackedPlanes || display.kind == DisplayKind::FreePoints;
    return !rests || display.sync.index != IndexSource::None;
}

/// The description's speed, in turns a nanosecond.
double described_rate(const DisplayDescription& display, double cycles_per_turn) {
    if (display.sync.index == IndexSource::None)
        return 1.0 / (static_cast<double>(cycle_ns(display)) * cycles_per_turn);
    return turns_per_second(display) * 1e-9;
}

}  // namespace

struct Rotor::Impl {
    Impl(const DisplayDescription& display, const RotorConditions& conditions)
        : source(display.sync.index),
          cycles_per_turn(device::rotation_config(display).cycles_per_turn),
          stall_ns(std::max(conditions.stall_s.value_or(kInfinity), 0.0) * 1e9),
          turning(Drive(described_rate(display, cycles_per_turn), conditions), std::clamp(conditions.jitter, 0.0, 0.5),
                  conditions.seed),
          pulses(display.sync.index_phase / cycles_per_turn, display.sync.index_pulses, conditions),
          encoder(display.sync.index_phase / cycles_per_turn, display.sync.index_pulses, conditions) {
        take();
    }

    void take() {
        event = {kNever, 0};
        if (source == IndexSource::None) return;
        const Edge edge = source == IndexSource::Pulses ? pulses.next() : encoder.next();
        const double time_ns = turning.time_of(edge.turns);
        if (time_ns > stall_ns || time_ns >= 0x1p63) {
            source = IndexSource::None;
            return;
        }
        event = {static_cast<std::uint64_t>(time_ns + 0.5), edge.steps};
    }

    IndexSource source;  ///< None once there will be no more events.
    double cycles_per_turn;
    double stall_ns;
    Turning turning;
    PulseSensor pulses;
    EncoderSensor encoder;
    device::RotationEvent event;
};

Rotor::Rotor(const DisplayDescription& display, const RotorConditions& conditions)
    : impl_(std::make_unique<Impl>(display, moves(display) ? conditions : RotorConditions{})) {}
Rotor::Rotor(Rotor&&) noexcept = default;
Rotor& Rotor::operator=(Rotor&&) noexcept = default;
Rotor::~Rotor() = default;

double Rotor::cycles_at(std::uint64_t time_ns) const {
    const double turns = impl_->turning.turns_at(std::min(static_cast<double>(time_ns), impl_->stall_ns));
    return turns * impl_->cycles_per_turn;
}

const device::RotationEvent& Rotor::next_event() const {
    return impl_->event;
}

void Rotor::take_event() {
    impl_->take();
}

}  // namespace xorvox::sim
