// ScanOrder: what the scanner has to do now, and how it goes dark.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace xorvox::device {

/// Why nothing is lit.
enum class Dark : std::uint8_t {
    No = 0,         ///< It is lit.
    NoPicture = 1,  ///< No frame was presented yet, or the host blanked.
    DeadZone = 2,   ///< Between the sweeps.
    NotLocked = 3,  ///< Where the display is in its turn is not known (yet).
    Fault = 4,      ///< Device::faults() tells which.
};

struct ScanOrder {
    std::uint32_t number = 0;  ///< Another one for everything new to do; the same order may be given often.
    Dark dark = Dark::NoPicture;
    std::uint32_t slice = 0;
    /// Each row of each panel is scanned out from its last column to its first.
    bool mirrored = false;
    /// Part of the full light, 255 all of it: linear, as a shorter output enable, or as smaller levels where LEDs keep
    /// their colour. The current limit is in it.
    std::uint8_t brightness = 0;
    /// The slice, in scan-out order; of LEDs that keep their colour the whole frame. Empty where dark. Lies in the
    /// page, which stays as it is until the order changes.
    std::span<const std::byte> bytes;
    std::uint64_t begin_ns = 0;
    /// When to ask again, at the latest. Lit: the slice's light must have ended by then.
    std::uint64_t end_ns = 0;

    bool lit() const { return dark == Dark::No; }
};

/// A dark order means that the scanner does this, in this order, at once, whatever it is in the middle of:
///   OutputOff     Output enable off, and from here on never on. Of a projector: its light source. This alone must
///                 leave nothing lit; what follows makes sure that nothing lights up when output enable fails or
///                 floats.
///   ReleaseRows   No row or layer stays selected: all layer bits off, all row drivers off. A row address that always
///                 selects one (HUB75) goes to row 0, and rests on the other two steps.
///   ClearColumns  Zeros are shifted into every register and latched; LEDs that keep their colour are sent black.
/// Never another way round: a row that is released last stands selected, at the current of one that is multiplexed,
/// for as long as the scanner takes. A scanner of its own (PIO, DMA, FPGA) that loses its orders does the same.
enum class BlankStep : std::uint8_t { OutputOff = 1, ReleaseRows = 2, ClearColumns = 3 };
inline constexpr std::array kBlankSteps{BlankStep::OutputOff, BlankStep::ReleaseRows, BlankStep::ClearColumns};

}  // namespace xorvox::device
