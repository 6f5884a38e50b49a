#include "sim/optics.h"

#include <cassert>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

namespace xorvox::sim {
namespace {

/// Pixel `column` of a row, whose bits run on without gaps, least significant first.
std::uint32_t read_code(std::span<const std::byte> row, std::size_t column, std::uint32_t bits) {
    const std::size_t first = column * bits;
    std::uint32_t word = 0;
    for (std::size_t byte = first / 8, shift = 0; byte <= (first + bits - 1) / 8; ++byte, shift += 8) {
        word |= std::to_integer<std::uint32_t>(row[byte]) << shift;
    }
    return (word >> (first % 8)) & ((1u << bits) - 1u);
}

/// Bits `low` … `low + count - 1` of `code` as a share of their largest value.
float channel(std::uint32_t code, unsigned low, unsigned count) {
    const std::uint32_t full = (1u << count) - 1u;
    return static_cast<float>((code >> low) & full) / static_cast<float>(full);
}

glm::vec3 light_of(std::uint32_t code, PixelFormat format) {
    switch (format) {
        case PixelFormat::Mono1: return glm::vec3(channel(code, 0, 1));
        case PixelFormat::Rgb111: return {channel(code, 0, 1), channel(code, 1, 1), channel(code, 2, 1)};
        case PixelFormat::Rgb332: return {channel(code, 5, 3), channel(code, 2, 3), channel(code, 0, 2)};
        case PixelFormat::Rgb565: return {channel(code, 11, 5), channel(code, 5, 6), channel(code, 0, 5)};
        case PixelFormat::Rgb888: return {channel(code, 0, 8), channel(code, 8, 8), channel(code, 16, 8)};
    }
    return glm::vec3(0.0f);
}

/// Item `index` of `count` in a line `pitch` apart whose middle is at 0.
double along(std::uint32_t index, std::uint32_t count, double pitch) {
    return (2.0 * index - (count - 1.0)) * (pitch / 2.0);
}

using Turn = std::complex<double>;

Turn turn_by(double turns) {
    return std::polar(1.0, 2.0 * std::numbers::pi * turns);
}

/// Where the display is in its cycle while slice `slice` of the page is lit.
struct Pose {
    double height_mm = 0.0;    ///< Stacked planes: of the plane.
    Turn turned = {1.0, 0.0};  ///< Rotating panel: by how much the axle has turned.
};

Pose pose_of(const DisplayDescription& display, std::uint32_t slice, const Misbuild& misbuild) {
    std::uint32_t place = slice;
    if (misbuild.swap_a >= 0 && misbuild.swap_b >= 0) {
        const auto a = static_cast<std::uint32_t>(misbuild.swap_a);
        const auto b = static_cast<std::uint32_t>(misbuild.swap_b);
        if (slice == a) place = b;
        if (slice == b) place = a;
    }
    if (display.kind == DisplayKind::StackedPlanes) {
        // A plane counter that starts late or early, and wraps.
        const std::int64_t planes = display.slices;
        const std::int64_t counted = std::int64_t{place} + misbuild.phase_slices;
        place = static_cast<std::uint32_t>((counted % planes + planes) % planes);
        return {along(place, display.slices, display.plane_pitch_mm), {1.0, 0.0}};
    }
    const double turns = (place + 0.5 + misbuild.phase_slices) / display.slices;
    return {0.0, turn_by(display.clockwise ? -turns : turns)};
}

}  // namespace

LightField expose(const DisplayDescription& display, std::span<const std::byte> page, std::uint8_t brightness,
                  const Misbuild& misbuild) {
    LightField field;
    if (page.empty()) return field;
    assert(page.size() == frame_bytes(display));
    assert(misbuild.swap_a < static_cast<std::int64_t>(display.slices));
    assert(misbuild.swap_b < static_cast<std::int64_t>(display.slices));

    const bool rotates = display.kind == DisplayKind::RotatingPanel;
    const std::uint32_t bits = bits_per_pixel(display.format);
    const float dimmed = static_cast<float>(brightness) / 255.0f;
    for (std::uint32_t slice = 0; slice < display.slices; ++slice) {
        const Pose pose = pose_of(display, slice, misbuild);
        for (std::uint32_t p = 0; p < display.panel_count; ++p) {
            const Panel& panel = display.panels[p];
            const bool mirrored = misbuild.mirrored_panel == static_cast<std::int32_t>(p);
            const Turn turned = pose.turned * turn_by(panel.angle_deg / 360.0);
            const std::size_t row_length = row_bytes(panel, display.format);
            for (std::uint32_t row = 0; row < panel.rows; ++row) {
                const std::span<const std::byte> pixels = page.first(row_length);
                page = page.subspan(row_length);
                for (std::uint32_t column = 0; column < panel.columns; ++column) {
                    const std::uint32_t code = read_code(pixels, column, bits);
                    if (code == 0) continue;
                    const std::uint32_t seat = mirrored ? panel.columns - 1 - column : column;
                    const double across = panel.shift_mm + along(seat, panel.columns, panel.column_pitch_mm);
                    const double rising = along(row, panel.rows, panel.row_pitch_mm);
                    glm::dvec3 place(across, rising, pose.height_mm);
                    if (rotates) {
                        // At rest the panel stands in the plane y = −offset and looks towards −y.
                        const Turn plan = turned * Turn(across, -panel.offset_mm);
                        place = {plan.real(), plan.imag(), panel.lift_mm - rising};
                    }
                    field.flashes.push_back({place, light_of(code, display.format) * dimmed, code, slice});
                }
            }
        }
    }
    return field;
}

}  // namespace xorvox::sim
