// Grids of cells over a box of space, for what lies around a place of light: how dense the light is, and whether it is
// walled in by other light.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace xorvox::sim {

struct Bounds {
    glm::dvec3 lower{0.0};
    glm::dvec3 upper{0.0};
};

/// Cells over `bounds` and some more on every side, so that a filter need not ask where the grid ends. They are
/// `cell_mm` large, or as often doubled as makes them few enough. Places on a lattice that begins at bounds.lower and
/// is as even as the grid fall in the middles of cells.
class Cells {
public:
    Cells(const Bounds& bounds, const glm::dvec3& cell_mm, std::size_t most_cells);

    const glm::dvec3& cell_mm() const { return cell_mm_; }
    const std::array<std::size_t, 3>& size() const { return size_; }
    /// In cells from the grid's corner. At places within the bounds, each is at least 6, and 6 less than the size.
    glm::dvec3 steps_to(const glm::dvec3& place_mm) const { return (place_mm - origin_mm_) / cell_mm_; }

private:
    glm::dvec3 cell_mm_;
    glm::dvec3 origin_mm_{0.0};
    std::array<std::size_t, 3> size_{};
};

/// A number for each cell.
class DensityGrid {
public:
    explicit DensityGrid(const Cells& cells);

    /// Adds `amount` at a place within the bounds, shared by the eight cells around it.
    void add(const glm::dvec3& place_mm, double amount);
    /// Each cell becomes a quarter of its neighbours and half of itself, along each axis in turn.
    void blur();
    /// Between the middles of cells, mixed from the eight around.
    double at(const glm::dvec3& place_mm) const;
    /// By how much the density falls from a cell before to a cell behind, divided by a cell, along each axis.
    glm::dvec3 fall_at(const glm::dvec3& place_mm) const;

private:
    /// Calls visit(index, share) for the eight cells around a place; the shares add up to 1.
    template <class Visit>
    void around(const glm::dvec3& place_mm, const Visit& visit) const;

    Cells cells_;
    std::array<std::size_t, 3> stride_;
    std::vector<float> values_;
};

/// A bit for each cell.
class WallGrid {
public:
    explicit WallGrid(const Cells& cells);

    void set(const glm::dvec3& place_mm) {
        const Bit bit = bit_at(place_mm);
        words_[bit.word] |= bit.mask;
    }
    bool test(const glm::dvec3& place_mm) const {
        const Bit bit = bit_at(place_mm);
        return (words_[bit.word] & bit.mask) != 0;
    }
    /// Keeps the cells whose 26 neighbours are all set.
    void erode();

private:
    struct Bit {
        std::size_t word;
        std::uint64_t mask;
    };
    Bit bit_at(const glm::dvec3& place_mm) const {
        const glm::dvec3 steps = cells_.steps_to(place_mm);
        const auto x = static_cast<std::size_t>(steps.x);
        return {
            static_cast<std::size_t>(steps.z) * plane_words_ + static_cast<std::size_t>(steps.y) * row_words_ + x / 64,
            std::uint64_t{1} << (x % 64)};
    }

    Cells cells_;
    std::size_t row_words_;
    std::size_t plane_words_;
    std::vector<std::uint64_t> words_;
};

}  // namespace xorvox::sim
