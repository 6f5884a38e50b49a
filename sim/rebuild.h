// Rebuild: which of the display's declared samples gave the light that was seen, from the light's places alone.
//
// Several declared samples may stand at one place: two columns of a rotating panel pass it, half a turn apart. Which of
// them was lit cannot be told from the place, so a flash counts for the place, which goes by its lowest sample:
//
//   DisplaySamples samples(display);
//   samples.rebuild(simulator.light()) == samples.faithful(codes_sent)     // nothing lost, added, moved or recoloured
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "driver/display/description.h"
#include "driver/display/lattice.h"
#include "sim/optics.h"
#include "sim/place_grid.h"

namespace xorvox::sim {

/// A lit sample. Sample (x, y, k) of the display's lattice (driver/display/lattice.h) is number (k·ny + y)·nx + x, as
/// in a BitVolume.
struct SampleCode {
    std::uint64_t sample = 0;
    std::uint32_t code = 0;  ///< Of its pixel; it has bits set that are shown.
};

/// What is seen at one place in one cycle.
struct SeenPlace {
    std::uint64_t sample = 0;      ///< The lowest number of the samples at the place.
    std::uint64_t code_total = 0;  ///< The sum of the codes of its flashes.
    std::uint32_t visits = 0;      ///< Its flashes.

    bool operator==(const SeenPlace&) const = default;
};

/// What is seen of a display in one cycle.
struct Rebuilt {
    std::vector<SeenPlace> places;  ///< The lit ones, by sample number.
    std::size_t outside = 0;        ///< Flashes further than DisplaySamples::reach_mm from every sample.

    bool operator==(const Rebuilt&) const = default;
};

/// The samples that a display declares, to be searched by place. It knows them by their places alone, not by what moves
/// there. Any number of threads may use one.
class DisplaySamples {
public:
    /// `display` must be valid (validate_display). A second for millions of columns. Throws std::bad_alloc.
    explicit DisplaySamples(const DisplayDescription& display);
    DisplaySamples(DisplaySamples&&) noexcept = default;
    DisplaySamples& operator=(DisplaySamples&&) noexcept = default;

    std::size_t size() const { return lattice_.sample_count(); }
    const Lattice& lattice() const { return lattice_; }

    /// Places, each of which has one or more samples nearer to each other than a millionth of the smallest distance.
    std::size_t place_count() const { return group_count() * lattice_.nz; }

    /// A flash within this of its nearest sample is that sample's: a quarter of the smallest distance that a person
    /// could measure on the parts: between LEDs of a column or row, planes, steps of a helix, points.
    double reach_mm() const { return reach_mm_; }

    /// The place of sample `sample`: the lowest number of the samples there.
    std::uint64_t place_of(std::uint64_t sample) const;

    /// The place nearest to `place_mm`, if it is within reach_mm().
    std::optional<std::uint64_t> place_near(const glm::dvec3& place_mm) const;

    /// Gives each flash to the place nearest to it.
    Rebuilt rebuild(const LightField& field) const;

    /// What rebuild() finds on a display without faults when these samples were lit, in any order, each once.
    Rebuilt faithful(std::span<const SampleCode> codes) const;

    /// Columns of which every sample is at one place with one of the others' are a group; each column is in exactly
    /// one. There are no columns that share some of their places only.
    std::size_t group_count() const { return lattice_.is_regular() ? lattice_.column_count() : groups_.size(); }
    std::uint32_t group_of(std::size_t column) const {
        return lattice_.is_regular() ? static_cast<std::uint32_t>(column) : group_of_[column];
    }

private:
    struct Group {
        double z0;
        std::uint32_t column;  ///< Its lowest one.
    };

    void make_groups();
    std::uint32_t nearest_k(double z) const;
    std::optional<std::uint64_t> place_near_regular(const glm::dvec3& place_mm) const;
    /// A column's place as grid_ has it: a column of many samples is searched by its place in the plan.
    glm::dvec3 in_grid(const glm::dvec3& place_mm) const {
        return {place_mm.x, place_mm.y, lattice_.nz == 1 ? place_mm.z : 0.0};
    }

    DisplayLattice owner_;
    Lattice lattice_;
    double reach_mm_;
    // Of a table plan:
    PlaceGrid grid_;  ///< One place a group.
    std::vector<Group> groups_;
    std::vector<std::uint32_t> group_of_;  ///< One a column.
};

}  // namespace xorvox::sim
