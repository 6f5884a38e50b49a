#include "driver/device/scan/shift_register_scan.h"

#include <algorithm>

namespace xorvox::device {

void ShiftRegisterWires::init(const Config& config, Lines lines, std::span<LineMask> levels) {
    config_ = &config;
    lines_ = lines;
    levels_ = levels;
}

Status ShiftRegisterWires::shift(const SlicePlanes& planes, std::uint32_t, std::uint32_t plane) {
    std::ranges::fill(levels_, 0);
    const SliceConfig& slice = config_->scan.slice;
    const std::uint32_t channels = channel_count(slice.format);
    const std::uint32_t columns = slice.panels[0].columns;
    const std::uint32_t rows = slice.panels[0].rows;
    const std::uint32_t bits = columns * rows * channels;
    const std::uint32_t first_bit = config_->layers_first ? config_->layers : 0;
    for (std::uint32_t r = 0; r < rows; ++r) {
        for (std::uint32_t i = 0; i < channels; ++i) {
            const PlaneRow row = planes.row(0, r, channels == 1 ? 0 : config_->channels[i], plane);
            for (std::uint32_t c = 0; c < columns; ++c) {
                if (row[c]) raise(first_bit, bits, (r * columns + c) * channels + i);
            }
        }
    }
    raise(config_->layers_first ? 0 : bits, config_->layers, planes.slice());
    return write();
}

Status ShiftRegisterWires::latch(std::uint32_t) {
    return pulse_latch(lines_, line_bit(config_->pins.latch), config_->scan.modulation.latch_ns);
}

Status ShiftRegisterWires::output_off() {
    const LineMask oe = line_bit(config_->pins.output_enable);
    return lines_.set(oe | line_bit(config_->pins.latch), oe);  // A pulse of the latch may have been cut.
}

Status ShiftRegisterWires::clear() {
    std::ranges::fill(levels_, 0);
    const Status status = write();
    return status == Status::Ok ? latch(0) : status;
}

/// Every other element is data; the ones between get the same with the clock.
Status ShiftRegisterWires::write() {
    const LineMask clock = line_bit(config_->pins.clock);
    for (std::size_t i = 0; i < levels_.size(); i += 2) levels_[i + 1] = levels_[i] | clock;
    return lines_.write(clock | line_bit(config_->pins.data[config_->connector]), levels_);
}

void ShiftRegisterWires::raise(std::uint32_t first, std::uint32_t bits, std::uint32_t bit) {
    const std::uint32_t at = first + (config_->msb_first ? bits - 1 - bit : bit);
    levels_[2 * std::size_t{at}] = line_bit(config_->pins.data[config_->connector]);
}

}  // namespace xorvox::device
