// DisplayLattice: the sample points of a display, one for every pixel of a frame, in millimetres.
//
//   kind              x                           y        k (upwards)
//   stacked planes    column                      row      plane                     regular plan; table where uneven
//   swept plane       column                      row      slice, from the lowest    regular plan; table where uneven
//   rotating, upright upright column: of panel 0  slice    height, from the lowest   table plan
//                     from left to right as seen
//                     by who looks at its face,
//                     then of panel 1 …
//   rotating, else    pixel of the slice, in      slice    0: nz is 1                table plan and z0
//                     scan-out order
//   helix             column                      row      step of height; in which  table plan and z0
//                                                          slice: helix_k()
//   free points       pixel, in scan-out order    0        0: nz is 1                table plan and z0
//
// A rotating display is upright when its LEDs stand above each other in columns of one height: no panel is tilted, none
// that is turned on its side is skewed, and all have as many LEDs one above the other, at the same heights. Sines,
// cosines and angles are computed without the C library, so that every machine makes the same lattice, bit for bit.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "driver/display/description.h"
#include "voxelizer/lattice.h"

namespace xorvox {

/// Owns the tables of a display's lattice.
class DisplayLattice {
public:
    /// `display` must be valid (validate_display). Throws std::bad_alloc.
    explicit DisplayLattice(const DisplayDescription& display);

    /// Borrowed from this object; moving the object keeps it valid.
    Lattice view() const;

    /// Helix: the k that slice 0 lights in each column, y·nx + x; empty on other kinds. From slice to slice it falls by
    /// one, or with `clockwise` rises, modulo nz.
    std::span<const std::uint32_t> helix_k() const { return helix_k_; }

private:
    void make_stack(const DisplayDescription& display);
    void make_swept(const DisplayDescription& display);
    void make_upright(const DisplayDescription& display);
    void make_pixels(const DisplayDescription& display);
    void make_helix(const DisplayDescription& display);
    void make_points(const DisplayDescription& display);
    void put_regular_plan(const Panel& panel);

    Lattice lattice_;  ///< Without the tables.
    std::vector<glm::dvec2> plan_;
    std::vector<double> z0_;
    std::vector<double> z_;
    std::vector<std::uint32_t> helix_k_;
};

/// Height of a swept plane at a part, 0 … 1, of the time in which an upward sweep is lit: slice s of S is lit from part
/// s/S to (s + 1)/S.
double swept_height_mm(const Motion& motion, double part_of_lit);

/// LEDs of `panel` from left to right, and one above the other, as it is mounted.
constexpr std::uint32_t upright_columns(const Panel& panel) {
    return panel.turned % 2 == 1 ? panel.rows : panel.columns;
}
constexpr std::uint32_t upright_rows(const Panel& panel) {
    return panel.turned % 2 == 1 ? panel.columns : panel.rows;
}
constexpr double upright_column_pitch_mm(const Panel& panel) {
    return panel.turned % 2 == 1 ? panel.row_pitch_mm : panel.column_pitch_mm;
}
constexpr double upright_row_pitch_mm(const Panel& panel) {
    return panel.turned % 2 == 1 ? panel.column_pitch_mm : panel.row_pitch_mm;
}

/// Where pixel (column, row) of the wire is on the face of a panel as it is mounted: counted from the left, and from
/// the lowest.
struct UprightPixel {
    std::uint32_t column = 0;
    std::uint32_t row = 0;
};
UprightPixel upright_pixel(const Panel& panel, std::uint32_t column, std::uint32_t row);

/// Whether a rotating display is upright, as the head of this file says.
bool is_upright(const DisplayDescription& display);

/// Columns of the display's lattice, nx·ny: at most kMaxLatticeColumns on a valid display.
std::size_t lattice_columns(const DisplayDescription& display);

/// Where the samples are: the box around all of them, and for rotating displays the upright cylinder about z in which a
/// model is placed, since every panel sweeps all of it (but the inside of its own offset from the axis). Both reach
/// half a pitch beyond the outermost samples; among free points, half of column_pitch_mm.
struct DisplayExtent {
    glm::dvec3 lower{0.0};  ///< Of the box, mm.
    glm::dvec3 upper{0.0};
    double radius_mm = 0.0;  ///< Of the cylinder, as high as the box; 0 on other kinds: the box is the place.
};
/// `display` must be valid.
DisplayExtent extent(const DisplayDescription& display);

}  // namespace xorvox
