#include "driver/display/lattice.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace xorvox {
namespace {

/// (cos, sin) of an angle in turns. Its own arithmetic, without the C library's, whose last bits differ between
/// machines: every machine makes the same lattice. Exact at quarter turns, and the same in all eight octants.
glm::dvec2 direction(double turns) {
    const double eighths = 8.0 * (turns - std::floor(turns));
    const int octant = std::min(static_cast<int>(eighths), 7);
    double rest = eighths - octant;
    if (octant % 2 == 1) rest = 1.0 - rest;

    // Taylor's series on 0 … π/4; the first term left out is below 2^-60.
    const double x = rest * 0.78539816339744830962;
    const double xx = x * x;
    double cosine = 1.0;
    double sine = 1.0;
    for (int n = 18; n >= 2; n -= 2) {
        cosine = 1.0 - cosine * xx / (n * (n - 1));
        sine = 1.0 - sine * xx / (n * (n + 1));
    }
    sine *= x;

    switch (octant) {
        case 0: return {cosine, sine};
        case 1: return {sine, cosine};
        case 2: return {-sine, cosine};
        case 3: return {-cosine, sine};
        case 4: return {-cosine, -sine};
        case 5: return {-sine, -cosine};
        case 6: return {sine, -cosine};
        default: return {cosine, -sine};
    }
}

/// From the axis to the far edge of the panel's outermost pixels.
double reach_mm(const Panel& panel) {
    const double half_width = 0.5 * panel.columns * panel.column_pitch_mm;
    const double along = std::abs(panel.shift_mm) + half_width;
    return std::sqrt(along * along + panel.offset_mm * panel.offset_mm);
}

}  // namespace

DisplayLattice::DisplayLattice(const DisplayDescription& display) {
    const Panel& first = display.panels[0];
    if (display.kind == DisplayKind::StackedPlanes) {
        lattice_.nx = first.columns;
        lattice_.ny = first.rows;
        lattice_.nz = display.slices;
        lattice_.pitch = {first.column_pitch_mm, first.row_pitch_mm, display.plane_pitch_mm};
        lattice_.origin = -0.5 * glm::dvec3(lattice_.nx, lattice_.ny, lattice_.nz) * lattice_.pitch;
        return;
    }

    for (std::uint32_t p = 0; p < display.panel_count; ++p) lattice_.nx += display.panels[p].columns;
    lattice_.ny = display.slices;
    lattice_.nz = first.rows;
    plan_.reserve(lattice_.column_count());
    for (std::uint32_t slice = 0; slice < display.slices; ++slice) {
        const double phase = (slice + 0.5) / display.slices;
        for (std::uint32_t p = 0; p < display.panel_count; ++p) {
            const Panel& panel = display.panels[p];
            const glm::dvec2 u = direction((display.clockwise ? -phase : phase) + panel.angle_deg / 360.0);
            const glm::dvec2 n(u.y, -u.x);
            for (std::uint32_t column = 0; column < panel.columns; ++column) {
                const double along = panel.shift_mm + (column - 0.5 * (panel.columns - 1)) * panel.column_pitch_mm;
                plan_.push_back(u * along + n * panel.offset_mm);
            }
        }
    }
    z_.reserve(first.rows);
    for (std::uint32_t k = 0; k < first.rows; ++k) {
        z_.push_back(first.lift_mm + (k - 0.5 * (first.rows - 1)) * first.row_pitch_mm);
    }
}

Lattice DisplayLattice::view() const {
    Lattice lattice = lattice_;
    lattice.plan = plan_;
    lattice.z = z_;
    return lattice;
}

DisplayExtent extent(const DisplayDescription& display) {
    const Panel& first = display.panels[0];
    if (display.kind == DisplayKind::StackedPlanes) {
        const glm::dvec3 half = 0.5 * glm::dvec3(first.columns * first.column_pitch_mm, first.rows * first.row_pitch_mm,
                                                 display.slices * display.plane_pitch_mm);
        return {-half, half, 0.0};
    }
    double nearest = reach_mm(first);
    double farthest = nearest;
    for (std::uint32_t p = 1; p < display.panel_count; ++p) {
        nearest = std::min(nearest, reach_mm(display.panels[p]));
        farthest = std::max(farthest, reach_mm(display.panels[p]));
    }
    const double half_height = 0.5 * first.rows * first.row_pitch_mm;
    return {{-farthest, -farthest, first.lift_mm - half_height},
            {farthest, farthest, first.lift_mm + half_height},
            nearest};
}

}  // namespace xorvox
