// Faults: ways in which a display can be broken or put together wrongly, on purpose: to see what each looks like, and
// to see that tests and bring-up find it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "driver/display/description.h"
#include "sim/strobe.h"
#include "voxelizer/error.h"

namespace xorvox::sim {

enum class FaultKind : std::uint8_t {
    OffAxis,   ///< Panel `panel` stands `amount` mm further out along its normal (offset_mm).
    Shifted,   ///< Panel `panel` stands `amount` mm further along its columns (shift_mm); of displays at rest, too.
    Tilted,    ///< Panel `panel` leans `amount` degrees further (tilt_deg).
    Mirrored,  ///< Columns of panel `panel` run the other way.
    SwappedPanels,  ///< Panels `panel` and `other` are plugged the other way round.
    SwappedSlices,  ///< Slices (planes, points) `panel` and `other` are.
    DeadRow,        ///< Row `row` of panel `panel` stays dark.
    StuckBit,       ///< Bit `bit` of panel `panel`'s codes is always `amount`: 1, or 0.
    RowOrder,       ///< Address lines `row` and `other` of panel `panel` are swapped: bits of the row's number.
    Phase,          ///< The index mark, the plane counter or the first point of a string is `amount` slices late.
    LostPackets,    ///< Each packet to the display vanishes with the probability `amount`.
};

struct Fault {
    FaultKind kind = FaultKind::OffAxis;
    std::uint32_t panel = 0;
    std::uint32_t other = 0;
    std::uint32_t row = 0;
    std::uint32_t bit = 0;
    double amount = 0.0;
};

struct Faults {
    std::vector<Fault> list;
    std::uint64_t seed = 1;  ///< Of LostPackets.

    bool empty() const { return list.empty(); }
};

}  // namespace xorvox::sim
