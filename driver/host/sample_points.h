// SamplePoints: where the samples of a row of the wire are, as colours are asked for them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "driver/display/description.h"
#include "driver/display/lattice.h"
#include "driver/host/wire_order.h"

namespace xorvox::host {

/// Tables of the coordinates, 0 … 1 along the box of extent(display). Any number of threads may use one.
class SamplePoints {
public:
    /// `lattice` and `order` are the display's, and borrowed for the object's life. Throws std::bad_alloc.
    SamplePoints(const DisplayDescription& display, const DisplayLattice& lattice, const WireOrder& order);

    /// The points of pixels `columns` of a row of the wire; `points` has as many entries.
    void of_row(std::uint32_t slice, std::uint32_t panel, std::uint32_t row, std::span<const std::uint32_t> columns,
                glm::vec3* points) const;

private:
    glm::vec3 point(const Sample& sample) const;

    const DisplayLattice& lattice_;
    const WireOrder& order_;
    bool is_helix_;
    glm::dvec3 lower_;
    glm::dvec3 scale_;
    // Of a regular plan: by x, y and k. Of a table plan: x_ and y_ by column of the lattice, z_ by k; or, where each
    // column is one sample, by column, too.
    std::vector<float> x_, y_, z_;
};

}  // namespace xorvox::host
