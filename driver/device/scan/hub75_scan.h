// Hub75Scan: scans HUB75 panels out. pins.h draws which line is which, and where bits come to stand. In a slot, with
// M shifts of the longest chain:
//
//             ◄ fall ►◄ latch_ns ►◄─────── on ───────►
//   OE        ────────────────────┐                   ┌────   low: lit
//                                 └───────────────────┘
//   A … E     ════════╳═════════════════════════════════   the row group
//   latch     ________┌────┐____________________________   what was shifted in, to the LEDs
//   data      ────────────────────╳══╳══╳═ … ═╳══╳─────   the next slot's bits, each with the clock low
//   clock     ────────────────────┐ ┌┐ ┌┐ … ┐ ┌────────   and the same with it high: one write of 2 · M
//                                 └─┘└─┘└ …  └─┘           elements
//
// Blank: OE high; address 0, which rests on the other two steps; zeros through all chains, and latched.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>

#include "driver/device/scan/pins.h"
#include "driver/device/scan/plane_scanner.h"
#include "driver/display/description.h"

namespace xorvox::device {

struct Hub75Config {
    ScanConfig scan;
    Hub75Pins pins;
    std::array<std::uint8_t, kMaxPanels> connectors{};  ///< Of each panel.
    /// Of each panel: at which shift its data begin.
    std::array<std::uint32_t, kMaxPanels> first_shift{};
    std::array<std::uint8_t, 3> channels{0, 1, 2};  ///< That lines r, g and b carry.
};

/// Of a valid display. Unsupported are other drivers, more than 32 row groups, and responses that are not linear: those
/// panels have controllers of their own.
constexpr Hub75Config hub75_config(const DisplayDescription& display, const Hub75Pins& pins = {}) {
    Hub75Config config;
    const Scan& scan = display.scan;
    if (scan.driver != DriverChip::Hub75 || scan.row_groups > 32 || display.light.response != Response::Linear) {
        config.scan.supported = Status::Unsupported;
        return config;
    }
    config.scan.modulation = modulation_config(display);
    config.scan.slice = slice_config(display);
    config.scan.used = used_lines(display, pins);
    config.scan.pins = 3 + static_cast<std::uint32_t>(std::bit_width(scan.row_groups - 1u));
    config.pins = pins;
    // What a panel holds and the nearer ones of its chain; the longest of these is a whole chain.
    std::array<std::uint32_t, kMaxPanels> reach{};
    std::uint32_t longest = 0;
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        const Panel& panel = display.panels[p];
        for (std::uint32_t q = 0; q < display.panel_count; ++q) {
            const Panel& other = display.panels[q];
            if (other.connector != panel.connector || other.chain_position > panel.chain_position) continue;
            reach[p] += std::uint32_t{other.columns} * other.rows / 2u / scan.row_groups;
        }
        longest = std::max(longest, reach[p]);
        if (panel.chain_position == 0) config.scan.pins += 2 * channel_count(display.format);
    }
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        config.connectors[p] = display.panels[p].connector;
        config.first_shift[p] = longest - reach[p];
    }
    config.channels = channel_order(scan);
    config.scan.write_size = 2 * longest;
    return config;
}

class Hub75Wires {
public:
    using Config = Hub75Config;

    void init(const Config& config, Lines lines, std::span<LineMask> levels);
    Status shift(const SlicePlanes& planes, std::uint32_t group, std::uint32_t plane);
    Status latch(std::uint32_t group);
    Light light(std::uint32_t) const { return {line_bit(config_->pins.output_enable), 0}; }
    Status output_off();
    Status release_rows();
    Status clear_columns();

private:
    Status write();
    Status pulse_latch();
    Status address(std::uint32_t group);

    const Config* config_ = nullptr;
    Lines lines_;
    std::span<LineMask> levels_;
};

using Hub75Scan = PlaneScanner<Hub75Wires>;

}  // namespace xorvox::device
