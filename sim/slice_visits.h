// SliceVisits: how many times each slice had its turn while a shutter was open, and so how much light it was due.
//
// A shutter that is open for whole cycles sees each slice as often. One that is not sees some once more than others,
// and cuts the slices that are lit when it opens and closes. What a slice was due must not depend on what went wrong
// with the display, so of c cycles it is never less than ⌊c⌋ turns and never more than ⌈c⌉; which, its strobes tell.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <vector>

#include "driver/display/description.h"
#include "sim/strobe.h"

namespace xorvox::sim {

class SliceVisits {
public:
    explicit SliceVisits(const DisplayDescription& display)
        : is_steady_(keeps_light(display)),
          in_a_cycle_(display.kind == DisplayKind::SweptPlane && display.motion.both_ways ? 2.0 : 1.0),
          slices_(display.slices) {}

    /// In the order of their beginnings. Of a shutter that is open from `from_ns` to `to_ns`.
    void add(const Strobe& strobe, std::uint64_t from_ns, std::uint64_t to_ns) {
        // Groups of rows and planes come in rising order; where they begin anew the slice does.
        const auto turn = std::tuple(strobe.row_group, strobe.plane);
        if (strobe.slice != slice_ || turn <= turn_) is_counted_ = is_outside_ = false;
        slice_ = strobe.slice;
        turn_ = turn;
        Slice& slice = slices_[strobe.slice];
        if (strobe.off_ns <= from_ns || strobe.on_ns >= to_ns) {
            is_outside_ = true;
        } else {
            if (!is_counted_) ++slice.visits;
            is_counted_ = true;
            slice.is_cut = slice.is_cut || strobe.on_ns < from_ns || strobe.off_ns > to_ns;
        }
        slice.is_cut = slice.is_cut || (is_counted_ && is_outside_);
    }

    /// The light that `slice` was due, as a part of what one has that is lit in each of so many cycles: 1 of whole
    /// cycles. 0: it had no turn, or the shutter cut one, and what it gave says nothing.
    double due(std::uint32_t slice, double cycles) const {
        constexpr double kWhole = 0.02;  // Of a cycle: rotors do not keep their time to the nanosecond.
        const double whole = std::round(cycles);
        if (is_steady_ || (whole >= 1.0 && std::abs(cycles - whole) <= kWhole)) return 1.0;
        if (slices_[slice].is_cut) return 0.0;
        const double least = in_a_cycle_ * std::floor(cycles);
        const double most = in_a_cycle_ * std::ceil(cycles);
        return std::clamp(static_cast<double>(slices_[slice].visits), least, most) / (in_a_cycle_ * cycles);
    }

private:
    struct Slice {
        std::uint32_t visits = 0;
        bool is_cut = false;
    };
    bool is_steady_;
    double in_a_cycle_;
    std::vector<Slice> slices_;
    std::uint32_t slice_ = 0;  ///< That had its turn last,
    std::tuple<std::uint32_t, std::uint32_t> turn_{Strobe::kAllRows, Strobe::kLevels};
    bool is_counted_ = false;  ///< whether this turn is among its visits,
    bool is_outside_ = false;  ///< and whether some of it was while the shutter was shut.
};

}  // namespace xorvox::sim
