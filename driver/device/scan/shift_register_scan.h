// ShiftRegisterScan: scans LED cubes out whose columns and layers hang on one chain of 74HC595. pins.h draws where bits
// come to stand. A slot has M bits: those of a plane of the layer, and one for each layer, of which one is high.
//
//             ◄ fall ►◄ latch_ns ►◄─────── on ───────►
//   OE        ────────────────────┐                   ┌────   low: lit
//                                 └───────────────────┘
//   RCLK      ________┌────┐____________________________   what was shifted in, to the LEDs
//   SER       ────────────────────╳══╳══╳═ … ═╳══╳─────   the next slot's bits, each with the clock low
//   SRCLK     ────────────────────┐ ┌┐ ┌┐ … ┐ ┌────────   and the same with it high: one write of 2 · M
//                                 └─┘└─┘└ …  └─┘           elements
//
// Blank: OE high; zeros through the chain release the layers and clear the columns with one edge of RCLK, since they
// share it; once more, for the bit that was lost. With OE high a 595's outputs float: what drives the layers needs pull
// resistors to off.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "driver/device/scan/pins.h"
#include "driver/device/scan/plane_scanner.h"
#include "driver/display/description.h"

namespace xorvox::device {

struct ShiftRegisterConfig {
    ScanConfig scan;
    ShiftRegisterPins pins;
    std::uint8_t connector = 0;
    std::uint32_t layers = 0;
    bool msb_first = true;
    bool layers_first = false;
    std::array<std::uint8_t, 3> channels{0, 1, 2};  ///< Of a pixel's bits, from its first on.
};

/// Of a valid display. Unsupported are other drivers, displays that move, row groups (a layer's LEDs are lit together),
/// and responses that are not linear.
constexpr ShiftRegisterConfig shift_register_config(const DisplayDescription& display,
                                                    const ShiftRegisterPins& pins = {}) {
    ShiftRegisterConfig config;
    const Scan& scan = display.scan;
    const bool stands = display.kind == DisplayKind::StackedPlanes || display.kind == DisplayKind::FreePoints;
    if (scan.driver != DriverChip::ShiftRegister595 || !stands || scan.row_groups != 1 ||
        display.light.response != Response::Linear) {
        config.scan.supported = Status::Unsupported;
        return config;
    }
    config.scan.modulation = modulation_config(display);
    config.scan.slice = slice_config(display);
    config.scan.used = used_lines(display, pins);
    config.scan.pins = 4;
    config.pins = pins;
    config.connector = display.panels[0].connector;
    config.layers = display.slices;
    config.msb_first = scan.msb_first;
    config.layers_first = scan.layers_first;
    config.channels = channel_order(scan);
    const std::uint32_t pixels = std::uint32_t{display.panels[0].columns} * display.panels[0].rows;
    config.scan.write_size = 2 * (pixels * channel_count(display.format) + config.layers);
    return config;
}

class ShiftRegisterWires {
public:
    using Config = ShiftRegisterConfig;

    void init(const Config& config, Lines lines, std::span<LineMask> levels);
    Status shift(const SlicePlanes& planes, std::uint32_t group, std::uint32_t plane);
    Status latch(std::uint32_t group);
    Light light(std::uint32_t) const { return {line_bit(config_->pins.output_enable), 0}; }
    Status output_off();
    Status release_rows() { return clear(); }
    Status clear_columns() { return clear(); }

private:
    Status clear();
    Status write();
    /// Bit `bit` of `bits` that begin to go out at shift `first` is high.
    void raise(std::uint32_t first, std::uint32_t bits, std::uint32_t bit);

    const Config* config_ = nullptr;
    Lines lines_;
    std::span<LineMask> levels_;
};

using ShiftRegisterScan = PlaneScanner<ShiftRegisterWires>;

}  // namespace xorvox::device
