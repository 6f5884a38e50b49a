// Seats: the pixels of one panel in one slice, as places in the world. driver/display/description.h draws them; the
// arithmetic is the simulator's own.
#pragma once

#include <complex>
#include <cstdint>

#include <glm/vec3.hpp>

#include "driver/display/description.h"
#include "sim/faults.h"

namespace xorvox::sim {

/// The slice, or point of a string, in whose place `slice` is lit: another one where faults have swapped the two.
std::uint32_t lit_slice(std::uint32_t slice, const Faults& faults);

class Seats {
public:
    /// `display` must be valid, and is borrowed, as is `faults`, of which those of its pose count (sim/faults.h).
    Seats(const DisplayDescription& display, std::uint32_t panel, std::uint32_t slice, const Faults& faults);

    /// The same where the display is at `at` of its slices, whichever slice was meant (lit_slice): slice s is lit from
    /// s to s + 1, and its samples stand at s + ½. Before and after them as FaultKind::Phase says. Of a stack: the
    /// plane floor(at).
    Seats(const DisplayDescription& display, std::uint32_t panel, double at, const Faults& faults);

    /// Of the LED in this row and column.
    glm::dvec3 place_mm(std::uint32_t row, std::uint32_t column) const;

private:
    using Turn = std::complex<double>;

    glm::dvec3 rotor_place(std::uint32_t column, double across, double upwards) const;
    double screen_height(const Turn& place) const;

    const DisplayDescription& display_;
    const Faults& faults_;
    Panel panel_;  ///< As it really stands.
    Turn on_side_;
    Turn tilt_;
    Turn turned_{1.0, 0.0};   ///< Rotating panel: by how much it has turned about the axis.
    double height_mm_ = 0.0;  ///< Of the plane.
    double phase_ = 0.0;      ///< Helix: of the screen, in blades.
};

}  // namespace xorvox::sim
