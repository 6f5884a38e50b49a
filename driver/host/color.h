// ColorField: a colour for every point of space, asked for at set voxels only (Rueda et al., section 5 and Figure 4).
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include <glm/vec3.hpp>

#include "driver/host/color_list.h"
#include "voxelizer/error.h"

namespace xorvox::host {

/// A volumetric colour function. Colours are linear light, 0 … 1 per channel of sRGB primaries.
class ColorField {
public:
    virtual ~ColorField() = default;
    /// `points`: 0 … 1 along x, y and z of the lattice's box. `colors` has as many entries. Any number of threads.
    virtual void evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> colors) const = 0;
    /// The colour that it has everywhere, if it has one: then it need not be asked point by point.
    virtual std::optional<glm::vec3> constant() const { return std::nullopt; }
};

/// The kinds that parse_color() takes, as messages list them.
inline constexpr std::string_view kColorKinds =
    "constant:NAME, constant:#rrggbb, gradient, gradient:COLOR,COLOR, radial:COLOR,COLOR, spherical:COLOR,COLOR, "
    "noise, "
    "noise:SCALE, simplex, simplex:SCALE, expr:EXPRESSION";

/// A colour function that needs no file. The message for anything else lists what is allowed. COLOR is a name or
/// #rrggbb (sRGB); lists have two colours or more, mixed evenly to the eye (Oklab).
///
///   constant:COLOR          one colour
///   gradient                blue, turquoise, green and gold, from bottom to top, in steps that keep this order in
///                           every pixel format
///   gradient:COLOR,COLOR    from bottom to top
///   radial:COLOR,COLOR      by distance from the upright axis through the middle of the box: the first colour there,
///                           the last at half the box's side and beyond
///   spherical:COLOR,COLOR   the same by distance from the centre of the box
///   noise, noise:SCALE      Perlin's noise through a palette; SCALE cells along each side of the box, 0.1 … 256,
///                           default 4
///   simplex, simplex:SCALE  the same with simplex noise, which is finer and less aligned with the axes
///   expr:EXPRESSION         a formula of the point, as in "expr: hsv(0.5 + 0.5*noise(8*p), 1, z)" (docs/color.md); a
///                           scalar is grey. Columns in messages count from 1 behind the colon.
///
/// Distances are in the box's own measure, along each axis 0 … 1, so that in a flat box circles become ellipses. The
/// same bits on every machine. Apart from what the user names or computes, no point is dark: the strongest channel is
/// at least 0.5.
Expected<std::unique_ptr<ColorField>> parse_color(std::string_view spec);

}  // namespace xorvox::host
