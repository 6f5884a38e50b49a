// Faults: ways in which a display can be broken or put together wrongly, on purpose: to see what each looks like, and
// to see that tests and bring-up find it.
//
//   "off-axis:panel=1,mm=1.5"        a fault as text: its kind, and its keys in any order; docs/bring-up.md shows each
//
// Where they act:
//   pose      off-axis, shifted, shifted-plane, tilted, swapped-slices, phase: light is elsewhere (sim/seats.h)
//   wiring    mirrored, swapped-panels, dead-row, stuck-bit, row-order: LEDs are given other bits (sim/wiring.h)
//   link      lost-packets: the device hears less (sim/lossy_link.h)
//
// The host and the device know of none of them. No global state: any thread.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "driver/display/description.h"
#include "voxelizer/error.h"

namespace xorvox::sim {

enum class FaultKind : std::uint8_t {
    OffAxis,        ///< Panel `panel` of a rotor stands `amount` mm further out along its normal, as offset_mm.
    Shifted,        ///< It stands `amount` mm further along its columns, as shift_mm; so does a projector's image.
    ShiftedPlane,   ///< Plane `slice` of a stack does.
    Tilted,         ///< Panel `panel` of a rotor leans `amount` degrees further, as tilt_deg.
    Mirrored,       ///< Columns of panel `panel` are wired from the other end.
    SwappedPanels,  ///< Panels `panel` and `other`, of one size, are plugged the other way round.
    SwappedSlices,  ///< Slices (layers, planes) `slice` and `other` are; of free points these points of the string.
    DeadRow,        ///< Row `row` of panel `panel` stays dark.
    StuckBit,       ///< Bit `bit` of the codes (0: the lowest) that panel `panel` shows is always `amount`: 0 or 1.
    /// Row lines `line` and `other` of panel `panel` are swapped: of HUB75 the address lines, A is 0; of a matrix
    /// without addresses the lines of two row groups.
    RowOrder,
    /// The index mark, the plane counter of a stack or the first point of a string is `amount` slices late. Where
    /// things are counted the count wraps; a swept plane that is late at the top is on its way down.
    Phase,
    LostPackets,  ///< Each packet to the display vanishes with the probability `amount`.
};

/// One fault; fields that its kind does not name are 0.
struct Fault {
    FaultKind kind = FaultKind::OffAxis;
    std::uint32_t panel = 0;
    std::uint32_t slice = 0;
    std::uint32_t row = 0;
    std::uint32_t line = 0;
    std::uint32_t bit = 0;
    std::uint32_t other = 0;
    double amount = 0.0;
};

/// All of them, which act one after the other.
struct Faults {
    std::vector<Fault> list;
    std::uint64_t seed = 1;  ///< Of lost packets.

    bool empty() const { return list.empty(); }
    bool has(FaultKind kind) const;
    double lost_packets() const;  ///< The part that is lost in all.
    double late_slices() const;   ///< Of Phase, the sum.
};

/// A kind, for people.
struct FaultKindInfo {
    FaultKind kind;
    std::string_view name;     ///< "off-axis".
    std::string_view summary;  ///< One line.
    std::string_view example;  ///< As parse_fault() takes it.
};

/// Every kind. Static storage.
std::span<const FaultKindInfo> fault_kinds();

/// "off-axis"; "unknown" of a number that is no kind.
std::string_view to_string(FaultKind kind);

/// Reads KIND:KEY=VALUE,KEY=VALUE. Messages say what was found and which kinds, keys and values there are.
Expected<Fault> parse_fault(std::string_view text);

/// Whether each fault can be on a valid `display`; an Error says which one cannot, and why.
Expected<void> check_faults(const DisplayDescription& display, const Faults& faults);

}  // namespace xorvox::sim
