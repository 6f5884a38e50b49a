#include "sim/surface.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>

namespace xorvox::sim {
namespace {

constexpr std::size_t kMostCells = std::size_t{1} << 26;
constexpr int kMargin = 6;  ///< Dark cells around the light, so that filters need not ask where the grid ends.

/// How densely a display's samples fill its space.
struct Spacing {
    bool rotates = false;
    double across_mm = 1.0;      ///< Between columns.
    double along_mm = 1.0;       ///< Between rows of a plane. Rotating panels: slices at the rim.
    double up_mm = 1.0;          ///< Between planes, or rows of a rotating panel.
    double slice_rad = 0.0;      ///< Rotating panels: the angle of a slice.
    double times_covered = 1.0;  ///< How often all pixels of a cycle fill the space.
};

Spacing spacing_of(const DisplayDescription& display) {
    const Panel& first = display.panels[0];
    if (display.kind == DisplayKind::StackedPlanes) {
        return {false, first.column_pitch_mm, first.row_pitch_mm, display.plane_pitch_mm, 0.0, 1.0};
    }
    Spacing spacing{true, 0.0, 0.0, 0.0, 2.0 * std::numbers::pi / display.slices, 0.0};
    double rim_mm = 0.0;
    double swept_mm2 = 0.0;
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        const Panel& panel = display.panels[p];
        const double half_width = panel.columns * panel.column_pitch_mm / 2.0;
        spacing.across_mm = std::max(spacing.across_mm, panel.column_pitch_mm);
        spacing.up_mm = std::max(spacing.up_mm, panel.row_pitch_mm);
        rim_mm = std::max(rim_mm, std::hypot(std::abs(panel.shift_mm) + half_width, panel.offset_mm));
        const double right = panel.shift_mm + half_width;
        const double left = panel.shift_mm - half_width;
        swept_mm2 += std::numbers::pi * std::abs(right * std::abs(right) - left * std::abs(left));
    }
    spacing.along_mm = rim_mm * spacing.slice_rad;
    spacing.times_covered = swept_mm2 / (std::numbers::pi * rim_mm * rim_mm);
    return spacing;
}

double slice_width_mm(const Spacing& spacing, const glm::dvec3& place_mm) {
    return std::max(std::hypot(place_mm.x, place_mm.y), spacing.across_mm / 4.0) * spacing.slice_rad;
}

struct Bounds {
    glm::dvec3 lower{std::numeric_limits<double>::infinity()};
    glm::dvec3 upper{-std::numeric_limits<double>::infinity()};
};

Bounds bounds_of(const LightField& field) {
    Bounds bounds;
    for (const Flash& flash : field.flashes) {
        bounds.lower = glm::min(bounds.lower, flash.place_mm);
        bounds.upper = glm::max(bounds.upper, flash.place_mm);
    }
    return bounds;
}

/// A number for each cell of a box of space.
class Grid {
public:
    Grid(const Bounds& bounds, const Spacing& spacing) : cell_mm_(spacing.across_mm, spacing.along_mm, spacing.up_mm) {
        if (spacing.rotates) cell_mm_.x = cell_mm_.y = std::max(spacing.across_mm, spacing.along_mm);
        for (;; cell_mm_ *= 2.0) {
            const glm::dvec3 cells = glm::floor((bounds.upper - bounds.lower) / cell_mm_) + (1.0 + 2.0 * kMargin);
            if (cells.x * cells.y * cells.z > static_cast<double>(kMostCells)) continue;
            size_ = {static_cast<std::size_t>(cells.x), static_cast<std::size_t>(cells.y),
                     static_cast<std::size_t>(cells.z)};
            break;
        }
        // Half a cell, and not on the borders of cells: lattices that are as regular as the grid fall in the middle.
        origin_mm_ = bounds.lower - (kMargin + 0.5) * cell_mm_;
        values_.assign(size_[0] * size_[1] * size_[2], 0.0f);
    }

    glm::dvec3 cell_mm() const { return cell_mm_; }
    std::size_t index_of(const glm::dvec3& place_mm) const {
        const glm::dvec3 at = (place_mm - origin_mm_) / cell_mm_;
        return (static_cast<std::size_t>(at.z) * size_[1] + static_cast<std::size_t>(at.y)) * size_[0] +
               static_cast<std::size_t>(at.x);
    }
    std::size_t stride(int axis) const { return axis == 0 ? 1 : axis == 1 ? size_[0] : size_[0] * size_[1]; }
    float& operator[](std::size_t index) { return values_[index]; }
    float operator[](std::size_t index) const { return values_[index]; }

    /// Adds `amount` at a place, shared by the eight cells around it.
    void add(const glm::dvec3& place_mm, double amount) {
        const glm::dvec3 at = (place_mm - origin_mm_) / cell_mm_ - 0.5;
        const glm::dvec3 first = glm::floor(at);
        const glm::dvec3 part = at - first;
        const std::size_t base = index_of(origin_mm_ + (first + 0.5) * cell_mm_);
        for (int corner = 0; corner < 8; ++corner) {
            double share = amount;
            std::size_t index = base;
            for (int axis = 0; axis < 3; ++axis) {
                const bool next = ((corner >> axis) & 1) != 0;
                share *= next ? part[axis] : 1.0 - part[axis];
                index += next ? stride(axis) : 0;
            }
            values_[index] += static_cast<float>(share);
        }
    }

    /// new = combine(before, this, after), along each axis in turn. The outermost cells stay as they are.
    template <class Combine>
    void filter(const Combine& combine) {
        std::vector<float> line;
        for (int axis = 0; axis < 3; ++axis) {
            const std::size_t step = stride(axis);
            const std::size_t length = size_[static_cast<std::size_t>(axis)];
            line.resize(length);
            for (std::size_t start = 0; start < values_.size(); ++start) {
                if ((start / step) % length != 0) continue;
                for (std::size_t i = 0; i < length; ++i) line[i] = values_[start + i * step];
                for (std::size_t i = 1; i + 1 < length; ++i) {
                    values_[start + i * step] = combine(line[i - 1], line[i], line[i + 1]);
                }
            }
        }
    }
    void blur() {
        filter([](float a, float b, float c) { return 0.25f * a + 0.5f * b + 0.25f * c; });
    }
    /// Keeps what is surrounded.
    void erode() {
        filter([](float a, float b, float c) { return std::min({a, b, c}); });
    }

private:
    glm::dvec3 cell_mm_;
    glm::dvec3 origin_mm_{0.0};
    std::array<std::size_t, 3> size_{};
    std::vector<float> values_;
};

/// The lit places: flashes closer than a fraction of any pitch are one.
std::vector<Voxel> places_of(const LightField& field, const Bounds& bounds) {
    // Places as whole numbers of 21 bits an axis. The odd start keeps regular lattices off the borders between numbers,
    // where rounding would part two flashes at one place.
    constexpr double kSteps = 2097000.0;
    const glm::dvec3 step = glm::max((bounds.upper - bounds.lower) / kSteps, glm::dvec3(1e-9));
    const glm::dvec3 start = bounds.lower - step * glm::dvec3(0.381966, 0.445042, 0.302776);
    struct Keyed {
        std::uint64_t key;
        std::uint32_t flash;
    };
    std::vector<Keyed> keyed;
    keyed.reserve(field.flashes.size());
    for (const Flash& flash : field.flashes) {
        const glm::dvec3 at = (flash.place_mm - start) / step;
        const std::uint64_t key = static_cast<std::uint64_t>(at.x) << 42 | static_cast<std::uint64_t>(at.y) << 21 |
                                  static_cast<std::uint64_t>(at.z);
        keyed.push_back({key, static_cast<std::uint32_t>(keyed.size())});
    }
    std::sort(keyed.begin(), keyed.end(),
              [](const Keyed& a, const Keyed& b) { return a.key != b.key ? a.key < b.key : a.flash < b.flash; });

    std::vector<Voxel> voxels;
    for (std::size_t first = 0, last = 0; first < keyed.size(); first = last) {
        Voxel voxel;
        voxel.place_mm = field.flashes[keyed[first].flash].place_mm;
        for (; last < keyed.size() && keyed[last].key == keyed[first].key; ++last) {
            voxel.light += field.flashes[keyed[last].flash].light;
        }
        voxel.light /= static_cast<float>(last - first);
        voxels.push_back(voxel);
    }
    return voxels;
}

/// Gives a voxel the size of the space between it and its neighbours.
void set_size(Voxel& voxel, const Spacing& spacing) {
    double along_mm = spacing.along_mm;
    if (spacing.rotates) {
        along_mm = std::max(slice_width_mm(spacing, voxel.place_mm), spacing.across_mm);
        const glm::vec2 plan(voxel.place_mm.x, voxel.place_mm.y);
        const float radius = glm::length(plan);
        if (radius > 0.0f) voxel.across = plan / radius;
    }
    voxel.half_mm = glm::vec3(0.5 * glm::dvec3(spacing.across_mm, along_mm, spacing.up_mm));
}

glm::vec3 downhill(const Grid& density, std::size_t index) {
    glm::dvec3 slope;
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t step = density.stride(axis);
        slope[axis] = (density[index - step] - density[index + step]) / density.cell_mm()[axis];
    }
    const double length = glm::length(slope) * density.cell_mm().z;
    return length > 1e-3 ? glm::normalize(glm::vec3(slope)) : glm::vec3(0.0f);
}

}  // namespace

std::vector<Voxel> visible_voxels(const DisplayDescription& display, const LightField& field) {
    if (field.flashes.empty()) return {};
    const Spacing spacing = spacing_of(display);
    const Bounds bounds = bounds_of(field);

    Grid density(bounds, spacing);
    Grid walled_in = density;
    const glm::dvec3 cell = density.cell_mm();
    for (const Flash& flash : field.flashes) {
        const double along_mm = spacing.rotates ? slice_width_mm(spacing, flash.place_mm) : spacing.along_mm;
        const double volume = spacing.across_mm * along_mm * spacing.up_mm / spacing.times_covered;
        density.add(flash.place_mm, volume / (cell.x * cell.y * cell.z));
        walled_in[density.index_of(flash.place_mm)] = 1.0f;
    }
    walled_in.erode();
    walled_in.erode();

    std::vector<Voxel> voxels = places_of(field, bounds);
    std::erase_if(voxels, [&](const Voxel& voxel) { return walled_in[density.index_of(voxel.place_mm)] != 0.0f; });

    for (int i = 0; i < 5; ++i) density.blur();
    for (Voxel& voxel : voxels) {
        set_size(voxel, spacing);
        voxel.normal = downhill(density, density.index_of(voxel.place_mm));
    }
    for (int i = 0; i < 10; ++i) density.blur();
    for (Voxel& voxel : voxels) {
        voxel.open = 1.0f - std::clamp(density[density.index_of(voxel.place_mm)], 0.0f, 1.0f);
    }
    return voxels;
}

}  // namespace xorvox::sim
