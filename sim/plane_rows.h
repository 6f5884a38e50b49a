// PlaneRows: room for one bit plane of every row of every panel, as strobes lend it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "driver/display/description.h"
#include "sim/strobe.h"

namespace xorvox::sim {

class PlaneRows {
public:
    /// Of a valid display; all zero.
    explicit PlaneRows(const DisplayDescription& display) {
        const std::uint32_t channels = channel_count(display.format);
        std::array<std::size_t, kMaxPanels> begins{};
        std::size_t bytes = 0;
        for (std::uint32_t p = 0; p < display.panel_count; ++p) {
            const Panel& panel = display.panels[p];
            const std::size_t plane_bytes = (std::size_t{panel.columns} + 7) / 8;
            panels_[p].row_bytes = channels * plane_bytes;
            for (std::uint32_t c = 0; c < channels; ++c) panels_[p].channel_bytes[c] = c * plane_bytes;
            begins[p] = bytes;
            bytes += panels_[p].row_bytes * panel.rows;
        }
        bytes_.resize(bytes);
        for (std::uint32_t p = 0; p < display.panel_count; ++p) panels_[p].first = bytes_.data() + begins[p];
    }
    PlaneRows(const PlaneRows&) = delete;
    PlaneRows& operator=(const PlaneRows&) = delete;

    /// The bits of a row, for writing.
    std::byte* row(std::uint32_t panel, std::uint32_t row, std::uint32_t channel) {
        return bytes_.data() + (panels_[panel].at(row, channel) - bytes_.data());
    }
    void set(std::uint32_t panel, std::uint32_t row, std::uint32_t channel, std::uint32_t column, bool lit) {
        std::byte& byte = this->row(panel, row, channel)[column / 8];
        const std::byte bit = std::byte{1} << (column % 8);
        byte = lit ? byte | bit : byte & ~bit;
    }

    const std::array<StrobeRows, kMaxPanels>& panels() const { return panels_; }

private:
    std::vector<std::byte> bytes_;
    std::array<StrobeRows, kMaxPanels> panels_{};
};

}  // namespace xorvox::sim
