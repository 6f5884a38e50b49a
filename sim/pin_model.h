// PinModel: the chips and LEDs behind a controller's pins. It is fed with levels and edges, and says what was lit. It
// knows data sheets and the display's wiring; never what set the pins.
//
// What it tells of each strobe is what the pins say: when, which rows, which bits, of a cube which layer. Plane and
// frame are not on the pins; they are 0.
//
// A level and the edge that takes it in at the same moment: the chip takes the level of before, for its set-up time is
// not kept.
#pragma once

#include <cstdint>

#include "sim/strobe.h"
#include "transport/lines.h"

namespace xorvox::sim {

class PinModel {
public:
    virtual ~PinModel() = default;

    /// From `time_ns` on, which never goes back, the lines have `levels`; those of `changed` had others before. The
    /// first call says what the lines are at the beginning: no edge. Strobes that this ends are given before it
    /// returns.
    virtual void on_pins(std::uint64_t time_ns, LineMask levels, LineMask changed) = 0;
};

/// The mask of a line; of none for a number that there is none of.
constexpr LineMask line(std::uint32_t number) {
    return number < kMaxLines ? LineMask{1} << number : 0;
}

}  // namespace xorvox::sim
