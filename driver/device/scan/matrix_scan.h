// MatrixScan: scans LEDs out that stand between lines of row groups and lines of columns. pins.h says which is which.
// In a slot nothing is shifted; the row itself is the strobe:
//
//             ◄ fall ►◄ latch_ns ►◄─────── on ───────►
//   columns   ════════╳════════════════════════════════════
//   row group                     ┌───────────────────┐      high: selected, and lit
//             ────────────────────┘                   └────
//
// Blank: all row groups low, which is both output off and rows released; then all columns low.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "driver/device/scan/pins.h"
#include "driver/device/scan/plane_scanner.h"
#include "driver/display/description.h"

namespace xorvox::device {

struct MatrixConfig {
    ScanConfig scan;
    MatrixPins pins;
    std::array<std::uint8_t, 3> channels{0, 1, 2};  ///< Of an LED's columns, from its first on.
};

/// Of a valid display. Unsupported are other drivers, one row group (each LED has its own wire, or nothing is known),
/// more than kMaxLines lines, and responses that are not linear.
constexpr MatrixConfig matrix_config(const DisplayDescription& display, const MatrixPins& pins = {}) {
    MatrixConfig config;
    const Scan& scan = display.scan;
    if (scan.driver != DriverChip::Direct || scan.row_groups < 2 || used_lines(display, pins) == 0 ||
        display.light.response != Response::Linear) {
        config.scan.supported = Status::Unsupported;
        return config;
    }
    config.scan.modulation = modulation_config(display);
    config.scan.slice = slice_config(display);
    config.scan.used = used_lines(display, pins);
    config.scan.pins = scan.row_groups + static_cast<std::uint32_t>(matrix_columns(display));
    config.pins = pins;
    config.channels = channel_order(scan);
    return config;
}

class MatrixWires {
public:
    using Config = MatrixConfig;

    void init(const Config& config, Lines lines, std::span<LineMask> levels);
    Status shift(const SlicePlanes& planes, std::uint32_t group, std::uint32_t plane);
    Status latch(std::uint32_t group);
    Light light(std::uint32_t group) const {
        const LineMask row = line_bit(config_->pins.lines[group]);
        return {row, row};
    }
    Status output_off() { return lines_.set(rows_, 0); }
    Status release_rows() { return lines_.set(rows_, 0); }
    Status clear_columns() { return lines_.set(columns_, 0); }

private:
    const Config* config_ = nullptr;
    Lines lines_;
    LineMask rows_ = 0;
    LineMask columns_ = 0;
    LineMask next_ = 0;  ///< Levels of the columns, in the next slot.
};

using MatrixScan = PlaneScanner<MatrixWires>;

}  // namespace xorvox::device
