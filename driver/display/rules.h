// Rules: what a display's description may hold. Shared by the TOML reader, which knows lines and checks a number before
// it is narrowed, and by validate_display, which has only the numbers.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "driver/display/description.h"

namespace xorvox::display {

/// The numbers that are allowed, both ends included.
struct Range {
    double lowest;
    double highest;
    bool whole = false;
};

inline constexpr Range kSlices{1, kMaxSlices, true};
inline constexpr Range kPixels{1, 4096, true};  ///< Columns or rows of a panel.
inline constexpr Range kPitchMm{1e-4, 1e6};     ///< Pitches, and strokes.
inline constexpr Range kPlaceMm{-1e6, 1e6};     ///< Shift, offset, lift, skew; coordinates of planes and points.
inline constexpr Range kAngleDeg{-360, 360};
inline constexpr Range kTiltDeg{-89.9, 89.9};
inline constexpr Range kQuarterTurns{0, 3, true};
inline constexpr Range kConnectors{0, 7, true};  ///< And places in a chain.
inline constexpr Range kCyclesPerSecond{1e-3, 1e5};
inline constexpr Range kBlades{1, 8, true};
inline constexpr Range kDeadZone{0, 0.45};
inline constexpr Range kIndexPulses{1, 65536, true};
inline constexpr Range kClockHz{0, 4e9, true};
inline constexpr Range kScanNs{0, 1e9, true};
inline constexpr Range kRowGroups{1, 4096, true};
inline constexpr Range kBitPlanes{0, 8, true};
inline constexpr Range kStrings{1, 255, true};
inline constexpr Range kPlanesPerFrame{1, 24, true};
inline constexpr Range kGamma{1, 4};
/// Currents that are known: the device counts whole microamperes, 2^24 of an LED at most.
inline constexpr Range kLedMilliamperes{0.001, 1e4};
inline constexpr Range kLimitMilliamperes{0.001, 1e9};
inline constexpr Range kDuty{1e-6, 1};
/// Steps of a measured table of motion, as parts of the stroke: below, rounding would swallow slices.
inline constexpr double kLeastTableStep = 1e-6;
inline constexpr std::size_t kMaxFrameBytes = std::size_t{1} << 30;

/// What is wrong, and where: the key as in a display file.
struct Violation {
    std::string_view key;              ///< "slices", "scan.latch_ns"; of a panel "rows", or "": the panel as a whole.
    std::optional<std::size_t> panel;  ///< Index of the panel whose key it is; none: the display's own.
    std::string message;               ///< What was found and what is allowed.
    std::optional<std::size_t> item;   ///< Of a list.
};

/// "panel 1: rows: found 0; allowed: …", with `joint` after the panel.
std::string in_words(const Violation& violation, std::string_view joint);

/// "found 0; allowed: a whole number from 1 to 4096" if `value` is outside `range` or not a number.
std::optional<std::string> check(double value, const Range& range);

/// Whether the panels' connectors and chain positions mean anything: the driver has chains, or one of them is not 0.
bool gives_wiring(const DisplayDescription& display);

/// The values of `display` that are wrong, whatever the others are but its kind and the number of panels. Of a kind
/// that is none, that alone. Looks at no more panels than there can be.
std::vector<Violation> find_wrong_values(const DisplayDescription& display);

/// The contradictions in a description that has no wrong values. `wiring_given`: no two panels may have the same
/// connector and chain position.
std::vector<Violation> find_contradictions(const DisplayDescription& display, bool wiring_given);

/// Adds those in how it is driven: sync, scan, light and power.
void find_driving_contradictions(const DisplayDescription& display, std::vector<Violation>& violations);

}  // namespace xorvox::display
