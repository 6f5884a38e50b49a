// Dither: the thresholds that decide between two levels.
//
// The thresholds of a frame are a matrix of three dimensions that repeats every kDitherPeriod samples along each: at
// column c, row r of panel p in slice s of the wire, and in frame n,
//
//   threshold = (i + ½) / 64,   i = (15·c + 23·r + 29·s + 21·p + 39·n) mod 64
//
// (a lattice of rank 1). All factors are odd, so that any 64 samples in a line along columns, rows or slices, and one
// sample in 64 frames, meet every threshold exactly once: their mean is the light wanted to within 1/128 of a step. Of
// the factors of c, r and s, those were chosen whose patterns have the least of low spatial frequencies, weighted as
// the eye does, in each plane and in space; 39 is next to 64 ÷ the golden ratio, so that few frames already meet
// thresholds that are spread well. On the wire, neighbours are neighbours in space on every kind of display: on a
// rotor, slices along a circle. Near the axis, where many slices stand in one place, they are spread by the slices
// alone.
#pragma once

#include <cstdint>

namespace xorvox::host {

inline constexpr std::uint32_t kDitherPeriod = 64;
inline constexpr std::uint32_t kDitherColumnStep = 15;

/// The index i above. For the samples of a row, kDitherColumnStep is added from column to column.
constexpr std::uint32_t dither_index(std::uint32_t slice, std::uint32_t panel, std::uint32_t row, std::uint32_t column,
                                     std::uint32_t number) {
    return (kDitherColumnStep * column + 23 * row + 29 * slice + 21 * panel + 39 * number) % kDitherPeriod;
}

/// Above 0 and below 1: what is further than this from the level below takes the level above.
constexpr float dither_threshold(std::uint32_t index) {
    return (static_cast<float>(index % kDitherPeriod) + 0.5f) / static_cast<float>(kDitherPeriod);
}

}  // namespace xorvox::host
