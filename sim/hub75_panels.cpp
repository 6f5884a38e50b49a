#include "sim/hub75_panels.h"

#include <algorithm>
#include <bit>
#include <string_view>
#include <utility>

namespace xorvox::sim {
namespace {

/// Stages that `panel` has in each register.
std::size_t stages_of(const Panel& panel, std::uint32_t row_groups) {
    return std::size_t{panel.columns} * (panel.rows / 2u / row_groups);
}

std::size_t longest_chain(const DisplayDescription& display) {
    std::array<std::size_t, kMaxPanels> stages{};
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        stages[display.panels[p].connector] += stages_of(display.panels[p], display.scan.row_groups);
    }
    return *std::ranges::max_element(stages);
}

/// Line number `line` in eight words, that in the first one lowest.
std::byte eight_bits(const LineMask* words, std::uint32_t line) {
    std::uint32_t byte = 0;
    for (std::uint32_t i = 0; i < 8; ++i) byte |= static_cast<std::uint32_t>(words[i] >> line & 1u) << i;
    return static_cast<std::byte>(byte);
}

}  // namespace

Hub75Panels::Hub75Panels(const DisplayDescription& display, const device::Hub75Pins& pins, StrobeSink sink)
    : display_(display),
      sink_(std::move(sink)),
      clock_(line(pins.clock)),
      latch_(line(pins.latch)),
      output_enable_(line(pins.output_enable)),
      registers_(longest_chain(display)),
      drivers_(registers_.stages()),
      lit_bits_(registers_.stages()),
      rows_(display) {
    const auto address_lines = static_cast<std::size_t>(std::bit_width(display.scan.row_groups - 1u));
    for (std::size_t i = 0; i < address_lines; ++i) address_.push_back(line(pins.address[i]));
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        const Panel& panel = display.panels[p];
        std::size_t before = 0;
        for (std::uint32_t q = 0; q < display.panel_count; ++q) {
            const Panel& other = display.panels[q];
            if (other.connector == panel.connector && other.chain_position < panel.chain_position) {
                before += stages_of(other, display.scan.row_groups);
            }
        }
        wire(p, pins, before);
    }
}

void Hub75Panels::wire(std::uint32_t p, const device::Hub75Pins& pins, std::size_t stages_before) {
    const Panel& panel = display_.panels[p];
    const std::uint32_t groups = display_.scan.row_groups;
    const std::uint32_t half = panel.rows / 2u;
    const std::uint32_t together = half / groups;
    constexpr std::string_view kChannels = "rgb";
    for (std::uint32_t lower = 0; lower < 2; ++lower) {
        std::array<LineMask, 3> lines{};
        for (std::uint32_t i = 0; i < channel_count(display_.format); ++i) {
            lines[kChannels.find(display_.scan.color_order[i])] = line(pins.data[panel.connector][3 * lower + i]);
            colors_ |= line(pins.data[panel.connector][3 * lower + i]);
        }
        for (std::uint32_t i = 0; i < together; ++i) {
            const std::size_t from_end = stages_before + std::size_t{panel.columns} * (together - i);
            runs_.push_back({from_end, lines, p, lower * half + i * groups, panel.columns});
        }
    }
}

std::uint32_t Hub75Panels::address(LineMask levels) const {
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < address_.size(); ++i) {
        if ((levels & address_[i]) != 0) number |= 1u << i;
    }
    return number;
}

void Hub75Panels::on_pins(std::uint64_t time_ns, LineMask levels, LineMask changed) {
    const LineMask was = started_ ? levels ^ changed : levels;
    started_ = true;
    const bool clocked = (levels & ~was & clock_) != 0;
    const bool through = (levels & latch_) != 0;
    if (clocked) registers_.shift(was);
    const bool taken = through ? clocked || (was & latch_) == 0 : false;
    if (taken) std::ranges::copy(registers_.oldest_first(), drivers_.begin());

    const std::uint32_t group = address(levels);
    const bool lights = (levels & output_enable_) == 0 && group < display_.scan.row_groups;
    if (lit_ && lights && lit_->group == group) {
        const auto same = [this](LineMask a, LineMask b) { return ((a ^ b) & colors_) == 0; };
        if (!taken || std::ranges::equal(drivers_, lit_bits_, same)) return;
    }
    if (lit_) end_light(time_ns);
    if (lights) light(time_ns, group);
}

void Hub75Panels::light(std::uint64_t time_ns, std::uint32_t group) {
    lit_ = Lit{time_ns, group};
    std::ranges::copy(drivers_, lit_bits_.begin());
}

void Hub75Panels::end_light(std::uint64_t time_ns) {
    const Lit lit = *std::exchange(lit_, std::nullopt);
    if (lit.since_ns == time_ns || !sink_) return;
    for (const Run& run : runs_) decode(run, lit.group);
    Strobe strobe;
    strobe.on_ns = lit.since_ns;
    strobe.off_ns = time_ns;
    strobe.row_group = lit.group;
    strobe.panels = rows_.panels();
    sink_(strobe);
}

void Hub75Panels::decode(const Run& run, std::uint32_t group) {
    const LineMask* bits = lit_bits_.data() + (lit_bits_.size() - run.from_end);
    for (std::uint32_t channel = 0; channel < channel_count(display_.format); ++channel) {
        const auto from = static_cast<std::uint32_t>(std::countr_zero(run.lines[channel]));
        std::byte* row = rows_.row(run.panel, run.row + group, channel);
        std::uint32_t column = 0;
        for (; column + 8 <= run.columns; column += 8) row[column / 8] = eight_bits(bits + column, from);
        for (; column < run.columns; ++column) {
            rows_.set(run.panel, run.row + group, channel, column, (bits[column] & run.lines[channel]) != 0);
        }
    }
}

}  // namespace xorvox::sim
