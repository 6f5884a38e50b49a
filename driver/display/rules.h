// Rules: what a display's description may hold. Shared by the TOML reader, which knows lines and checks a number before
// it is narrowed, and by validate_display, which has only the numbers.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

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
inline constexpr Range kPitchMm{1e-4, 1e6};
inline constexpr Range kShiftMm{-1e6, 1e6};  ///< Shift, offset and lift.
inline constexpr Range kAngleDeg{-360, 360};
inline constexpr Range kCyclesPerSecond{1e-3, 1e5};
inline constexpr std::size_t kMaxFrameBytes = std::size_t{1} << 30;

/// What is wrong, and where: the key as in a display file.
struct Violation {
    std::string_view key;
    std::optional<std::size_t> panel;  ///< Index of the panel whose key it is; none: the display's own.
    std::string message;               ///< What was found and what is allowed.
};

/// "found 0; allowed: a whole number from 1 to 4096" if `value` is outside `range` or not a number.
std::optional<std::string> check(double value, const Range& range);

/// The first rule that `display` breaks.
std::optional<Violation> find_violation(const DisplayDescription& display);

/// "stacked-planes" or "rotating-panel", as in a display file.
std::string_view kind_name(DisplayKind kind);

}  // namespace xorvox::display
