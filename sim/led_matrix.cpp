#include "sim/led_matrix.h"

#include <string_view>
#include <utility>

namespace xorvox::sim {

LedMatrix::LedMatrix(const DisplayDescription& display, const device::MatrixPins& pins, StrobeSink sink)
    : sink_(std::move(sink)), rows_(display) {
    const std::uint32_t groups = display.scan.row_groups;
    std::size_t next = 0;
    for (std::uint32_t g = 0; g < groups; ++g) {
        groups_.push_back(line(pins.lines[next++]));
        select_lines_ |= groups_.back();
    }
    const auto add_led = [&](std::uint32_t panel, std::uint32_t row, std::uint32_t column, std::uint32_t channel) {
        leds_.push_back({line(pins.lines[next++]), panel, row, column, channel});
        column_lines_ |= leds_.back().line;
    };
    constexpr std::string_view kChannels = "rgb";
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        for (std::uint32_t row = 0; row < display.panels[p].rows; row += groups) {
            for (std::uint32_t column = 0; column < display.panels[p].columns; ++column) {
                for (std::uint32_t i = 0; i < channel_count(display.format); ++i) {
                    add_led(p, row, column, static_cast<std::uint32_t>(kChannels.find(display.scan.color_order[i])));
                }
            }
        }
    }
}

void LedMatrix::on_pins(std::uint64_t time_ns, LineMask levels, LineMask) {
    if (((levels ^ was_) & (select_lines_ | column_lines_)) == 0) return;
    end_light(time_ns);
    was_ = levels;
    since_ns_ = time_ns;
}

void LedMatrix::end_light(std::uint64_t time_ns) {
    if ((was_ & select_lines_) == 0 || since_ns_ == time_ns || !sink_) return;
    for (std::uint32_t g = 0; g < groups_.size(); ++g) {
        if ((was_ & groups_[g]) == 0) continue;
        for (const Led& led : leds_) {
            rows_.set(led.panel, led.row + g, led.channel, led.column, (was_ & led.line) != 0);
        }
        Strobe strobe;
        strobe.on_ns = since_ns_;
        strobe.off_ns = time_ns;
        strobe.row_group = g;
        strobe.panels = rows_.panels();
        sink_(strobe);
    }
}

}  // namespace xorvox::sim
