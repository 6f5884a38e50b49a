// DisplayLattice: the sample points of a display, one for every pixel of a frame, in millimetres.
//
//   kind             x                          y        k (upwards)
//   stacked planes   column                     row      plane                         regular plan
//   rotating panel   column, panel after panel  slice    row, counted from the lowest  table plan
//
// One z table serves every column, so the panels of a rotating display must have their rows at the same heights:
// validate_display refuses others. Sines and cosines are computed without the C library, so that every machine makes
// the same lattice, bit for bit.
#pragma once

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

private:
    Lattice lattice_;  ///< Without the tables.
    std::vector<glm::dvec2> plan_;
    std::vector<double> z_;
};

/// Where the samples are: the box around all of them, and for rotating displays the upright cylinder about z in which a
/// model is placed, since every panel sweeps all of it (but the inside of its own offset from the axis). Both reach
/// half a pitch beyond the outermost samples.
struct DisplayExtent {
    glm::dvec3 lower{0.0};  ///< Of the box, mm.
    glm::dvec3 upper{0.0};
    double radius_mm =
        0.0;  ///< Of the cylinder, which is as high as the box; 0 on stacked planes: the box is the place.
};
/// `display` must be valid.
DisplayExtent extent(const DisplayDescription& display);

}  // namespace xorvox
