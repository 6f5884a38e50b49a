// Timing: what a display made of its frames in time: when each came, was shown and lit, and when and why it was dark.
// What one cycle of light is like, sim/statistics.h says.
//
//   first packet ──────► accepted ─────────────► presented ──────────► first light
//                        or refused              at a boundary         its first slice is begun
//                                                or dropped: a later frame was shown instead
//
// Seen from the wire and from the device half's orders. Times are the simulator's, in nanoseconds.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "driver/device/device.h"
#include "driver/device/scan_order.h"
#include "driver/wire/messages.h"

namespace xorvox::sim {

/// One frame that came.
struct FrameTiming {
    static constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

    std::uint32_t frame = 0;
    std::uint64_t asked_ns = 0;             ///< When it was to be shown; 0: as soon as possible.
    std::uint64_t first_packet_ns = 0;      ///< When the device received its beginning.
    std::uint64_t accepted_ns = kNever;     ///< When it was whole.
    std::uint64_t presented_ns = kNever;    ///< The boundary from which on it was shown.
    std::uint64_t first_light_ns = kNever;  ///< When the first slice of it was begun.
    bool late = false;     ///< It was not shown at the first boundary after it was asked for, or, if it was not asked
                           ///< for at a time, accepted: a cycle or more too late.
    bool dropped = false;  ///< A later one was shown instead.
};

struct Timing {
    std::uint64_t until_ns = 0;  ///< All that follows is of the time from 0 to here.

    std::uint64_t begun = 0;  ///< Frames,
    std::uint64_t accepted = 0;
    std::uint64_t refused = 0;  ///< of which parts were missing, damaged or without credit.
    std::uint64_t presented = 0;
    std::uint64_t late = 0;  ///< Of the presented.
    std::uint64_t dropped = 0;

    /// From the first packet to the first light, of the frames that were lit.
    struct Latency {
        std::uint64_t frames = 0;
        std::uint64_t least_ns = 0;
        double mean_ns = 0.0;
        std::uint64_t most_ns = 0;
    };
    Latency latency;

    std::uint64_t cycles = 0;  ///< In which something was lit.
    std::uint64_t torn = 0;    ///< Of them, those in which slices of more than one frame were lit.

    std::uint64_t lit_ns = 0;                ///< In which a slice was being scanned out.
    std::array<std::uint64_t, 5> dark_ns{};  ///< By device::Dark; [0] is 0.
    std::uint64_t locked = 0;                ///< Times that the device found the rotation,
    std::uint64_t lost = 0;                  ///< and lost it.
    std::array<std::uint64_t, 8> faults{};   ///< Times that each wire::Fault rose.
    static_assert(wire::kHighestFault < std::tuple_size_v<decltype(faults)>);
};

/// One JSON object on one line, keys always in the same order. `latency_ns` is null where no frame was lit.
std::string to_json(const Timing& timing);

/// Keeps the account; Simulator feeds it (SimulatorOptions::keeps_time). One thread.
class TimingWatch {
public:
    static constexpr std::size_t kFramesKept = 1024;

    /// What the device does between two calls of look().
    struct State {
        device::Dark dark = device::Dark::NoPicture;
        bool locked = false;
        std::uint32_t cycle = 0;  ///< Number of the device's cycle.
        bool has_frame = false;
        std::uint32_t frame = 0;
        std::uint32_t faults = 0;
    };

    /// It is `now_ns`, and from here on the device does as `state` says. Time never goes back.
    void look(const State& state, std::uint64_t now_ns);
    /// The device received a packet, or sent one.
    void received(std::span<const std::byte> packet, std::uint64_t now_ns);
    void sent(std::span<const std::byte> packet, std::uint64_t now_ns);

    const Timing& timing() const { return timing_; }
    /// The frames that were lit or dropped last, or replaced before anything of them was lit, at most kFramesKept, in
    /// the order in which that became known.
    const std::vector<FrameTiming>& frames() const { return done_; }

private:
    void present(std::uint32_t frame, std::uint64_t now_ns);
    void light(std::uint32_t frame, std::uint64_t now_ns);
    void finish(const FrameTiming& frame);

    Timing timing_;
    State state_;
    std::map<std::uint32_t, FrameTiming> open_;  ///< By their ids; neither lit nor replaced yet.
    std::vector<FrameTiming> done_;
    std::uint16_t session_ = 0;
    std::optional<std::uint32_t> last_begun_;
    std::uint64_t boundary_ns_ = 0;         ///< The last one,
    std::uint64_t boundary_before_ns_ = 0;  ///< and the one before.
    bool lit_in_cycle_ = false;
    bool torn_ = false;
    std::uint32_t lit_frame_ = 0;
    double latency_sum_ns_ = 0.0;
};

}  // namespace xorvox::sim
