// SliceSchedule: which slice is lit at which phase.
//
//   rotors, helix, stacks    slices 0 … S−1 share the cycle
//                            a rotor of half turns shows every second cycle (1, 3, 5 …) mirrored
//   swept plane              up:    dead │ 0 1 … S−1 │ dead      in the first half of the cycle
//                            down:  dead │ S−1 … 1 0 │ dead      in the second half; dark where it flies back
//   free points, and strings of LEDs that keep their colour: one slice, which is the whole frame, all of the cycle
//
// Integers only; driver/device/config.h computes it from a description.
#pragma once

#include <array>
#include <cstdint>

#include "driver/device/phase.h"

namespace xorvox::device {

struct SliceSchedule {
    /// A part of the cycle in which all slices are lit once, one after the other.
    struct Stroke {
        std::uint64_t begin = 0;        ///< Phase within the cycle, below kCycle.
        std::uint64_t length = kCycle;  ///< At least one for each slice.
        bool downwards = false;         ///< From the last slice to the first.
    };

    std::uint32_t slices = 1;         ///< 1 … kMaxSlices.
    std::uint32_t stroke_count = 1;   ///< 1 or 2.
    std::array<Stroke, 2> strokes{};  ///< In order, without overlap.
    bool mirrors_odd_cycles = false;

    struct Place {
        bool lit = false;
        std::uint32_t slice = 0;
        /// Each row of each panel is scanned out from its last column to its first.
        bool mirrored = false;
        Phase begin = 0;  ///< Of the slice; dark: of the dark part, or of the cycle.
        Phase end = 0;    ///< The first phase after it.
    };

    /// What is lit at `phase`. Never a slice out of range; begin ≤ phase < end, by their differences.
    constexpr Place at(Phase phase) const {
        const Phase cycle = phase / kCycle * kCycle;
        const std::uint64_t part = phase % kCycle;
        Place dark{.begin = cycle, .end = cycle + kCycle};
        for (std::uint32_t i = 0; i < stroke_count; ++i) {
            const Stroke& stroke = strokes[i];
            if (part < stroke.begin) {
                dark.end = cycle + stroke.begin;
                break;
            }
            const std::uint64_t into = part - stroke.begin;
            if (into >= stroke.length) {
                dark.begin = cycle + stroke.begin + stroke.length;
                continue;
            }
            const std::uint64_t nth = into * slices / stroke.length;
            const auto edge = [&](std::uint64_t n) {
                return cycle + stroke.begin + (n * stroke.length + slices - 1) / slices;
            };
            return {.lit = true,
                    .slice = static_cast<std::uint32_t>(stroke.downwards ? slices - 1 - nth : nth),
                    .mirrored = mirrors_odd_cycles && cycle_of(phase) % 2 == 1,
                    .begin = edge(nth),
                    .end = edge(nth + 1)};
        }
        return dark;
    }
};

}  // namespace xorvox::device
