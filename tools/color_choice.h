// What `--color` takes: the functions of driver/host/color.h, those that look into files, and a model's own colours.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "driver/host/color.h"
#include "voxelizer/error.h"

namespace xorvox::tools {

/// A colour function; null: the colours of what is shown, of which its reader knows (Content::own_color()).
using ColorChoice = std::unique_ptr<host::ColorField>;

/// The kinds that choose_color() takes, as messages and --help list them.
std::string color_kinds();

/// Everything that host::parse_color() takes, and:
///
///   texture:FILE               a volume (voxelizer/io/volume_reader.h) stretched over the display's box; numbers go
///                              through a ramp from blue by green to gold, from their least to their most
///   texture:FILE,COLOR,COLOR…  the same through a ramp of these colours; of a volume of colours they are refused
///   labels:FILE[,COLOR…]       a volume of labels, likewise: label 1 has the first colour and so on, over and over;
///                              without colours those of the file's palette, or hues that differ well
///   spherical:FILE.png         an equirectangular picture, .png, .jpg or .jpeg, by direction from the box's centre
///   own                        the model's own colours
///
/// Files are read here; an animated volume gives its first frame. FILE is what stands before the first comma: a name
/// with a comma in it cannot be used.
Expected<ColorChoice> choose_color(std::string_view spec);

}  // namespace xorvox::tools
