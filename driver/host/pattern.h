// Patterns: pictures that tell what is wrong with a display that has just been built. docs/bring-up.md walks through
// them.
//
// They are drawn on pixels as they are wired (panel, row, column, slice) and on nothing else: a model's voxels would
// hide a swapped panel among correct ones. Where a pattern has a left, a top or a radius, it takes them from what the
// display file says of the mounting (mirrored, turned, shift_mm, offset_mm, angle_deg), so that a mark which stands
// askew shows what the file has wrong, and stands right once the file is.
//
//   panels       Panel p has p + 1 upright bars in a colour of its own, red for panel 0; every slice alike.
//   orientation  An F on every panel; every slice alike. On panels of less than 3 × 5 pixels a hook, long arm on top.
//   stairs       Slice s lights the column at s/S of the width. Where there is one slice alone, every tenth pixel.
//   index        Where a cycle begins, in white, and a quarter of a turn or cycle later, in green. Rotors: a spoke of
//                8 degrees along +x and a dashed one, by one side of one panel. Others: slice 0, and the border of
//                slice S/4, which is a quarter of the time up, and of the height where slices are even. One slice
//                alone: the first pixel, and the one a quarter through.
//   axis         Rotors: a cylinder wall in bands, from the lowest row up: panel 0 right side, left side, panel 1 …;
//                its top and bottom rows are rings of arcs, by one side after the other; about the axis a post, in each
//                band by that band's panel. axis_bands() says where each is to stand. Stacks
//                and swept planes: border and a rectangle of half its size, in every slice; helix: circles instead.
//                Free points: those farthest out along x in red, y in green, z in blue.
//   wedge        All levels but dark: along the columns (of rotors, outwards from the axis) in the upper third, slice
//                by slice in the middle, row by row below.
//   all          Every pixel at its faintest code that is shown: on mono1 and rgb111, that is full light.
//   planes       Moves: one bit of one channel in every pixel; red, green, blue, most significant bits first.
//   lines        Moves: each row, then each column, of each panel; every slice alike.
//   walk         Moves: one pixel, in the order of the wire.
//
// Of a slice's pixels, panels and stairs light at most half where panels are wide enough for their bars, orientation
// 0.7 (0.4 from 16 × 16 pixels on), index on rotors half a panel; index else, wedge, all and planes up to all of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "driver/display/description.h"
#include "voxelizer/error.h"

namespace xorvox::host {

enum class Pattern : std::uint8_t { Panels, Orientation, Stairs, Index, Axis, Wedge, All, Planes, Lines, Walk };

struct PatternInfo {
    Pattern pattern{};
    std::string_view name;     ///< As on the command line.
    std::string_view summary;  ///< One line: what it answers.
    bool moves = false;
    bool at_rest = false;  ///< Of rotors: alike in every slice, to be read while it stands still.
};

/// Every pattern, in the order in which a builder wants them. Static storage.
std::span<const PatternInfo> patterns();

/// The pattern of this name. The message for any other lists all of them.
Expected<PatternInfo> find_pattern(std::string_view name);

/// Frames that show all of a pattern, one a cycle of the display: 1 where it stands still. Bits stand for a second,
/// lines for a tenth of one, or a cycle where that is longer. `display` must be valid (validate_display).
std::uint64_t pattern_frames(const DisplayDescription& display, Pattern pattern);

/// A band of the wall that `axis` draws on a rotor: one side of one panel, and where its light is by the file.
struct AxisBand {
    std::uint32_t panel = 0;
    bool right_side = true;
    double radius_mm = 0.0;  ///< From the axis; of a tilted panel, half-way up the band; of a skewed one, even columns.
    double low_arc_mm = 0.0;  ///< Heights of its arcs.
    double high_arc_mm = 0.0;
};
/// The bands from the lowest up; none where `display`, which must be valid, is no rotor. The display is as its file
/// says if its bands stand at these distances: those of interleaved panels do not all stand at the same one.
std::vector<AxisBand> axis_bands(const DisplayDescription& display);

/// The slice whose border `index` lights, where there is more than one and the display is no rotor.
std::uint32_t index_border_slice(const DisplayDescription& display);

/// What is lit in a frame.
struct PatternLight {
    std::uint64_t pixels = 0;
    std::uint64_t most_in_slice = 0;
};

/// Writes frame `number` of `pattern` to `frame`, which has frame_bytes(display); numbers beyond pattern_frames() begin
/// anew. The same bytes on every machine. `display` must be valid. No allocation; any number of threads.
PatternLight paint_pattern(const DisplayDescription& display, Pattern pattern, std::uint64_t number,
                           std::span<std::byte> frame);

}  // namespace xorvox::host
