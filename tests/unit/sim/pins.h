// Pins that are set by hand, and the strobes that a model of chips sees.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "driver/display/description.h"
#include "sim/pin_model.h"
#include "sim/strobe.h"

namespace xorvox::test {

/// A strobe with its bits as text: of each panel and each row that is lit a line "panel.row: 0110" a channel, columns
/// from 0.
struct LitRows {
    std::uint64_t on_ns = 0;
    std::uint64_t off_ns = 0;
    std::uint32_t row_group = 0;
    std::uint32_t plane = 0;
    std::uint32_t slice = 0;
    std::uint32_t frame = 0;
    std::string bits;

    bool operator==(const LitRows&) const = default;
};

inline LitRows lit_rows(const DisplayDescription& display, const sim::Strobe& strobe) {
    LitRows seen{strobe.on_ns, strobe.off_ns, strobe.row_group, strobe.plane, strobe.slice, strobe.frame, {}};
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        const Panel& panel = display.panels[p];
        for (std::uint32_t row = strobe.row_group; row < panel.rows; row += display.scan.row_groups) {
            for (std::uint32_t channel = 0; channel < channel_count(display.format); ++channel) {
                if (!seen.bits.empty()) seen.bits += ' ';
                seen.bits += std::to_string(p) + '.' + std::to_string(row) + ':';
                const std::byte* bits = strobe.panels[p].at(row, channel);
                for (std::uint32_t column = 0; column < panel.columns; ++column) {
                    seen.bits += (bits[column / 8] >> (column % 8) & std::byte{1}) != std::byte{0} ? '1' : '0';
                }
            }
        }
    }
    return seen;
}

/// Sets lines of a model, one moment after the other.
class Hand {
public:
    explicit Hand(std::function<void(std::uint64_t, LineMask, LineMask)> on_change, LineMask levels = 0)
        : on_change_(std::move(on_change)), levels_(levels) {
        on_change_(0, levels_, ~LineMask{0});
    }

    /// Levels of some lines change at once, 10 ns after what was before.
    void set(LineMask mask, LineMask levels) {
        time_ns_ += 10;
        const LineMask next = (levels_ & ~mask) | (levels & mask);
        const LineMask changed = next ^ levels_;
        levels_ = next;
        on_change_(time_ns_, levels_, changed);
    }
    void high(std::uint32_t line) { set(sim::line(line), ~LineMask{0}); }
    void low(std::uint32_t line) { set(sim::line(line), 0); }
    void pulse(std::uint32_t line) {
        high(line);
        low(line);
    }
    std::uint64_t time_ns() const { return time_ns_; }

private:
    std::function<void(std::uint64_t, LineMask, LineMask)> on_change_;
    LineMask levels_;
    std::uint64_t time_ns_ = 0;
};

}  // namespace xorvox::test
