#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstring>
#include <span>
#include <utility>

#include "driver/device/bit_planes.h"
#include "driver/device/scan/modulation.h"
#include "sim/level_scan.h"
#include "sim/light_times.h"
#include "sim/scan_out.h"

namespace xorvox::sim {
namespace {

constexpr std::array<std::uint8_t, 256> kTurnedAround = [] {
    std::array<std::uint8_t, 256> turned{};
    for (unsigned byte = 0; byte < 256; ++byte) {
        for (unsigned bit = 0; bit < 8; ++bit) {
            turned[byte] = static_cast<std::uint8_t>(turned[byte] | ((byte >> bit & 1u) << (7 - bit)));
        }
    }
    return turned;
}();

/// Bit `columns` − 1 of a plane becomes bit 0.
void turn_around(std::span<std::byte> plane, std::uint32_t columns) {
    std::ranges::reverse(plane);
    for (std::byte& byte : plane) byte = std::byte{kTurnedAround[std::to_integer<std::size_t>(byte)]};
    const auto spare = static_cast<unsigned>(8 * plane.size() - columns);
    if (spare == 0) return;
    for (std::size_t i = 0; i < plane.size(); ++i) {
        const std::byte above = i + 1 < plane.size() ? plane[i + 1] << (8 - spare) : std::byte{0};
        plane[i] = plane[i] >> spare | above;
    }
}

/// Groups of rows and bit planes, one after the other.
class PlaneScan final : public ScanOut {
public:
    PlaneScan(const DisplayDescription& display, StrobeSink sink)
        : config_(device::modulation_config(display)),
          panel_count_(display.panel_count),
          slice_bytes_(slice_bytes(display)),
          sink_(std::move(sink)) {
        for (std::uint32_t p = 0; p < panel_count_; ++p) {
            layouts_[p] = {.format = display.format,
                           .columns = display.panels[p].columns,
                           .rows = display.panels[p].rows,
                           .shown = shown_bit_planes(display)};
            planes_[p].resize(layouts_[p].bytes());
        }
    }

    void run_until(std::uint64_t now_ns) override {
        while (group_ < slots_.row_groups) {
            const std::uint64_t off_ns = slot_ns_ + slots_.on_ns(plane_, strobe_.brightness);
            if (off_ns > now_ns) return;
            give(off_ns);
            slot_ns_ += slots_.slot_ns(plane_);
            if (++plane_ == slots_.planes) {
                plane_ = 0;
                ++group_;
            }
        }
    }

    void begin(const device::ScanOrder& order, std::uint32_t frame, std::uint64_t now_ns) override {
        run_until(now_ns);
        if (group_ < slots_.row_groups && slot_ns_ < now_ns) give(now_ns);
        group_ = slots_.row_groups;
        if (!order.lit()) return;

        assert(order.bytes.size() == slice_bytes_);
        split(order);
        slots_ = device::modulate(config_, order.end_ns > now_ns ? order.end_ns - now_ns : 0);
        slot_ns_ = now_ns + slots_.first_ns();
        group_ = 0;
        plane_ = 0;
        strobe_.slice = order.slice;
        strobe_.frame = frame;
        strobe_.brightness = order.brightness;
    }

private:
    void split(const device::ScanOrder& order) {
        std::span<const std::byte> rest = order.bytes;
        for (std::uint32_t p = 0; p < panel_count_; ++p) {
            const device::BitPlaneLayout& layout = layouts_[p];
            [[maybe_unused]] const Status status = device::split_bit_planes(layout, rest, planes_[p]);
            assert(status == Status::Ok);
            rest = rest.subspan(layout.pixel_bytes());
            if (!order.mirrored) continue;
            const std::size_t size = layout.plane_bytes();
            for (std::size_t at = 0; at < planes_[p].size(); at += size) {
                turn_around(std::span(planes_[p]).subspan(at, size), layout.columns);
            }
        }
    }

    void give(std::uint64_t off_ns) {
        if (off_ns == slot_ns_) return;
        Strobe strobe = strobe_;
        strobe.brightness = 255;
        strobe.on_ns = slot_ns_;
        strobe.off_ns = off_ns;
        strobe.row_group = group_;
        strobe.plane = plane_;
        for (std::uint32_t p = 0; p < panel_count_; ++p) {
            const device::BitPlaneLayout& layout = layouts_[p];
            StrobeRows& rows = strobe.panels[p];
            rows.row_bytes = layout.row_planes() * layout.plane_bytes();
            std::array<std::size_t, 3> offsets{};
            for (std::uint32_t c = 0; c < 3 && layout.channel_planes(c) > 0; ++c) {
                offsets[c] = layout.offset(0, c, plane_ % layout.channel_planes(c));
                rows.channel_bytes[c] = offsets[c] - offsets[0];
            }
            rows.first = planes_[p].data() + offsets[0];
        }
        sink_(strobe);
    }

    device::ModulationConfig config_;
    std::uint32_t panel_count_;
    std::size_t slice_bytes_;
    StrobeSink sink_;
    std::array<device::BitPlaneLayout, kMaxPanels> layouts_{};
    std::array<std::vector<std::byte>, kMaxPanels> planes_;

    device::Modulation slots_{.row_groups = 0};
    std::uint32_t group_ = 0;  ///< Of the slot that is or will be lit; row_groups: none.
    std::uint32_t plane_ = 0;
    std::uint64_t slot_ns_ = 0;  ///< When its light begins.
    Strobe strobe_;              ///< What all strobes of the order have; its brightness.
};

}  // namespace

std::unique_ptr<ScanOut> make_strobe_scan(const DisplayDescription& display, StrobeSink sink) {
    if (lit_by_planes(display)) return std::make_unique<PlaneScan>(display, std::move(sink));
    return make_level_scan(display, std::move(sink));
}

}  // namespace xorvox::sim
