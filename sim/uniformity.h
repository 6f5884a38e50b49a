// Uniformity: how evenly the light of a display fills its space.
//
// The box of the display (extent(): driver/display/lattice.h) is divided into n × n × n equal cells. The light of a
// cell is the luminance of every flash in it, summed over the frames that were added; its volume is the space that the
// declared samples in it stand for (SampleVolumes), each divided by how often a cycle passes there (passes_at), so that
// space that two panels sweep counts once, and is twice as bright. A display is even where light ÷ volume is the same
// in all cells.
//
// A flash counts for what its code says, whatever it takes: all slices of a display are lit for equal times. What
// differs is the space that they are spread over: LEDs near the axis of a rotor sweep less of it in that time, and a
// plane that swings dwells at its ends.
//
// n is at most 16, and the most for which cells with 48 samples or more hold nine tenths of the volume, or half of it
// where n is 3 or less; cells with fewer say nothing and are not looked at. Free points stand for no space, and count 1
// each.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "driver/display/description.h"
#include "sim/optics.h"
#include "sim/space.h"

namespace xorvox::sim {

inline constexpr std::uint32_t kMostCellsASide = 16;
inline constexpr std::uint32_t kLeastCellSamples = 48;

struct Uniformity {
    std::uint32_t cells_a_side = 0;  ///< n.
    std::size_t cells = 0;           ///< Those that were looked at, with kLeastCellSamples or more.
    /// Light of a frame ÷ volume, of white in full per mm³: in the brightest and in the darkest cell, and in all of
    /// them.
    double most = 0.0;
    double least = 0.0;
    double mean = 0.0;
    glm::dvec3 most_mm{0.0};   ///< The middle of the brightest cell,
    glm::dvec3 least_mm{0.0};  ///< and of the darkest one.

    /// most ÷ least: 1 is even. Infinite where a cell is dark; 1 where all are, and where no cell was looked at.
    double ratio() const;
};

/// Measures frames one by one. It keeps a number for each cell and each pixel of a slice, never for each flash.
class UniformityMeter {
public:
    /// `display` must be valid; what it borrows must outlive the meter. A second for 10⁸ samples. Throws
    /// std::bad_alloc.
    explicit UniformityMeter(const DisplayDescription& display);

    /// Adds one cycle of `page`, of frame_bytes(display) in scan-out order. A second or two for 10⁸ pixels.
    void add(std::span<const std::byte> page);

    /// Of the frames so far.
    Uniformity result() const;

private:
    struct Cell {
        std::uint64_t samples = 0;
        double volume = 0.0;
        double light = 0.0;
    };

    void divide(std::uint32_t cells_a_side);
    bool can_tell() const;
    std::uint32_t cell_at(const glm::dvec3& place_mm) const;
    glm::dvec3 middle_mm(std::size_t cell) const;
    /// Calls visit(slice, panel, row, cells) for every row of pixels in scan-out order, with the cell of each column.
    template <class Visit>
    void for_each_row_of_cells(const Visit& visit) const;

    DisplayDescription display_;
    glm::dvec3 lower_mm_;
    glm::dvec3 size_mm_;
    std::vector<float> luminance_;   ///< By code; of rgb888 by level, channel after channel.
    std::vector<double> volume_;     ///< Of each pixel of a slice,
    std::vector<double> thickness_;  ///< times this of the slice; one for all, or one a slice.
    std::uint32_t cells_a_side_ = 0;
    std::vector<Cell> cells_;
    std::uint32_t frames_ = 0;
};

}  // namespace xorvox::sim
