// ShiftRegisters: registers that bits are shifted into, one for each line, all by one clock. What chips of panels are
// made of.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "transport/lines.h"

namespace xorvox::sim {

class ShiftRegisters {
public:
    /// Of `stages` bits a line, 1 or more; all zero.
    explicit ShiftRegisters(std::size_t stages) : stages_(stages), words_(2 * stages) {}

    std::size_t stages() const { return stages_; }

    /// A rising edge of the clock: every line's level goes into stage 0 of its register, what was in the last stage is
    /// gone.
    void shift(LineMask levels) {
        words_[next_] = words_[next_ + stages_] = levels;
        if (++next_ == stages_) next_ = 0;
    }

    /// What the registers of all lines have in `stage`; stage 0 is next to the line.
    LineMask at(std::size_t stage) const { return words_[next_ + stages_ - 1 - stage]; }

    /// As they were shifted in: the last stage first, stage 0 last. Valid until the next shift().
    std::span<const LineMask> oldest_first() const { return {words_.data() + next_, stages_}; }

private:
    std::size_t stages_;
    std::vector<LineMask> words_;  // Twice, one after the other: so that the oldest to the newest lie in a row.
    std::size_t next_ = 0;
};

}  // namespace xorvox::sim
