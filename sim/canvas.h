// Canvas: smooth lines, spots and words on an image.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include <glm/vec2.hpp>

#include "sim/image.h"

namespace xorvox::sim {

/// Red, green, blue of sRGB.
using Color = std::array<std::uint8_t, 3>;

/// How a line is broken: lengths of pixels drawn and left out, in turns. Empty: it is not.
using Dashes = std::span<const double>;

/// Pixels, x to the right and y down; the centre of the first one is (0.5, 0.5). What lies outside is left out.
class Canvas {
public:
    Canvas(std::uint32_t width, std::uint32_t height, Color background);

    /// A line through `points`. The dashes run on round its corners.
    void line(std::span<const glm::dvec2> points, double width, Color color, Dashes dashes = {});
    void line(glm::dvec2 from, glm::dvec2 to, double width, Color color);
    void disc(glm::dvec2 center, double radius, Color color);
    /// With sides of 2 · `radius`.
    void square(glm::dvec2 center, double radius, Color color);
    /// From corner to corner.
    void box(glm::dvec2 lower, glm::dvec2 upper, Color color);
    /// With diagonals of 2 · `radius`.
    void diamond(glm::dvec2 center, double radius, Color color);
    /// `text` with the left end of the line that its letters stand on at `at`.
    void text(glm::ivec2 at, std::string_view text, Color color);

    const sim::Image& image() const { return image_; }

private:
    /// Paints each pixel of the box by `cover`, the part of it that is covered, from 0 to 1, of its centre.
    template <class Cover>
    void paint(glm::dvec2 lower, glm::dvec2 upper, Color color, const Cover& cover);

    sim::Image image_;
};

/// Pixels that Canvas::text() takes: from the first letter's left side to the last one's right side, and from the line
/// that they stand on to their top.
int text_width(std::string_view text);
int text_height();

}  // namespace xorvox::sim
