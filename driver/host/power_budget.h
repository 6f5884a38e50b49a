// PowerBudget: keeps the light of frames within what the display's supply gives, before the device has to.
//
// The device dims a slice that would draw too much (driver/device/current.h), slice by slice, so that bright slices
// would look darker than they are beside others. The host dims whole frames instead, at once where a frame needs it and
// back again slowly, so that nothing flickers:
//
//   paint(frame); while (!budget.allows(frame)) { painter.set_brightness(… budget.factor()); paint(frame); }
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "driver/display/description.h"

namespace xorvox::host {

/// What a display's frames draw. Any number of threads may use one.
class CurrentMeter {
public:
    /// `display` must be valid. Throws std::bad_alloc.
    explicit CurrentMeter(const DisplayDescription& display);

    /// The highest average current of a slice of `frame` in milliamperes, at the device's full brightness; where LEDs
    /// keep their colour, the whole frame's. An LED at level l of m draws l/m of led_ma for 1/row_groups of the time.
    /// `frame` is frame_bytes(display) long, with its padding dark. 0 where led_ma is not known.
    double most_ma(std::span<const std::byte> frame) const;

private:
    std::size_t lit_bytes_ = 0;  ///< Of the slices that are lit together.
    std::vector<std::size_t> row_bytes_;
    double ma_per_weight_ = 0.0;
    /// By the place of a byte in a row, which repeats, and its value: levels, so weighted that those of channels with
    /// different numbers of bits can be added.
    std::vector<std::array<std::uint32_t, 256>> weights_;
};

/// The factor of brightness at which frames keep within the display's limit_ma. One thread.
class PowerBudget {
public:
    /// By how much the factor rises from frame to frame at most: doubled in 35 frames.
    static constexpr float kRelease = 1.02f;

    /// The least factor: with it even the steepest response shows set voxels as faint as it can.
    static constexpr float kLeast = 0x1p-24f;

    /// factor() is always 1 where the display does not tell both limit_ma and led_ma.
    explicit PowerBudget(const DisplayDescription& display);

    /// By which brightness is to be multiplied for the next frame: kLeast … 1.
    float factor() const { return factor_; }

    /// Says whether `frame`, painted with factor(), may be shown, and sets factor() for the next one, at most kRelease
    /// times higher and not so high that a frame like this one would draw too much. False: it draws too much; factor()
    /// is lower now, paint it again. After kMostTries in a row, or one that did not help, the frame is allowed: set
    /// voxels are never quite dark, and what then is too much the device dims. A try that did not help leaves factor()
    /// as it was before it.
    bool allows(std::span<const std::byte> frame);
    static constexpr int kMostTries = 8;

private:
    CurrentMeter meter_;
    double limit_ma_ = 0.0;
    float factor_ = 1.0f;
    int tries_ = 0;
    // Of the try before.
    double last_ma_ = 0.0;
    float last_factor_ = 1.0f;
};

}  // namespace xorvox::host
