// RotationTracker: where a turning or sweeping display is, by its index pulses, by an encoder, or by the clock alone.
//
//              5 intervals in a row that agree, speed within the limits
//   Unlocked ───────────────────────────────────────────────────────────► Locked
//      (nothing turned yet: no fault)                                       │ silence, pulses that do not fit,
//                                     the same                              │ too slow, too fast, backwards
//   Lost  ◄─────────────────────────────────────────────────────────────────┘
//     └───────────────────────────────────────────────────────────────────► Locked
//
// Phase. Locked, the phase is a line against time whose rate is that of the filtered turn, and at every index pulse
// the line is bent so that it makes up three quarters of its error over the next interval between pulses, but never
// more than an eighth of that interval. So the phase never jumps, never runs backwards, and no slice is shorter than
// 8/9 of its share of the filtered turn. Not locked, it stands.
//
// Turn. Its length is the median of five intervals, smoothed by half. An interval of about 2, 3 … B pulses counts as
// so many: pulses were missed. B is 4, or the pulses of an eighth of a turn if they are more. A pulse within a quarter
// of an interval of the last one is a bounce, and nothing. Every other one that is more than a quarter of an interval
// off is an outlier and moves nothing: it counts 2, a good pulse takes 1 back, and at 2·B the index is lost. Times that
// do not increase are outliers. Without a pulse for B + ½ intervals the index is lost. It is lost, too, when the phase
// is off a pulse by more than a quarter of an interval and 1/32 of a turn.
//
// First mark. With several pulses a turn, all alike, the first one after the lock was lost, or after the start, is
// taken for the mark, and stays it for as long as the lock holds: by chance the picture then stands turned by some
// pulses' distance (half turns with two pulses: by half a turn). One pulse a turn, or an encoder, leaves nothing to
// chance.
//
// Encoder. Steps are looked at an eighth of a turn at a time, as if they were pulses, but none is ever missed: without
// any for 4½ eighths it is a stall. The mark, pulse(), says where the turn begins, and later by how many steps the
// count is off: up to 1/64 of a turn is corrected, more makes the mark an outlier; without a mark for 4½ turns the
// index is lost. Backwards by more than an eighth of a turn, or not locked by a whole turn (somebody turns it by hand),
// is a reversal. Pulses alone do not tell which way it turns.
//
// All integers. One thread, and no interrupt while it works: ScanControl queues what interrupts bring.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "driver/device/phase.h"
#include "driver/display/description.h"
#include "driver/wire/messages.h"
#include "voxelizer/status.h"

namespace xorvox::device {

/// What the tracker must know; driver/device/config.h computes it from a description.
struct RotationConfig {
    IndexSource source = IndexSource::None;
    std::uint32_t pulses_per_turn = 1;   ///< Encoder: steps. 1 … 65536.
    std::uint32_t cycles_per_turn = 1;   ///< Frames a turn: 2 of half turns, the blades of a helix. 1 … 8.
    std::uint64_t cycle_ns = 0;          ///< Without index: the length of every cycle. 1 … 2^41.
    std::uint64_t shortest_turn_ns = 0;  ///< A shorter turn is an overspeed; 16 a pulse at least.
    std::uint64_t longest_turn_ns = 0;   ///< A longer one is a stall; above shortest_turn_ns, at most 2^41.
    std::uint32_t mark_phase = 0;        ///< Phase at the (first) mark, in 2^-32 of a cycle.
};

class RotationTracker {
public:
    enum class State : std::uint8_t { Unlocked, Locked, Lost };

    /// Ok, or InvalidArgument: a value out of its range. Without index it is locked at once, and cycle 0 begins now.
    Status init(const RotationConfig& config, std::uint64_t now_ns);

    /// The index pulse, or the encoder's mark, came at `time_ns`; in the order in which they came. Without index: does
    /// nothing.
    void pulse(std::uint64_t time_ns);
    /// The encoder went on by `steps` until `time_ns`; backwards: negative.
    void encoder(std::uint64_t time_ns, std::int32_t steps);
    /// It is `now_ns`, and all that came before was told. Earlier than before is taken for the same time.
    void advance(std::uint64_t now_ns);

    State state() const { return state_; }
    /// At the time of the last advance(). It only grows, also from lock to lock.
    Phase phase() const { return phase_; }
    /// When the phase comes, or came, to `phase`, as far as is known. Locked only.
    std::uint64_t time_of(Phase phase) const { return line_.time_of(phase); }
    /// The length of a turn, filtered; 0 while too little is known.
    std::uint64_t turn_ns() const { return turn_ns_; }
    /// fault_bit() of what rose since the last call.
    std::uint32_t take_faults();

private:
    static constexpr std::size_t kWindow = 5;

    std::uint64_t interval_ns() const;
    std::uint64_t most_bridged() const;
    std::uint64_t silence_ns() const;
    std::uint64_t phase_of_pulses(std::uint64_t pulses) const;
    void begin(std::uint64_t time_ns);
    void hear(std::uint64_t time_ns);
    void mark();
    void observe_steps(std::uint64_t time_ns);
    void accept(std::uint64_t time_ns, std::uint64_t turn_ns);
    void outlier();
    void lose(wire::Fault fault);
    Phase pulse_phase();
    void lock(std::uint64_t time_ns);
    void steer(std::uint64_t time_ns);
    bool steady(std::uint64_t median) const;

    RotationConfig config_;
    std::uint32_t quantum_ = 1;  ///< Pulses between two observations.
    State state_ = State::Unlocked;
    std::uint32_t faults_ = 0;
    std::uint64_t now_ns_ = 0;
    Phase phase_ = 0;
    PhaseLine line_;

    bool begun_ = false;         ///< last_ns_ is valid.
    std::uint64_t last_ns_ = 0;  ///< Of the last observation that was accepted.
    std::uint32_t outliers_ = 0;
    std::uint64_t turn_ns_ = 0;
    std::array<std::uint64_t, kWindow> turns_{};  ///< The last intervals, as turns.
    std::size_t turn_count_ = 0;                  ///< Of them, up to kWindow.
    std::size_t next_turn_ = 0;

    Phase turn_phase_ = 0;       ///< At position 0, but for the mark's phase.
    std::int64_t position_ = 0;  ///< Pulses or steps since the mark.
    bool marked_ = false;        ///< Encoder: the mark has passed, and from here on all positions count from it.
    std::int64_t marked_at_ = 0;
    std::int64_t observed_ = 0;  ///< Position of the last observation.
    std::int64_t furthest_ = 0;
};

}  // namespace xorvox::device
