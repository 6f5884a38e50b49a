// ColorField: a colour for every point of space, asked for at set voxels only (Rueda et al., section 5 and Figure 4).
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include <glm/vec3.hpp>

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

/// Linear light of a colour as users type it: a name, or #rrggbb in sRGB. The message for anything else lists the names.
Expected<glm::dvec3> parse_color_name(std::string_view text);

/// What `--color` takes. The message for anything else lists what is allowed. COLOR is a name or #rrggbb (sRGB).
///
///   constant:COLOR          one colour
///   gradient                azure, turquoise, green and gold, from bottom to top, in steps that keep this order in
///                           every pixel format
///   gradient:COLOR,COLOR    from bottom to top, mixed evenly to the eye (Oklab)
///   noise, noise:SCALE      Perlin's noise through a palette; SCALE cells along each side of the box, 0.1 … 256,
///   default 4
///   expr:EXPRESSION         a formula of the point, as in "expr: hsv(0.5 + 0.5*noise(8*p), 1, z)" (docs/color.md); a
///                           scalar is grey. Columns in messages count from 1 behind the colon.
///
/// The same bits on every machine. Apart from what the user names or computes, no point is dark: the strongest channel
/// is at least 0.5.
Expected<std::unique_ptr<ColorField>> parse_color(std::string_view spec);

}  // namespace xorvox::host
