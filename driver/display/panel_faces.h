// Panel faces: where the panels of a rotor stand, as rectangles in space, and whether two of them are in each other's
// way. All panels turn together, so it is enough to look at phase 0.
#pragma once

#include "driver/display/description.h"

namespace xorvox::display {

/// Whether the faces of two panels of one rotor have more than edges in common: one passes through the other, they
/// overlap in a plane, or they coincide. A face is columns × rows pitches large, half a pitch beyond the outermost
/// LEDs, and as deep as its skew. Overlaps of less than a millionth of a side are taken for touching edges.
bool faces_cross(const Panel& a, const Panel& b);

}  // namespace xorvox::display
