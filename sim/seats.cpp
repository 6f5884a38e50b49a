#include "sim/seats.h"

#include <cmath>
#include <complex>
#include <numbers>

namespace xorvox::sim {
namespace {

/// Heights within this part of a helix's stroke below its top are at its foot: there the screen's edge passes exactly
/// over the pixel, which rounding must not decide.
constexpr double kEdge = 1e-9;

/// Item `index` of `count` in a line `pitch` apart whose middle is at 0.
double along(std::uint32_t index, std::uint32_t count, double pitch) {
    return (2.0 * index - (count - 1.0)) * (pitch / 2.0);
}

std::complex<double> turn_by(double turns) {
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

}  // namespace

Seats::Seats(const DisplayDescription& display, std::uint32_t panel, std::uint32_t slice, const Misbuild& misbuild)
    : Seats(display, panel, swapped(slice, misbuild) + 0.5, misbuild) {}

Seats::Seats(const DisplayDescription& display, std::uint32_t panel, double at, const Misbuild& misbuild)
    : display_(display),
      panel_(display.panels[panel]),
      misbuild_(misbuild),
      reversed_(misbuild.mirrored_panel == static_cast<std::int32_t>(panel)),
      on_side_(turn_by(panel_.turned / 4.0)),
      tilt_(turn_by(panel_.tilt_deg / 360.0)) {
    const double late = at + static_cast<double>(misbuild.phase_slices);
    switch (display.kind) {
        case DisplayKind::StackedPlanes: {
            const auto plane = static_cast<std::int64_t>(std::floor(late)) % display.slices;
            height_mm_ = plane_height_mm(display, static_cast<double>(plane < 0 ? plane + display.slices : plane));
            break;
        }
        case DisplayKind::SweptPlane: height_mm_ = plane_height_mm(display, late - 0.5); break;
        case DisplayKind::RotatingPanel: {
            const double turns = late / display.slices * (display.sweep_deg / 360.0);
            turned_ = turn_by(display.clockwise ? -turns : turns) * turn_by(panel_.angle_deg / 360.0);
            break;
        }
        case DisplayKind::Helix: phase_ = (display.clockwise ? late : -late) / display.slices; break;
        case DisplayKind::FreePoints: break;
    }
}

glm::dvec3 Seats::place_mm(std::uint32_t row, std::uint32_t wired) const {
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

glm::dvec3 Seats::rotor_place(std::uint32_t column, double across, double upwards) const {
    const Turn face = Turn(panel_.mirrored ? -across : across, upwards) * on_side_;
    // Seen from the side, upwards along the real axis and towards who looks along the imaginary one.
    const Turn side = face.imag() * tilt_;
    const double skew = column % 2 == 1 ? panel_.skew_mm : 0.0;
    // At rest the panel stands in the plane y = −offset and looks towards −y.
    const Turn plan = turned_ * Turn(panel_.shift_mm + face.real(), -(panel_.offset_mm + skew + side.imag()));
    return {plan.real(), plan.imag(), panel_.lift_mm + side.real()};
}

double Seats::screen_height(const Turn& place) const {
    const double blades = std::arg(place) * display_.blades / (2.0 * std::numbers::pi) + phase_;
    return display_.motion.stroke_mm * (blades - std::floor(blades + kEdge) - 0.5);
}

}  // namespace xorvox::sim
