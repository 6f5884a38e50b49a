#include "sim/canvas.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "sim/font.h"

namespace xorvox::sim {
namespace {

constexpr int kLetterScale = 2;

/// How much of a pixel is covered by a shape whose edge is `distance` pixels outside of its centre.
double coverage(double distance) {
    return std::clamp(0.5 - distance, 0.0, 1.0);
}

double distance_to_segment(glm::dvec2 point, glm::dvec2 from, glm::dvec2 to) {
    const glm::dvec2 along = to - from;
    const double length2 = glm::dot(along, along);
    const double t = length2 > 0.0 ? std::clamp(glm::dot(point - from, along) / length2, 0.0, 1.0) : 0.0;
    return glm::distance(point, from + t * along);
}

/// The broken pieces of a line, one after the other.
template <class Draw>
void for_each_dash(std::span<const glm::dvec2> points, Dashes dashes, const Draw& draw) {
    std::size_t dash = 0;
    double left = dashes.empty() ? 0.0 : dashes[0];
    for (std::size_t i = 1; i < points.size(); ++i) {
        const double length = glm::distance(points[i - 1], points[i]);
        if (dashes.empty()) draw(points[i - 1], points[i]);
        if (dashes.empty() || length <= 0.0) continue;
        const glm::dvec2 along = (points[i] - points[i - 1]) / length;
        for (double at = 0.0; at < length;) {
            const double end = std::min(length, at + left);
            if (dash % 2 == 0) draw(points[i - 1] + at * along, points[i - 1] + end * along);
            left -= end - at;
            at = end;
            // Not 0, because so short a rest would never move `at`.
            if (left < 1e-6) left = dashes[++dash % dashes.size()];
        }
    }
}

}  // namespace

Canvas::Canvas(std::uint32_t width, std::uint32_t height, Color background) {
    image_.width = width;
    image_.height = height;
    image_.rgb.resize(std::size_t{3} * width * height);
    for (std::size_t i = 0; i < image_.rgb.size(); ++i) image_.rgb[i] = background[i % 3];
}

template <class Cover>
void Canvas::paint(glm::dvec2 lower, glm::dvec2 upper, Color color, const Cover& cover) {
    const glm::dvec2 corner(image_.width, image_.height);
    const glm::uvec2 begin(glm::clamp(glm::floor(lower - 1.0), glm::dvec2(0.0), corner));
    const glm::uvec2 end(glm::clamp(glm::ceil(upper + 1.0), glm::dvec2(0.0), corner));
    for (unsigned y = begin.y; y < end.y; ++y) {
        for (unsigned x = begin.x; x < end.x; ++x) {
            const double part = cover(glm::dvec2(x + 0.5, y + 0.5));
            std::uint8_t* const pixel = &image_.rgb[(std::size_t{y} * image_.width + x) * 3];
            for (std::size_t c = 0; c < 3; ++c) {
                pixel[c] = static_cast<std::uint8_t>(std::lround(pixel[c] + part * (color[c] - pixel[c])));
            }
        }
    }
}

void Canvas::line(std::span<const glm::dvec2> points, double width, Color color, Dashes dashes) {
    for_each_dash(points, dashes, [&](glm::dvec2 from, glm::dvec2 to) {
        paint(glm::min(from, to) - width, glm::max(from, to) + width, color,
              [&](glm::dvec2 p) { return coverage(distance_to_segment(p, from, to) - 0.5 * width); });
    });
}

void Canvas::line(glm::dvec2 from, glm::dvec2 to, double width, Color color) {
    const glm::dvec2 ends[] = {from, to};
    line(ends, width, color);
}

void Canvas::disc(glm::dvec2 center, double radius, Color color) {
    paint(center - radius, center + radius, color,
          [&](glm::dvec2 p) { return coverage(glm::distance(p, center) - radius); });
}

void Canvas::square(glm::dvec2 center, double radius, Color color) {
    paint(center - radius, center + radius, color, [&](glm::dvec2 p) {
        const glm::dvec2 away = glm::abs(p - center);
        return coverage(std::max(away.x, away.y) - radius);
    });
}

void Canvas::box(glm::dvec2 lower, glm::dvec2 upper, Color color) {
    paint(lower, upper, color, [&](glm::dvec2 p) {
        const glm::dvec2 covered = glm::min(p + 0.5, upper) - glm::max(p - 0.5, lower);
        return std::max(covered.x, 0.0) * std::max(covered.y, 0.0);
    });
}

void Canvas::diamond(glm::dvec2 center, double radius, Color color) {
    paint(center - radius, center + radius, color, [&](glm::dvec2 p) {
        const glm::dvec2 away = glm::abs(p - center);
        return coverage((away.x + away.y - radius) / std::numbers::sqrt2);
    });
}

void Canvas::text(glm::ivec2 at, std::string_view text, Color color) {
    for (const char letter : text) {
        const Glyph& shape = glyph(letter);
        for (int row = 0; row < kGlyphHeight; ++row) {
            const std::string_view dots = shape[static_cast<std::size_t>(row)];
            for (int column = 0; column < static_cast<int>(dots.size()); ++column) {
                if (dots[static_cast<std::size_t>(column)] == ' ') continue;
                const glm::dvec2 corner = at + kLetterScale * glm::ivec2(column, row - kGlyphAscent);
                square(corner + 0.5 * kLetterScale, 0.5 * kLetterScale, color);
            }
        }
        at.x += kLetterScale * kGlyphAdvance;
    }
}

int text_width(std::string_view text) {
    if (text.empty()) return 0;
    return kLetterScale * (kGlyphAdvance * static_cast<int>(text.size()) - (kGlyphAdvance - kGlyphWidth));
}

int text_height() {
    return kLetterScale * kGlyphAscent;
}

}  // namespace xorvox::sim
