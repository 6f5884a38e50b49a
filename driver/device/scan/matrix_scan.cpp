#include "driver/device/scan/matrix_scan.h"

namespace xorvox::device {

void MatrixWires::init(const Config& config, Lines lines, std::span<LineMask>) {
    config_ = &config;
    lines_ = lines;
    rows_ = 0;
    for (std::uint32_t g = 0; g < config.scan.modulation.row_groups; ++g) rows_ |= line_bit(config.pins.lines[g]);
    columns_ = config.scan.used & ~rows_;
}

Status MatrixWires::shift(const SlicePlanes& planes, std::uint32_t group, std::uint32_t plane) {
    const SliceConfig& slice = config_->scan.slice;
    const std::uint32_t groups = config_->scan.modulation.row_groups;
    const std::uint32_t channels = channel_count(slice.format);
    next_ = 0;
    std::uint32_t line = groups;  // Of the row's first LED.
    for (std::uint32_t p = 0; p < slice.panel_count; ++p) {
        for (std::uint32_t r = group; r < slice.panels[p].rows; r += groups) {
            for (std::uint32_t i = 0; i < channels; ++i) {
                const PlaneRow row = planes.row(p, r, channels == 1 ? 0 : config_->channels[i], plane);
                for (std::uint32_t c = 0; c < row.columns; ++c) {
                    if (row[c]) next_ |= line_bit(config_->pins.lines[line + c * channels + i]);
                }
            }
            line += slice.panels[p].columns * channels;
        }
    }
    return Status::Ok;
}

Status MatrixWires::latch(std::uint32_t) {
    const Status status = lines_.set(columns_, next_);
    return status == Status::Ok ? lines_.hold(config_->scan.modulation.latch_ns) : status;
}

}  // namespace xorvox::device
