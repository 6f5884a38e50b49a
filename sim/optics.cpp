#include "sim/optics.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstring>
#include <numbers>
#include <optional>

namespace xorvox::sim {
namespace {

/// Heights within this part of a helix's stroke below its top are at its foot: there the screen's edge passes exactly
/// over the pixel, which rounding must not decide.
constexpr double kEdge = 1e-9;

/// The eight bytes of `row` from `first` on, the first one lowest; what lies beyond the row is zero.
std::uint64_t read_word(std::span<const std::byte> row, std::size_t first) {
    std::uint64_t word = 0;
    if (first + 8 <= row.size()) {
        if constexpr (std::endian::native == std::endian::little) {
            std::memcpy(&word, row.data() + first, 8);
            return word;
        }
    }
    for (std::size_t i = first; i < std::min(first + 8, row.size()); ++i) {
        word |= std::to_integer<std::uint64_t>(row[i]) << (8 * (i - first));
    }
    return word;
}

/// Calls lit(column, code) for every pixel of a row that is not zero, `bits` each. Goes from set bit to set bit.
template <class Lit>
void for_each_lit(std::span<const std::byte> row, std::uint32_t columns, std::uint32_t bits, const Lit& lit) {
    const std::size_t end = std::size_t{columns} * bits;
    for (std::size_t at = 0; at < end;) {
        const std::uint64_t ahead = read_word(row, at / 8) >> (at % 8);
        if (ahead == 0) {
            at = (at / 8 + 8) * 8;
            continue;
        }
        const std::size_t column = (at + static_cast<std::size_t>(std::countr_zero(ahead))) / bits;
        if (column >= columns) return;
        const std::size_t first = column * bits;
        const auto code = static_cast<std::uint32_t>(read_word(row, first / 8) >> (first % 8)) & ((1u << bits) - 1u);
        lit(static_cast<std::uint32_t>(column), code);
        at = first + bits;
    }
}

/// Calls visit(slice, panel, row, pixels) for every row of `page`, in scan-out order.
template <class Visit>
void for_each_row(const DisplayDescription& display, std::span<const std::byte> page, const Visit& visit) {
    for (std::uint32_t slice = 0; slice < display.slices; ++slice) {
        for (std::uint32_t p = 0; p < display.panel_count; ++p) {
            const std::size_t length = row_bytes(display.panels[p], display.format);
            for (std::uint32_t row = 0; row < display.panels[p].rows; ++row) {
                visit(slice, p, row, page.first(length));
                page = page.subspan(length);
            }
        }
    }
}

/// Bits `low` … `low + count - 1` of `code` as a share of their largest value.
float channel(std::uint32_t code, unsigned low, unsigned count) {
    const std::uint32_t full = (1u << count) - 1u;
    return static_cast<float>((code >> low) & full) / static_cast<float>(full);
}

/// Item `index` of `count` in a line `pitch` apart whose middle is at 0.
double along(std::uint32_t index, std::uint32_t count, double pitch) {
    return (2.0 * index - (count - 1.0)) * (pitch / 2.0);
}

using Turn = std::complex<double>;

Turn turn_by(double turns) {
    return std::polar(1.0, 2.0 * std::numbers::pi * turns);
}

/// Item `index` of `count` after a misbuild has swapped two of them.
std::uint32_t swapped(std::uint32_t index, const Misbuild& misbuild) {
    if (misbuild.swap_a < 0 || misbuild.swap_b < 0) return index;
    const auto a = static_cast<std::uint32_t>(misbuild.swap_a);
    const auto b = static_cast<std::uint32_t>(misbuild.swap_b);
    return index == a ? b : index == b ? a : index;
}

/// A counter that starts late or early, and wraps.
std::uint32_t counted(std::uint32_t index, std::uint32_t count, const Misbuild& misbuild) {
    const std::int64_t late = (std::int64_t{swapped(index, misbuild)} + misbuild.phase_slices) % count;
    return static_cast<std::uint32_t>(late < 0 ? late + count : late);
}

/// Height as a part of the stroke, at `part` of the time of an upward sweep; before and after it the plane is on its
/// way down, the mirror image of its way up.
double profile_height(const Motion& motion, double part) {
    part = std::abs(std::remainder(part, 2.0));
    switch (motion.profile) {
        case MotionProfile::Constant: return part;
        case MotionProfile::Sine: {
            const double sine = std::sin(std::numbers::pi / 2.0 * part);
            return sine * sine;
        }
        case MotionProfile::Table: {
            const double steps = part * (motion.table_size - 1.0);
            const double below = std::clamp(std::floor(steps), 0.0, motion.table_size - 2.0);
            const auto knot = static_cast<std::size_t>(below);
            return std::lerp(motion.table[knot], motion.table[knot + 1], steps - below);
        }
    }
    return 0.0;
}

double stack_height_mm(const DisplayDescription& display, double slice) {
    const std::span<const double> heights = display.plane_heights_mm;
    if (heights.size() < 2) {
        const double middle = heights.empty() ? 0.0 : heights[0];
        return middle + (2.0 * slice - (display.slices - 1.0)) * (display.plane_pitch_mm / 2.0);
    }
    const double last = static_cast<double>(heights.size()) - 2.0;
    const double below = std::clamp(std::floor(slice), 0.0, last);
    const auto plane = static_cast<std::size_t>(below);
    return std::lerp(heights[plane], heights[plane + 1], slice - below);
}

/// The pixels of one panel in one slice, as places in the world.
class Seats {
public:
    Seats(const DisplayDescription& display, std::uint32_t panel, std::uint32_t slice, const Misbuild& misbuild)
        : display_(display),
          panel_(display.panels[panel]),
          misbuild_(misbuild),
          reversed_(misbuild.mirrored_panel == static_cast<std::int32_t>(panel)),
          on_side_(turn_by(panel_.turned / 4.0)),
          tilt_(turn_by(panel_.tilt_deg / 360.0)) {
        const double late = swapped(slice, misbuild) + static_cast<double>(misbuild.phase_slices);
        switch (display.kind) {
            case DisplayKind::StackedPlanes:
                height_mm_ = plane_height_mm(display, counted(slice, display.slices, misbuild));
                break;
            case DisplayKind::SweptPlane: height_mm_ = plane_height_mm(display, late); break;
            case DisplayKind::RotatingPanel: {
                const double turns = (late + 0.5) / display.slices * (display.sweep_deg / 360.0);
                turned_ = turn_by(display.clockwise ? -turns : turns) * turn_by(panel_.angle_deg / 360.0);
                break;
            }
            case DisplayKind::Helix: phase_ = (display.clockwise ? late + 0.5 : -late - 0.5) / display.slices; break;
            case DisplayKind::FreePoints: break;
        }
    }

    glm::dvec3 place_mm(std::uint32_t row, std::uint32_t wired) const {
        const std::uint32_t column = reversed_ ? panel_.columns - 1u - wired : wired;
        const double across = along(column, panel_.columns, panel_.column_pitch_mm);
        const double rising = along(row, panel_.rows, panel_.row_pitch_mm);
        switch (display_.kind) {
            case DisplayKind::StackedPlanes:
            case DisplayKind::SweptPlane: return {across, rising, height_mm_};
            case DisplayKind::RotatingPanel: return rotor_place(column, across, -rising);
            case DisplayKind::Helix: return {across, rising, screen_height(Turn(across, rising))};
            case DisplayKind::FreePoints: break;
        }
        const auto count = static_cast<std::uint32_t>(display_.points.size());
        const PointMm& point = display_.points[counted(row * panel_.columns + column, count, misbuild_)];
        return {point.x, point.y, point.z};
    }

private:
    glm::dvec3 rotor_place(std::uint32_t column, double across, double upwards) const {
        const Turn face = Turn(panel_.mirrored ? -across : across, upwards) * on_side_;
        // Seen from the side, upwards along the real axis and towards who looks along the imaginary one.
        const Turn side = face.imag() * tilt_;
        const double skew = column % 2 == 1 ? panel_.skew_mm : 0.0;
        // At rest the panel stands in the plane y = −offset and looks towards −y.
        const Turn plan = turned_ * Turn(panel_.shift_mm + face.real(), -(panel_.offset_mm + skew + side.imag()));
        return {plan.real(), plan.imag(), panel_.lift_mm + side.real()};
    }

    double screen_height(const Turn& place) const {
        const double blades = std::arg(place) * display_.blades / (2.0 * std::numbers::pi) + phase_;
        return display_.motion.stroke_mm * (blades - std::floor(blades + kEdge) - 0.5);
    }

    const DisplayDescription& display_;
    const Panel& panel_;
    const Misbuild& misbuild_;
    bool reversed_;
    Turn on_side_;
    Turn tilt_;
    Turn turned_{1.0, 0.0};   ///< Rotating panel: by how much it has turned about the axis.
    double height_mm_ = 0.0;  ///< Of the plane.
    double phase_ = 0.0;      ///< Helix: of the screen, in blades.
};

}  // namespace

glm::vec3 LightField::light(const Flash& flash) const {
    const std::uint32_t code = flash.code;
    const auto color = [&]() -> glm::vec3 {
        switch (format) {
            case PixelFormat::Mono1: return glm::vec3(channel(code, 0, 1));
            case PixelFormat::Mono2: return glm::vec3(channel(code, 0, 2));
            case PixelFormat::Mono4: return glm::vec3(channel(code, 0, 4));
            case PixelFormat::Rgb111: return {channel(code, 0, 1), channel(code, 1, 1), channel(code, 2, 1)};
            case PixelFormat::Rgb332: return {channel(code, 5, 3), channel(code, 2, 3), channel(code, 0, 2)};
            case PixelFormat::Rgb555: return {channel(code, 10, 5), channel(code, 5, 5), channel(code, 0, 5)};
            case PixelFormat::Rgb565: return {channel(code, 11, 5), channel(code, 5, 6), channel(code, 0, 5)};
            case PixelFormat::Rgb888: return {channel(code, 0, 8), channel(code, 8, 8), channel(code, 16, 8)};
        }
        return glm::vec3(0.0f);
    };
    return color() * (static_cast<float>(brightness) / 255.0f);
}

double plane_height_mm(const DisplayDescription& display, double slice) {
    if (display.kind == DisplayKind::StackedPlanes) return stack_height_mm(display, slice);
    const Motion& motion = display.motion;
    const double part = std::lerp(motion.dead_zone, 1.0 - motion.dead_zone, (slice + 0.5) / display.slices);
    return motion.stroke_mm * profile_height(motion, part) - motion.stroke_mm / 2.0;
}

std::size_t count_lit(const DisplayDescription& display, std::span<const std::byte> page) {
    if (page.empty()) return 0;
    const std::uint32_t bits = bits_per_pixel(display.format);
    std::size_t count = 0;
    for_each_row(display, page, [&](std::uint32_t, std::uint32_t p, std::uint32_t, std::span<const std::byte> row) {
        for_each_lit(row, display.panels[p].columns, bits, [&](std::uint32_t, std::uint32_t) { ++count; });
    });
    return count;
}

LightField expose(const DisplayDescription& display, std::span<const std::byte> page, std::uint8_t brightness,
                  const Misbuild& misbuild) {
    LightField field{display.format, brightness, {}};
    if (page.empty()) return field;
    assert(page.size() == frame_bytes(display));
    assert(std::max(misbuild.swap_a, misbuild.swap_b) < static_cast<std::int64_t>(frame_pixels(display)));

    const std::uint32_t bits = bits_per_pixel(display.format);
    field.flashes.reserve(count_lit(display, page));
    std::optional<Seats> seats;
    for_each_row(
        display, page, [&](std::uint32_t slice, std::uint32_t p, std::uint32_t row, std::span<const std::byte> pixels) {
            if (row == 0) seats.emplace(display, p, slice, misbuild);
            for_each_lit(pixels, display.panels[p].columns, bits, [&](std::uint32_t column, std::uint32_t code) {
                field.flashes.push_back({seats->place_mm(row, column), code, slice});
            });
        });
    return field;
}

}  // namespace xorvox::sim
