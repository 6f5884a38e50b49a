#include "sim/seats.h"

#include <cmath>
#include <complex>
#include <numbers>

#include "sim/optics.h"

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

/// A counter that wraps.
std::uint32_t wrapped(std::int64_t index, std::uint32_t count) {
    const std::int64_t rest = index % count;
    return static_cast<std::uint32_t>(rest < 0 ? rest + count : rest);
}

/// The panel as it really stands. Of displays that have no shift_mm, that of the image.
Panel as_built(Panel panel, std::uint32_t number, const Faults& faults) {
    for (const Fault& fault : faults.list) {
        if (fault.panel != number) continue;
        if (fault.kind == FaultKind::OffAxis) panel.offset_mm += fault.amount;
        if (fault.kind == FaultKind::Shifted) panel.shift_mm += fault.amount;
        if (fault.kind == FaultKind::Tilted) panel.tilt_deg += fault.amount;
    }
    return panel;
}

double plane_shift_mm(std::uint32_t plane, const Faults& faults) {
    double shift = 0.0;
    for (const Fault& fault : faults.list) {
        if (fault.kind == FaultKind::ShiftedPlane && fault.slice == plane) shift += fault.amount;
    }
    return shift;
}

}  // namespace

std::uint32_t lit_slice(std::uint32_t slice, const Faults& faults) {
    for (const Fault& fault : faults.list) {
        if (fault.kind != FaultKind::SwappedSlices) continue;
        if (slice == fault.slice) {
            slice = fault.other;
        } else if (slice == fault.other) {
            slice = fault.slice;
        }
    }
    return slice;
}

Seats::Seats(const DisplayDescription& display, std::uint32_t panel, std::uint32_t slice, const Faults& faults)
    : Seats(display, panel, lit_slice(slice, faults) + 0.5, faults) {}

Seats::Seats(const DisplayDescription& display, std::uint32_t panel, double at, const Faults& faults)
    : display_(display),
      faults_(faults),
      panel_(as_built(display.panels[panel], panel, faults)),
      on_side_(turn_by(panel_.turned / 4.0)),
      tilt_(turn_by(panel_.tilt_deg / 360.0)) {
    const double late = at + faults.late_slices();
    switch (display.kind) {
        case DisplayKind::StackedPlanes: {
            const std::uint32_t plane = wrapped(static_cast<std::int64_t>(std::floor(late)), display.slices);
            height_mm_ = plane_height_mm(display, plane);
            panel_.shift_mm += plane_shift_mm(plane, faults);
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

glm::dvec3 Seats::place_mm(std::uint32_t row, std::uint32_t column) const {
    const double across = along(column, panel_.columns, panel_.column_pitch_mm);
    const double rising = along(row, panel_.rows, panel_.row_pitch_mm);
    const double x = panel_.shift_mm + across;
    switch (display_.kind) {
        case DisplayKind::StackedPlanes:
        case DisplayKind::SweptPlane: return {x, rising, height_mm_};
        case DisplayKind::RotatingPanel: return rotor_place(column, across, -rising);
        case DisplayKind::Helix: return {x, rising, screen_height(Turn(x, rising))};
        case DisplayKind::FreePoints: break;
    }
    const std::int64_t number = std::int64_t{lit_slice(row * panel_.columns + column, faults_)} +
                                static_cast<std::int64_t>(faults_.late_slices());
    const PointMm& point = display_.points[wrapped(number, static_cast<std::uint32_t>(display_.points.size()))];
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
