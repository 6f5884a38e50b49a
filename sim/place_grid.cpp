#include "sim/place_grid.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace xorvox::sim {

PlaceGrid::PlaceGrid(double cell, std::size_t capacity)
    : cell_(cell), heads_(std::bit_ceil(std::max<std::size_t>(2 * capacity, 2)), kNone) {
    nodes_.reserve(capacity);
}

void PlaceGrid::add(const glm::dvec3& place) {
    std::uint32_t& head = heads_[slot_of(cell_of(place))];
    nodes_.push_back({place, head});
    head = static_cast<std::uint32_t>(nodes_.size() - 1);
}

double smallest_distance(std::span<const glm::dvec3> places, double same) {
    double least = std::numeric_limits<double>::infinity();
    double cell = 0.0;
    for (const glm::dvec3& place : places) cell = std::max(cell, glm::distance(place, places[0]));
    if (cell <= same) return least;

    // Cells hold few places, since no two of them are much nearer to each other than a cell is wide.
    PlaceGrid grid(cell, places.size());
    for (const glm::dvec3& place : places) {
        bool known = false;
        grid.near(place, cell, [&](std::uint32_t, double distance) {
            if (distance > same) {
                least = std::min(least, distance);
            } else {
                known = true;
            }
        });
        if (!known) grid.add(place);
        if (least >= cell / 2.0) continue;
        cell = least;
        PlaceGrid finer(cell, places.size());
        for (std::size_t n = 0; n < grid.size(); ++n) finer.add(grid[n]);
        grid = std::move(finer);
    }
    return least;
}

}  // namespace xorvox::sim
