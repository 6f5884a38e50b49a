#include "sim/chain_595.h"

#include "sim/pin_model.h"

namespace xorvox::sim {

Chain595::Chain595(std::size_t outputs, const Pins& pins)
    : serial_(line(pins.serial)),
      shift_clock_(line(pins.shift_clock)),
      storage_clock_(line(pins.storage_clock)),
      output_enable_(line(pins.output_enable)),
      stages_((outputs + 7) / 8 * 8),
      stored_(stages_.stages()) {}

bool Chain595::on_pins(LineMask levels, LineMask changed) {
    const bool was_enabled = enabled_;
    enabled_ = (levels & output_enable_) == 0;
    const LineMask rising = started_ ? levels & changed : 0;
    started_ = true;
    bool stored = false;
    if ((rising & storage_clock_) != 0) {
        for (std::size_t i = 0; i < stored_.size(); ++i) {
            const LineMask word = stages_.at(i);
            stored = stored || is_high(word) != is_high(stored_[i]);
            stored_[i] = word;
        }
    }
    if ((rising & shift_clock_) != 0) stages_.shift(levels ^ (changed & serial_));
    return enabled_ != was_enabled || (enabled_ && stored);
}

}  // namespace xorvox::sim
