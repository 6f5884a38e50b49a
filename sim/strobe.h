// Strobe: light that is switched on and off again. All light of a display in time is a list of strobes; what made them
// (sim/strobe_scan.h from orders, sim/edge_scan.h from pins) and what looks at them (exposure, statistics) meet here.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "driver/display/description.h"

namespace xorvox::sim {

/// Where the bits of each row are, of one panel.
struct StrobeRows {
    const std::byte* first = nullptr;            ///< Of row 0, channel 0.
    std::size_t row_bytes = 0;                   ///< From row to row.
    std::array<std::size_t, 3> channel_bytes{};  ///< From the first channel to each.

    const std::byte* at(std::uint32_t row, std::uint32_t channel) const {
        return first + row * row_bytes + channel_bytes[channel];
    }
};

/// Rows of LEDs, or all of them, that are lit together, from one moment to another.
struct Strobe {
    static constexpr std::uint32_t kLevels = 0xffffffff;
    static constexpr std::uint32_t kAllRows = 0xffffffff;

    std::uint64_t on_ns = 0;   ///< When its output was enabled,
    std::uint64_t off_ns = 0;  ///< and disabled; later.

    /// Rows r of every panel with r mod row_groups = this; or kAllRows.
    std::uint32_t row_group = 0;
    /// Which bits: the plane of each channel, 0 the most significant one that is shown. A channel
    /// that has n planes, fewer than the others, repeats them: it shows its plane p mod n. Or kLevels: the LEDs or the
    /// projector make levels of codes themselves.
    std::uint32_t plane = 0;
    /// The slice that the device meant: of a stack the layer that is selected. Where the light is of a display that
    /// moves follows from the time.
    std::uint32_t slice = 0;
    std::uint32_t frame = 0;        ///< That the device showed.
    std::uint8_t brightness = 255;  ///< Of kLevels alone: that of planes is in their length.

    /// Of each panel. Of a plane: LED `column` as mounted (columns of a mirrored slice were turned around by the
    /// scanner) is bit column % 8 of byte column / 8, as in driver/device/bit_planes.h. Of kLevels: the row as on the
    /// wire, channel 0 alone. Borrowed for the call.
    std::array<StrobeRows, kMaxPanels> panels{};
    bool mirrored = false;  ///< Of kLevels alone: columns run from the last to the first.
};

/// Is given strobes in the order of their beginnings, each when it has ended.
using StrobeSink = std::function<void(const Strobe&)>;

/// Light that an LED gives in a strobe of `lit_ns`, in nanoseconds of full light: it climbs to full light within
/// rise_ns of the display's scan and falls within fall_ns, both in a straight line.
constexpr double emitted_ns(const Scan& scan, std::uint64_t lit_ns) {
    const auto lit = static_cast<double>(lit_ns);
    const double rise = scan.rise_ns;
    const double fall = scan.fall_ns;
    if (lit >= rise) return lit - rise / 2.0 + fall / 2.0;
    const double peak = lit / rise;
    return peak * (lit + peak * fall) / 2.0;
}

}  // namespace xorvox::sim
