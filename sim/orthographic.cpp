#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "driver/display/lattice.h"
#include "sim/develop.h"
#include "sim/label.h"
#include "sim/outline.h"
#include "sim/picture.h"
#include "sim/surface.h"

namespace xorvox::sim {
namespace {

constexpr std::uint32_t kFiner = 2;  ///< Drawn so many times larger, and averaged.
constexpr float kFarthest = 0.3f;    ///< Brightness of the farthest light.
constexpr float kGlow = 0.2f;
constexpr glm::vec3 kTile(0.005f, 0.006f, 0.0085f);   ///< Added to the ground behind a view,
constexpr glm::vec3 kInside(0.011f, 0.013f, 0.018f);  ///< and where the display is.
constexpr glm::vec3 kMark(0.040f, 0.050f, 0.068f);

/// Which way the world lies in a view: the axes that run to the right, up, and towards who looks.
struct View {
    int right;
    int up;
    int towards;
    double towards_sign;
    std::string_view name;
};
constexpr std::array<View, 3> kViews = {{{0, 2, 1, -1.0, "front"}, {1, 2, 0, 1.0, "side"}, {0, 1, 2, 1.0, "top"}}};

/// Half a voxel's size along the world's axes.
glm::dvec3 upright_half(const Voxel& voxel) {
    const glm::vec2 across = glm::abs(voxel.across);
    return kVoxelFilling * glm::vec3(across.x * voxel.half_mm.x + across.y * voxel.half_mm.y,
                                     across.y * voxel.half_mm.x + across.x * voxel.half_mm.y, voxel.half_mm.z);
}

/// A box of space.
struct Box {
    glm::dvec3 lower{0.0};
    glm::dvec3 upper{0.0};
};

/// The box that holds the voxels as they are drawn.
Box box_of(const std::vector<Voxel>& voxels) {
    Box box{voxels[0].place_mm, voxels[0].place_mm};
    for (const Voxel& voxel : voxels) {
        box.lower = glm::min(box.lower, voxel.place_mm - upright_half(voxel));
        box.upper = glm::max(box.upper, voxel.place_mm + upright_half(voxel));
    }
    return box;
}

/// The box that holds all of a display, its marks, and light outside of it.
Box box_of(const DisplayExtent& display, const std::vector<Segment>& marked, const std::vector<Voxel>& voxels) {
    Box box{display.lower, display.upper};
    const auto include = [&box](const glm::dvec3& lower, const glm::dvec3& upper) {
        box.lower = glm::min(box.lower, lower);
        box.upper = glm::max(box.upper, upper);
    };
    for (const Segment& mark : marked) include(glm::min(mark.from_mm, mark.to_mm), glm::max(mark.from_mm, mark.to_mm));
    if (voxels.empty()) return box;
    const Box light = box_of(voxels);
    include(light.lower, light.upper);
    return box;
}

/// Where the views are on the sheet, in pixels: tiles side by side, of one height, as wide as their views need, in
/// which one millimetre is as long everywhere.
struct Layout {
    Layout(const Box& box, std::uint32_t side)
        : gutter(side / 60), label_size(side / 240), height(side - 2 * gutter), label_space(12 * label_size) {
        const double pad = std::max(side / 20.0, 1.0);
        glm::dvec3 wide(0.0);
        double high = 0.0;
        for (int i = 0; i < 3; ++i) {
            const View& view = kViews[static_cast<std::size_t>(i)];
            wide[i] = box.upper[view.right] - box.lower[view.right];
            high = std::max(high, box.upper[view.up] - box.lower[view.up]);
        }
        const double room = 3.0 * side - 4.0 * gutter - 6.0 * pad;
        const double all = wide.x + wide.y + wide.z;
        scale = std::min(room / all, (height - label_space - 2.0 * pad) / high);
        double right = gutter;
        for (std::size_t i = 0; i < kViews.size(); ++i) {
            left[i] = static_cast<std::uint32_t>(right);
            right += wide[static_cast<int>(i)] * scale + (room - all * scale) / 3.0 + 2.0 * pad;
            width[i] = static_cast<std::uint32_t>(right) - left[i];
            right += gutter;
        }
    }

    std::uint32_t gutter;       ///< Between tiles and around them.
    std::uint32_t label_size;   ///< 0 where a label would be too large.
    std::uint32_t height;       ///< Of each tile.
    std::uint32_t label_space;  ///< At the top of each tile.
    double scale = 1.0;         ///< Pixels a millimetre.
    std::array<std::uint32_t, 3> left{};
    std::array<std::uint32_t, 3> width{};
};

/// One view, with a depth for each fine pixel.
class Canvas {
public:
    Canvas(const View& view, const Box& box, std::uint32_t width, std::uint32_t height, std::uint32_t label_space,
           double scale)
        : view_(view),
          box_(box),
          width_(width * kFiner),
          height_(height * kFiner),
          scale_(scale * kFiner),
          middle_column_(width_ / 2.0),
          middle_row_((height_ + label_space * kFiner) / 2.0),
          film_{width_, height_, std::vector<glm::vec4>(std::size_t{width_} * height_)},
          depth_(film_.pixels.size(), -std::numeric_limits<double>::infinity()) {}

    void draw_ground(const DisplayExtent& display) {
        const glm::dvec3 centre = (display.lower + display.upper) / 2.0;
        const glm::dvec3 half = (display.upper - display.lower) / 2.0;
        const bool round = display.radius_mm > 0.0 && view_.towards == 2;
        for (std::uint32_t row = 0; row < height_; ++row) {
            for (std::uint32_t column = 0; column < width_; ++column) {
                const double u = std::abs(right_mm(column) - centre[view_.right]);
                const double v = std::abs(up_mm(row) - centre[view_.up]);
                const bool inside =
                    round ? std::hypot(u, v) <= display.radius_mm : u <= half[view_.right] && v <= half[view_.up];
                pixel(column, row) = glm::vec4(inside ? kInside : kTile, 0.0f);
            }
        }
    }

    /// Draws a line on the ground; what is drawn after it hides it.
    void draw(const Segment& line) {
        const glm::dvec2 from(column_at(line.from_mm[view_.right]), row_at(line.from_mm[view_.up]));
        const glm::dvec2 to(column_at(line.to_mm[view_.right]), row_at(line.to_mm[view_.up]));
        const double steps = std::ceil(glm::distance(from, to)) + 1.0;
        for (double step = 0.0; step <= steps; ++step) {
            const glm::dvec2 at = glm::mix(from, to, step / steps);
            const Range columns = range(at.x - 1.0, at.x + 1.0, width_);
            const Range rows = range(at.y - 1.0, at.y + 1.0, height_);
            for (std::uint32_t row = rows.first; row < rows.last; ++row) {
                for (std::uint32_t column = columns.first; column < columns.last; ++column) {
                    pixel(column, row) = glm::vec4(kMark, 0.0f);
                }
            }
        }
    }

    void draw(const Voxel& voxel) {
        const glm::dvec3 half = upright_half(voxel);
        const glm::dvec3& place = voxel.place_mm;
        const Range columns = range(column_at(place[view_.right] - half[view_.right]),
                                    column_at(place[view_.right] + half[view_.right]), width_);
        const Range rows =
            range(row_at(place[view_.up] + half[view_.up]), row_at(place[view_.up] - half[view_.up]), height_);
        for (std::uint32_t row = rows.first; row < rows.last; ++row) {
            const double v = (up_mm(row) - place[view_.up]) / half[view_.up];
            for (std::uint32_t column = columns.first; column < columns.last; ++column) {
                const double u = (right_mm(column) - place[view_.right]) / half[view_.right];
                const double rest = 1.0 - u * u - v * v;
                if (rest < 0.0) continue;
                const double bulge = std::sqrt(rest);
                const double near = place[view_.towards] * view_.towards_sign + bulge * half[view_.towards];
                double& nearest = depth_[std::size_t{row} * width_ + column];
                if (near <= nearest) continue;
                nearest = near;
                const glm::vec3 bead(glm::dvec3(u, v, bulge));
                pixel(column, row) = glm::vec4(shade(voxel, bead, near), 1.0f);
            }
        }
    }

    /// Copies the view, each pixel the mean of kFiner², to `sheet` from column `left` and row `top` on.
    void put(Film& sheet, std::uint32_t left, std::uint32_t top) const {
        for (std::uint32_t row = 0; row < height_; ++row) {
            for (std::uint32_t column = 0; column < width_; ++column) {
                sheet.pixels[std::size_t{top + row / kFiner} * sheet.width + left + column / kFiner] +=
                    film_.pixels[std::size_t{row} * width_ + column] / static_cast<float>(kFiner * kFiner);
            }
        }
    }

private:
    struct Range {
        std::uint32_t first;
        std::uint32_t last;
    };

    glm::vec4& pixel(std::uint32_t column, std::uint32_t row) {
        return film_.pixels[std::size_t{row} * width_ + column];
    }
    double middle(int axis) const { return (box_.lower[axis] + box_.upper[axis]) / 2.0; }
    double right_mm(std::uint32_t column) const {
        return middle(view_.right) + (column + 0.5 - middle_column_) / scale_;
    }
    double up_mm(std::uint32_t row) const { return middle(view_.up) - (row + 0.5 - middle_row_) / scale_; }
    double column_at(double mm) const { return (mm - middle(view_.right)) * scale_ + middle_column_; }
    double row_at(double mm) const { return (middle(view_.up) - mm) * scale_ + middle_row_; }
    /// Of `count` pixels, those whose middles are between two places; at least one, so that nothing is lost in a small
    /// picture.
    static Range range(double from, double to, std::uint32_t count) {
        const double first = std::clamp(std::ceil(from - 0.5), 0.0, count - 1.0);
        const double last = std::clamp(std::floor(to + 0.5), first + 1.0, static_cast<double>(count));
        return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last)};
    }

    glm::vec3 shade(const Voxel& voxel, const glm::vec3& bead, double near) const {
        const glm::vec3 lamp = glm::normalize(glm::vec3(-0.5f, 0.6f, 0.65f));
        const glm::vec3 body(voxel.normal[view_.right], voxel.normal[view_.up],
                             voxel.normal[view_.towards] * static_cast<float>(view_.towards_sign));
        const glm::vec3 mixed = glm::mix(bead, body, body.z > 0.0f ? 0.6f : 0.0f);
        const float lit = std::max(glm::dot(glm::normalize(mixed), lamp), 0.0f);
        const double size = box_.upper[view_.towards] - box_.lower[view_.towards];
        const double front = view_.towards_sign > 0.0 ? box_.upper[view_.towards] : -box_.lower[view_.towards];
        const double behind = std::clamp((front - near) / size, 0.0, 1.0);
        const float faded = glm::mix(1.0f, kFarthest, static_cast<float>(behind));
        return voxel.light * (faded * (0.3f + 1.0f * lit));
    }

    View view_;
    Box box_;  ///< Of the light.
    std::uint32_t width_;
    std::uint32_t height_;
    double scale_;  ///< Fine pixels a millimetre.
    double middle_column_;
    double middle_row_;
    Film film_;
    std::vector<double> depth_;
};

}  // namespace

Picture render_orthographic(const DisplayDescription& display, const LightField& field, std::uint32_t side,
                            Framing framing) {
    assert(side >= 16 && side <= 2048);
    const std::vector<Voxel> voxels = visible_voxels(display, field);
    const DisplayExtent space = drawn_extent(display);
    std::vector<Segment> marked;
    if (framing == Framing::Display) marked = marks(display);
    const bool whole = framing == Framing::Display || voxels.empty();
    const Box box = whole ? box_of(space, marked, voxels) : box_of(voxels);
    const Layout layout(box, side);

    Film sheet{3 * side, side, std::vector<glm::vec4>(std::size_t{3} * side * side)};
    for (std::size_t i = 0; i < kViews.size(); ++i) {
        Canvas canvas(kViews[i], box, layout.width[i], layout.height, layout.label_space, layout.scale);
        canvas.draw_ground(space);
        for (const Segment& mark : marked) canvas.draw(mark);
        for (const Voxel& voxel : voxels) canvas.draw(voxel);
        canvas.put(sheet, layout.left[i], layout.gutter);
        draw_label(sheet, kViews[i].name, layout.left[i] + layout.gutter, 2 * layout.gutter, layout.label_size);
    }
    Picture picture;
    picture.image = develop(sheet, kGlow);
    picture.cover = cover_of(sheet);
    picture.covered = covered_share(sheet);
    picture.clipped = clipped_share(picture.image);
    picture.drawn_by = "CPU";
    return picture;
}

}  // namespace xorvox::sim
