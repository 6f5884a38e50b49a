// SlicePlanes: the bit planes of one slice, panel after panel, as scanners take them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "driver/device/bit_planes.h"
#include "driver/device/scan_order.h"
#include "driver/display/description.h"
#include "voxelizer/status.h"

namespace xorvox::device {

struct SliceConfig {
    struct PanelSize {
        std::uint16_t columns = 0;
        std::uint16_t rows = 0;
    };
    PixelFormat format = PixelFormat::Mono1;
    std::uint32_t shown = 1;  ///< Bits a channel.
    std::uint32_t panel_count = 1;
    std::array<PanelSize, kMaxPanels> panels{};

    constexpr BitPlaneLayout layout(std::uint32_t panel) const {
        return {format, panels[panel].columns, panels[panel].rows, shown};
    }
    constexpr std::size_t pixel_bytes() const {
        std::size_t bytes = 0;
        for (std::uint32_t p = 0; p < panel_count; ++p) bytes += layout(p).pixel_bytes();
        return bytes;
    }
    constexpr std::size_t plane_bytes() const {
        std::size_t bytes = 0;
        for (std::uint32_t p = 0; p < panel_count; ++p) bytes += layout(p).bytes();
        return bytes;
    }
};

constexpr SliceConfig slice_config(const DisplayDescription& display) {
    SliceConfig config;
    config.format = display.format;
    config.shown = shown_bit_planes(display);
    config.panel_count = display.panel_count;
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        config.panels[p] = {display.panels[p].columns, display.panels[p].rows};
    }
    return config;
}

/// The channels as Scan::color_order names them: 0 red, 1 green, 2 blue.
constexpr std::array<std::uint8_t, 3> channel_order(const Scan& scan) {
    std::array<std::uint8_t, 3> order{};
    for (std::size_t i = 0; i < 3; ++i) {
        const char name = scan.color_order[i];
        order[i] = static_cast<std::uint8_t>(name == 'r' ? 0 : name == 'g' ? 1 : 2);
    }
    return order;
}

/// A row of LEDs as mounted, one bit each.
struct PlaneRow {
    const std::byte* bits = nullptr;
    std::uint32_t columns = 0;
    bool mirrored = false;  ///< The last column's bit comes first.

    bool operator[](std::uint32_t column) const {
        const std::uint32_t at = mirrored ? columns - 1 - column : column;
        return (std::to_integer<unsigned>(bits[at / 8]) >> (at % 8) & 1u) != 0;
    }
};

class SlicePlanes {
public:
    /// `buffer`, of plane_bytes(), is borrowed for good.
    void init(const SliceConfig& config, std::span<std::byte> buffer);

    /// Takes the slice of an order apart; its bytes are not needed afterwards. Ok, or InvalidArgument: too few of them.
    Status split(const ScanOrder& order);

    std::uint32_t slice() const { return slice_; }

    /// Plane `plane` of a channel, 0 the most significant. A channel that has n planes, fewer than that, shows its
    /// plane `plane` mod n.
    PlaneRow row(std::uint32_t panel, std::uint32_t row, std::uint32_t channel, std::uint32_t plane) const {
        const BitPlaneLayout& layout = layouts_[panel];
        const std::size_t at = first_[panel] + layout.offset(row, channel, plane % layout.channel_planes(channel));
        return {buffer_.data() + at, layout.columns, mirrored_};
    }

private:
    std::span<std::byte> buffer_;
    std::uint32_t panel_count_ = 0;
    std::array<BitPlaneLayout, kMaxPanels> layouts_{};
    std::array<std::size_t, kMaxPanels> first_{};
    std::uint32_t slice_ = 0;
    bool mirrored_ = false;
};

}  // namespace xorvox::device
