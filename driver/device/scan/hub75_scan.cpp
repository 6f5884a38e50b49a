#include "driver/device/scan/hub75_scan.h"

namespace xorvox::device {

void Hub75Wires::init(const Config& config, Lines lines, std::span<LineMask> levels) {
    config_ = &config;
    lines_ = lines;
    levels_ = levels;
}

Status Hub75Wires::shift(const SlicePlanes& planes, std::uint32_t group, std::uint32_t plane) {
    std::ranges::fill(levels_, 0);
    const SliceConfig& slice = config_->scan.slice;
    const std::uint32_t groups = config_->scan.modulation.row_groups;
    const std::uint32_t channels = channel_count(slice.format);
    for (std::uint32_t p = 0; p < slice.panel_count; ++p) {
        const std::uint32_t half = slice.panels[p].rows / 2u;
        const std::uint32_t columns = slice.panels[p].columns;
        const auto& data = config_->pins.data[config_->connectors[p]];
        for (std::uint32_t i = 0; i < 2 * channels; ++i) {
            const std::uint32_t lower = i / channels;
            const std::uint32_t line = i % channels;
            const LineMask lit = line_bit(data[3 * lower + line]);
            const std::uint32_t channel = channels == 1 ? 0 : config_->channels[line];
            LineMask* out = levels_.data() + 2 * config_->first_shift[p];
            for (std::uint32_t r = group; r < half; r += groups) {
                const PlaneRow row = planes.row(p, lower * half + r, channel, plane);
                for (std::uint32_t c = 0; c < columns; ++c, out += 2) {
                    *out |= -LineMask{row[c]} & lit;  // No branch: bits of pictures cannot be foreseen.
                }
            }
        }
    }
    return write();
}

Status Hub75Wires::latch(std::uint32_t group) {
    const Status status = address(group);
    return status == Status::Ok ? pulse_latch() : status;
}

Status Hub75Wires::output_off() {
    const LineMask oe = line_bit(config_->pins.output_enable);
    return lines_.set(oe | line_bit(config_->pins.latch), oe);  // A pulse of the latch may have been cut.
}

Status Hub75Wires::release_rows() {
    return address(0);
}

Status Hub75Wires::clear_columns() {
    std::ranges::fill(levels_, 0);
    const Status status = write();
    return status == Status::Ok ? pulse_latch() : status;
}

/// Every other element is data; the ones between get the same with the clock.
Status Hub75Wires::write() {
    const LineMask clock = line_bit(config_->pins.clock);
    for (std::size_t i = 0; i < levels_.size(); i += 2) levels_[i + 1] = levels_[i] | clock;
    LineMask others = line_bit(config_->pins.latch) | line_bit(config_->pins.output_enable);
    for (const std::uint8_t line : config_->pins.address) others |= line_bit(line);
    return lines_.write(config_->scan.used & ~others, levels_);
}

Status Hub75Wires::pulse_latch() {
    return device::pulse_latch(lines_, line_bit(config_->pins.latch), config_->scan.modulation.latch_ns);
}

Status Hub75Wires::address(std::uint32_t group) {
    LineMask mask = 0;
    LineMask levels = 0;
    for (std::uint32_t i = 0; i < config_->pins.address.size(); ++i) {
        const LineMask bit = line_bit(config_->pins.address[i]) & config_->scan.used;
        mask |= bit;
        if ((group >> i & 1u) != 0) levels |= bit;
    }
    return lines_.set(mask, levels);
}

}  // namespace xorvox::device
