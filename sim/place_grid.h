// PlaceGrid: places to be searched by nearness. A hash of the cells of a cubic grid; cells that lie side by side along
// x are neighbours in memory, as the pixels of a row are.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace xorvox::sim {

class PlaceGrid {
public:
    /// `cell`: the side of a cell, above 0, and the largest radius that can be searched. `capacity`: about how many
    /// places will come. Throws std::bad_alloc, as add() does.
    PlaceGrid(double cell, std::size_t capacity);

    /// Adds a place, which gets the next number, from 0 on. At most 2^32 − 1 places, within 2^52 cells of the origin.
    void add(const glm::dvec3& place);

    std::size_t size() const { return nodes_.size(); }
    const glm::dvec3& operator[](std::size_t number) const { return nodes_[number].place; }

    /// Calls found(number, distance) for every place within `radius` of `place`, at most the cell's side: in no order,
    /// and for some more than once.
    template <class Found>
    void near(const glm::dvec3& place, double radius, const Found& found) const {
        const Cell low = cell_of(place - radius);
        const Cell high = cell_of(place + radius);
        for (std::int64_t z = low.z; z <= high.z; ++z) {
            for (std::int64_t y = low.y; y <= high.y; ++y) {
                for (std::int64_t x = low.x; x <= high.x; ++x) {
                    for (std::uint32_t n = heads_[slot_of({x, y, z})]; n != kNone; n = nodes_[n].next) {
                        const double distance = glm::distance(nodes_[n].place, place);
                        if (distance <= radius) found(n, distance);
                    }
                }
            }
        }
    }

private:
    static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

    struct Cell {
        std::int64_t x;
        std::int64_t y;
        std::int64_t z;
    };
    struct Node {
        glm::dvec3 place;
        std::uint32_t next;
    };

    Cell cell_of(const glm::dvec3& place) const {
        const auto whole = [this](double value) { return static_cast<std::int64_t>(std::floor(value / cell_)); };
        return {whole(place.x), whole(place.y), whole(place.z)};
    }
    std::size_t slot_of(const Cell& cell) const {
        const std::uint64_t mixed = static_cast<std::uint64_t>(cell.y) * 0x9e3779b97f4a7c15u +
                                    static_cast<std::uint64_t>(cell.z) * 0xc2b2ae3d27d4eb4fu;
        return ((mixed >> 20) + static_cast<std::uint64_t>(cell.x)) & (heads_.size() - 1);
    }

    double cell_;
    std::vector<std::uint32_t> heads_;  ///< A power of two of them.
    std::vector<Node> nodes_;
};

/// The smallest distance between two of `places` that is more than `same`; infinite if there is none.
double smallest_distance(std::span<const glm::dvec3> places, double same);

}  // namespace xorvox::sim
