// Space: how much of it a display's samples stand for, each and on the whole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "driver/display/description.h"

namespace xorvox::sim {

/// The space that a sample of the display's lattice stands for: by_x[x]·by_k[k] mm³. A table of one entry is for all.
/// The box between a pixel and its neighbours on a stack; what a pixel sweeps in its slice on a swept plane, on a
/// helix, and on a rotating panel, where that is |r|·Δr·Δθ·Δz·cos tilt (r: the LED's place along the panel from the
/// axis). Free points stand for no space; each counts as 1.
struct SampleVolumes {
    std::vector<double> by_x{1.0};
    std::vector<double> by_k{1.0};

    double at_x(std::size_t x) const { return by_x[by_x.size() == 1 ? 0 : x]; }
    double at_k(std::size_t k) const { return by_k[by_k.size() == 1 ? 0 : k]; }
};
/// `display` must be valid. Throws std::bad_alloc.
SampleVolumes sample_volumes(const DisplayDescription& display);

/// How often a cycle of `display` passes a place within it: the number of samples that stand for the space there. Of a
/// rotating panel, how many panels come through the place, each half of one (on either side of its foot on the axis) by
/// itself; 1 elsewhere.
double passes_at(const DisplayDescription& display, const glm::dvec3& place_mm);

/// How far the planes of a stack or of a swept plane are from each other at slice `slice`: from half a slice before it
/// to half a slice after.
double plane_thickness_mm(const DisplayDescription& display, std::uint32_t slice);

/// How densely a display's samples fill its space, as pictures need it.
struct Spacing {
    bool rotates = false;        ///< A rotating panel: `along` differs with the distance from the axis.
    double across_mm = 1.0;      ///< Between columns. Free points: a typical distance, which the other two are as well.
    double along_mm = 1.0;       ///< Between rows of a plane. Rotating panels: between slices at the rim.
    double up_mm = 1.0;          ///< Between planes (the mean), steps of height, or rows of a rotating panel.
    double slice_rad = 0.0;      ///< Rotating panels: the angle of a slice.
    double times_covered = 1.0;  ///< How often all pixels of a cycle fill the space.
};
/// `display` must be valid.
Spacing spacing_of(const DisplayDescription& display);

}  // namespace xorvox::sim
