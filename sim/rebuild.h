// Rebuild: which of the display's declared samples gave the light that was seen, from the light's places alone.
//
// Several declared samples may stand at one place: two columns of a rotating panel pass it, half a turn apart. Which of
// them was lit cannot be told from the place, so a flash counts for the place, and every sample of the place gets the
// count:
//
//   DisplaySamples samples(display);
//   samples.rebuild(simulator.light()) == samples.faithful(codes_sent)     // nothing lost, added, moved or recoloured
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "driver/display/description.h"
#include "sim/optics.h"
#include "sim/plan_tree.h"

namespace xorvox::sim {

/// What is seen of each declared sample in one cycle. Sample (x, y, k) of the display's lattice
/// (driver/display/lattice.h) is number (k·ny + y)·nx + x, as in a BitVolume.
struct Rebuilt {
    std::vector<std::uint32_t> visits;      ///< Flashes at the sample's place.
    std::vector<std::uint64_t> code_total;  ///< The sum of their codes.
    std::size_t outside = 0;                ///< Flashes further than DisplaySamples::reach_mm from every sample.

    bool operator==(const Rebuilt&) const = default;
};

/// The samples that a display declares, as columns, to be searched by place. Any number of threads may use one.
class DisplaySamples {
public:
    /// `display` must be valid (validate_display). Throws std::bad_alloc.
    explicit DisplaySamples(const DisplayDescription& display);

    std::size_t column_count() const { return plan_mm_.size(); }  ///< nx·ny; column (x, y) is y·nx + x.
    std::size_t height_count() const { return z_mm_.size(); }     ///< nz.
    std::size_t size() const { return column_count() * height_count(); }

    /// A flash within this of its nearest sample is that sample's: a quarter of the smallest pitch (of columns, rows
    /// and planes).
    double reach_mm() const { return reach_mm_; }

    /// Columns nearer to each other than a millionth of the smallest pitch are one group; each column is in exactly
    /// one.
    std::size_t group_count() const { return group_begin_.size() - 1; }
    std::uint32_t group_of(std::size_t column) const { return group_of_[column]; }
    std::span<const std::uint32_t> columns_of(std::size_t group) const {
        return std::span(columns_).subspan(group_begin_[group], group_begin_[group + 1] - group_begin_[group]);
    }

    /// The sample nearest to `place_mm`, as its column and height, and how far away it is.
    struct Nearest {
        std::uint32_t column = 0;
        std::uint32_t k = 0;
        double distance_mm = 0.0;
    };
    Nearest nearest(const glm::dvec3& place_mm) const;

    /// Gives each flash to all samples at the place of its nearest one.
    Rebuilt rebuild(const LightField& field) const;

    /// What rebuild() finds on a display without faults when sample s was sent codes[s], 0 for dark. size() codes.
    Rebuilt faithful(std::span<const std::uint32_t> codes) const;

private:
    Rebuilt nothing() const;
    void count(Rebuilt& rebuilt, std::uint32_t column, std::size_t k, std::uint32_t code) const;

    std::vector<glm::dvec2> plan_mm_;
    std::vector<double> z_mm_;
    double reach_mm_;
    PlanTree tree_;
    std::vector<std::uint32_t> group_of_;   ///< One a column.
    std::vector<std::uint32_t> columns_;    ///< Group after group.
    std::vector<std::size_t> group_begin_;  ///< Start of each group in columns_, and the end.
};

/// DisplaySamples(display).rebuild(field).
Rebuilt rebuild(const DisplayDescription& display, const LightField& field);

}  // namespace xorvox::sim
