#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "driver/display/lattice.h"
#include "sim/develop.h"
#include "sim/picture.h"
#include "sim/surface.h"

namespace xorvox::sim {
namespace {

constexpr std::uint32_t kFiner = 2;  ///< Drawn so many times larger, and averaged.
constexpr double kFilled = 0.92;     ///< Share of a view's side that the display takes.
constexpr float kFarthest = 0.3f;    ///< Brightness of what is at the back of the display.
constexpr float kGlow = 0.2f;
constexpr glm::vec3 kInside(0.010f, 0.012f, 0.017f);  ///< Added to the ground where the display is.

/// Which way the world lies in a view: the axes that run to the right, up, and towards who looks.
struct View {
    int right;
    int up;
    int towards;
    double towards_sign;
};
constexpr std::array<View, 3> kViews = {{{0, 2, 1, -1.0}, {1, 2, 0, 1.0}, {0, 1, 2, 1.0}}};

/// Half a voxel's size along the world's axes.
glm::dvec3 upright_half(const Voxel& voxel) {
    const glm::vec2 across = glm::abs(voxel.across);
    return kVoxelFilling * glm::vec3(across.x * voxel.half_mm.x + across.y * voxel.half_mm.y,
                                     across.y * voxel.half_mm.x + across.x * voxel.half_mm.y, voxel.half_mm.z);
}

/// One view, with a depth for each fine pixel.
class Canvas {
public:
    Canvas(const View& view, const DisplayExtent& box, std::uint32_t side)
        : view_(view),
          box_(box),
          side_(side * kFiner),
          scale_(kFilled * side_ / longest(box.upper - box.lower)),
          film_{side_, side_, std::vector<glm::vec4>(std::size_t{side_} * side_)},
          depth_(film_.pixels.size(), -std::numeric_limits<double>::infinity()) {}

    void draw_ground() {
        const glm::dvec3 middle = (box_.lower + box_.upper) / 2.0;
        const glm::dvec3 half = (box_.upper - box_.lower) / 2.0;
        const bool round = box_.radius_mm > 0.0 && view_.towards == 2;
        for (std::uint32_t row = 0; row < side_; ++row) {
            for (std::uint32_t column = 0; column < side_; ++column) {
                const double u = std::abs(right_mm(column) - middle[view_.right]);
                const double v = std::abs(up_mm(row) - middle[view_.up]);
                const bool inside =
                    round ? std::hypot(u, v) <= box_.radius_mm : u <= half[view_.right] && v <= half[view_.up];
                if (inside) pixel(column, row) = glm::vec4(kInside, 0.0f);
            }
        }
    }

    void draw(const Voxel& voxel) {
        const glm::dvec3 half = upright_half(voxel);
        const glm::dvec3& place = voxel.place_mm;
        const Range columns =
            range(column_at(place[view_.right] - half[view_.right]), column_at(place[view_.right] + half[view_.right]));
        const Range rows = range(row_at(place[view_.up] + half[view_.up]), row_at(place[view_.up] - half[view_.up]));
        for (std::uint32_t row = rows.first; row < rows.last; ++row) {
            const double v = (up_mm(row) - place[view_.up]) / half[view_.up];
            for (std::uint32_t column = columns.first; column < columns.last; ++column) {
                const double u = (right_mm(column) - place[view_.right]) / half[view_.right];
                const double rest = 1.0 - u * u - v * v;
                if (rest < 0.0) continue;
                const double bulge = std::sqrt(rest);
                const double near = place[view_.towards] * view_.towards_sign + bulge * half[view_.towards];
                double& nearest = depth_[std::size_t{row} * side_ + column];
                if (near <= nearest) continue;
                nearest = near;
                const glm::vec3 bead(glm::dvec3(u, v, bulge));
                pixel(column, row) = glm::vec4(shade(voxel, bead, near), 1.0f);
            }
        }
    }

    /// Copies the view, each pixel the mean of kFiner², to `sheet` from column `left` on.
    void put(Film& sheet, std::uint32_t left) const {
        for (std::uint32_t row = 0; row < side_; ++row) {
            for (std::uint32_t column = 0; column < side_; ++column) {
                sheet.pixels[std::size_t{row / kFiner} * sheet.width + left + column / kFiner] +=
                    film_.pixels[std::size_t{row} * side_ + column] / static_cast<float>(kFiner * kFiner);
            }
        }
    }

private:
    struct Range {
        std::uint32_t first;
        std::uint32_t last;
    };

    static double longest(const glm::dvec3& size) { return std::max({size.x, size.y, size.z}); }
    glm::vec4& pixel(std::uint32_t column, std::uint32_t row) {
        return film_.pixels[std::size_t{row} * side_ + column];
    }
    double middle(int axis) const { return (box_.lower[axis] + box_.upper[axis]) / 2.0; }
    double right_mm(std::uint32_t column) const { return middle(view_.right) + (column + 0.5 - side_ / 2.0) / scale_; }
    double up_mm(std::uint32_t row) const { return middle(view_.up) - (row + 0.5 - side_ / 2.0) / scale_; }
    double column_at(double mm) const { return (mm - middle(view_.right)) * scale_ + side_ / 2.0; }
    double row_at(double mm) const { return (middle(view_.up) - mm) * scale_ + side_ / 2.0; }
    /// The pixels whose middles are between two places; at least one, so that nothing is lost in a small picture.
    Range range(double from, double to) const {
        const double first = std::clamp(std::ceil(from - 0.5), 0.0, side_ - 1.0);
        const double last = std::clamp(std::floor(to + 0.5), first + 1.0, static_cast<double>(side_));
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
    DisplayExtent box_;
    std::uint32_t side_;
    double scale_;  ///< Fine pixels a millimetre.
    Film film_;
    std::vector<double> depth_;
};

}  // namespace

Picture render_orthographic(const DisplayDescription& display, const LightField& field, std::uint32_t side) {
    assert(side >= 16 && side <= 2048);
    const std::vector<Voxel> voxels = visible_voxels(display, field);
    DisplayExtent box = extent(display);
    for (const Voxel& voxel : voxels) {
        box.lower = glm::min(box.lower, voxel.place_mm);
        box.upper = glm::max(box.upper, voxel.place_mm);
    }

    const auto views = static_cast<std::uint32_t>(kViews.size());
    Film sheet{views * side, side, std::vector<glm::vec4>(std::size_t{views} * side * side)};
    for (std::uint32_t i = 0; i < views; ++i) {
        Canvas canvas(kViews[i], box, side);
        canvas.draw_ground();
        for (const Voxel& voxel : voxels) canvas.draw(voxel);
        canvas.put(sheet, i * side);
    }
    Picture picture;
    picture.image = develop(sheet, kGlow);
    picture.covered = covered_share(sheet);
    picture.clipped = clipped_share(picture.image);
    picture.drawn_by = "CPU";
    return picture;
}

}  // namespace xorvox::sim
