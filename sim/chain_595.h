// Chain595: 74HC595 shift registers in cascade, by their data sheet. SRCLR is tied high.
//
//            ┌───────── chip 0 ──────────┐          ┌── chip 1 …
//   serial ─►│ stage 0 ► stage 1 … ► 7 ──┼─ Q7S ───►│ stage 8 ►          … ─ serial_out()
//            │    │         │        │   │          │
//            │    ▼ storage clock rises  │          │
//            │ output 0  output 1 …  7   │          │ output 8            … while output enable is low
//            └───────────────────────────┘          └──
//
// The shift clock's rising edge moves every stage on; the storage clock's rising edge copies the stages to the outputs.
// Where both rise together, the outputs get the stages of before. With output enable high no output drives anything.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/shift_registers.h"
#include "transport/lines.h"

namespace xorvox::sim {

class Chain595 {
public:
    /// Numbers of lines.
    struct Pins {
        std::uint32_t serial = 0;
        std::uint32_t shift_clock = 0;    ///< SRCLK.
        std::uint32_t storage_clock = 0;  ///< RCLK.
        std::uint32_t output_enable = 0;  ///< OE, active low.
    };

    /// As many chips as `outputs` need, 8 each; all stages and outputs zero.
    Chain595(std::size_t outputs, const Pins& pins);

    /// As PinModel::on_pins. Whether an output may drive something else than before.
    bool on_pins(LineMask levels, LineMask changed);

    bool enabled() const { return enabled_; }
    bool stage(std::size_t number) const { return is_high(stages_.at(number)); }
    /// What output `number` drives: high or low; low as well where it drives nothing.
    bool output(std::size_t number) const { return enabled_ && is_high(stored_[number]); }
    /// Q7S of the last chip.
    bool serial_out() const { return stage(stages_.stages() - 1); }

private:
    bool is_high(LineMask levels) const { return (levels & serial_) != 0; }

    LineMask serial_;
    LineMask shift_clock_;
    LineMask storage_clock_;
    LineMask output_enable_;
    ShiftRegisters stages_;
    std::vector<LineMask> stored_;  // By stage.
    bool enabled_ = false;
    bool started_ = false;
};

}  // namespace xorvox::sim
