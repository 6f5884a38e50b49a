#include "sim/surface.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "sim/grid.h"
#include "sim/space.h"

namespace xorvox::sim {
namespace {

constexpr std::size_t kMostDensityCells = std::size_t{1} << 23;
constexpr std::size_t kMostWallCells = std::size_t{1} << 30;

/// Of a rotating panel: how wide a slice is at a place.
double slice_width_mm(const Spacing& spacing, const glm::dvec3& place_mm) {
    return std::max(std::hypot(place_mm.x, place_mm.y), spacing.across_mm / 4.0) * spacing.slice_rad;
}

/// Space in which uneven planes are even: each is as thick as the mean, in the order in which they stand.
class EvenSpace {
public:
    EvenSpace(const DisplayDescription& display, double mean_mm) : mean_mm_(mean_mm) {
        const bool planes = display.kind == DisplayKind::StackedPlanes && !display.plane_heights_mm.empty();
        const bool sweep = display.kind == DisplayKind::SweptPlane && display.motion.profile != MotionProfile::Constant;
        if (!planes && !sweep) return;
        for (std::uint32_t slice = 0; slice <= display.slices; ++slice) {
            borders_mm_.push_back(plane_height_mm(display, slice - 0.5));
        }
    }

    glm::dvec3 operator()(glm::dvec3 place_mm) {
        if (borders_mm_.empty()) return place_mm;
        find(place_mm.z);
        place_mm.z = mean_mm_ * (static_cast<double>(plane_) + (place_mm.z - borders_mm_[plane_]) / thickness_mm());
        return place_mm;
    }

    /// How thick the plane at a height is, in means.
    double stretch_at(double z) {
        if (borders_mm_.empty()) return 1.0;
        find(z);
        return thickness_mm() / mean_mm_;
    }

private:
    /// Flashes come plane by plane: mostly it is the one of the last call.
    void find(double z) {
        if (z >= borders_mm_[plane_] && z < borders_mm_[plane_ + 1]) return;
        const auto above = std::upper_bound(borders_mm_.begin() + 1, borders_mm_.end() - 1, z);
        plane_ = static_cast<std::size_t>(above - borders_mm_.begin()) - 1;
    }
    double thickness_mm() const { return borders_mm_[plane_ + 1] - borders_mm_[plane_]; }

    double mean_mm_;
    std::vector<double> borders_mm_;  ///< Between the planes, and at the ends; empty: they are even.
    std::size_t plane_ = 0;
};

/// Of the places that `map` makes of those of the flashes.
template <class Map>
Bounds bounds_of(const LightField& field, const Map& map) {
    Bounds bounds{glm::dvec3(std::numeric_limits<double>::infinity()),
                  glm::dvec3(-std::numeric_limits<double>::infinity())};
    for (const Flash& flash : field.flashes) {
        const glm::dvec3 place = map(flash.place_mm);
        bounds.lower = glm::min(bounds.lower, place);
        bounds.upper = glm::max(bounds.upper, place);
    }
    return bounds;
}

/// The cells that lit neighbours wall in on every side, two deep.
WallGrid walled_in(const LightField& field, const Spacing& spacing, const Bounds& bounds, EvenSpace& even) {
    glm::dvec3 cell_mm(spacing.across_mm, spacing.along_mm, spacing.up_mm);
    // LEDs that stand a pitch apart in any direction leave no such cell empty.
    if (spacing.rotates) cell_mm.x = cell_mm.y = 1.5 * spacing.across_mm;
    Bounds with_slices = bounds;
    if (spacing.rotates) {
        with_slices.lower -= glm::dvec3(spacing.along_mm, spacing.along_mm, 0.0);
        with_slices.upper += glm::dvec3(spacing.along_mm, spacing.along_mm, 0.0);
    }
    WallGrid walls(Cells(with_slices, cell_mm, kMostWallCells));
    for (const Flash& flash : field.flashes) {
        const glm::dvec3 place = even(flash.place_mm);
        walls.set(place);
        if (!spacing.rotates) continue;
        const glm::dvec3 sideways = spacing.slice_rad * glm::dvec3(-place.y, place.x, 0.0);
        const int wide = static_cast<int>(std::ceil(slice_width_mm(spacing, place) / spacing.across_mm));
        for (int i = 0; wide > 1 && i < wide; ++i) walls.set(place + ((i + 0.5) / wide - 0.5) * sideways);
    }
    walls.erode();
    walls.erode();
    return walls;
}

DensityGrid density_of(const LightField& field, const Spacing& spacing, const Bounds& bounds, EvenSpace& even) {
    glm::dvec3 cell_mm(spacing.across_mm, spacing.along_mm, spacing.up_mm);
    if (spacing.rotates) cell_mm.x = cell_mm.y = std::max(spacing.across_mm, spacing.along_mm);
    const Cells cells(bounds, cell_mm, kMostDensityCells);
    DensityGrid density(cells);
    cell_mm = cells.cell_mm();
    for (const Flash& flash : field.flashes) {
        const double along_mm = spacing.rotates ? slice_width_mm(spacing, flash.place_mm) : spacing.along_mm;
        const double volume = spacing.across_mm * along_mm * spacing.up_mm / spacing.times_covered;
        density.add(even(flash.place_mm), volume / (cell_mm.x * cell_mm.y * cell_mm.z));
    }
    return density;
}

/// The lit places: flashes closer than a fraction of any pitch are one.
std::vector<Voxel> places_of(const LightField& field, const std::vector<std::uint32_t>& flashes) {
    // Places as whole numbers of 21 bits an axis. The odd start keeps regular lattices off the borders between numbers,
    // where rounding would part two flashes at one place.
    constexpr double kSteps = 2097000.0;
    const Bounds bounds = bounds_of(field, [](const glm::dvec3& place_mm) { return place_mm; });
    const glm::dvec3 step = glm::max((bounds.upper - bounds.lower) / kSteps, glm::dvec3(1e-9));
    const glm::dvec3 start = bounds.lower - step * glm::dvec3(0.381966, 0.445042, 0.302776);
    struct Keyed {
        std::uint64_t key;
        std::uint32_t flash;
    };
    std::vector<Keyed> keyed;
    keyed.reserve(flashes.size());
    for (const std::uint32_t flash : flashes) {
        const glm::dvec3 at = (field.flashes[flash].place_mm - start) / step;
        const std::uint64_t key = static_cast<std::uint64_t>(at.x) << 42 | static_cast<std::uint64_t>(at.y) << 21 |
                                  static_cast<std::uint64_t>(at.z);
        keyed.push_back({key, flash});
    }
    std::sort(keyed.begin(), keyed.end(),
              [](const Keyed& a, const Keyed& b) { return a.key != b.key ? a.key < b.key : a.flash < b.flash; });

    std::vector<Voxel> voxels;
    for (std::size_t first = 0, last = 0; first < keyed.size(); first = last) {
        Voxel voxel;
        voxel.place_mm = field.flashes[keyed[first].flash].place_mm;
        for (; last < keyed.size() && keyed[last].key == keyed[first].key; ++last) {
            voxel.light += field.light(field.flashes[keyed[last].flash]);
        }
        voxel.light /= static_cast<float>(last - first);
        voxels.push_back(voxel);
    }
    return voxels;
}

/// Gives a voxel the size of the space between it and its neighbours.
void set_size(Voxel& voxel, const Spacing& spacing, double stretch) {
    double along_mm = spacing.along_mm;
    if (spacing.rotates) {
        along_mm = std::max(slice_width_mm(spacing, voxel.place_mm), spacing.across_mm);
        const glm::vec2 plan(voxel.place_mm.x, voxel.place_mm.y);
        const float radius = glm::length(plan);
        if (radius > 0.0f) voxel.across = plan / radius;
    }
    voxel.half_mm = glm::vec3(0.5 * glm::dvec3(spacing.across_mm, along_mm, stretch * spacing.up_mm));
}

}  // namespace

std::vector<Voxel> visible_voxels(const DisplayDescription& display, const LightField& field) {
    if (field.flashes.empty()) return {};
    const Spacing spacing = spacing_of(display);
    EvenSpace even(display, spacing.up_mm);
    const Bounds bounds = bounds_of(field, [&](const glm::dvec3& place_mm) { return even(place_mm); });

    std::vector<std::uint32_t> seen;
    {
        const WallGrid walls = walled_in(field, spacing, bounds, even);
        for (std::uint32_t i = 0; i < field.flashes.size(); ++i) {
            if (!walls.test(even(field.flashes[i].place_mm))) seen.push_back(i);
        }
    }
    std::vector<Voxel> voxels = places_of(field, seen);

    DensityGrid density = density_of(field, spacing, bounds, even);
    for (int i = 0; i < 5; ++i) density.blur();
    for (Voxel& voxel : voxels) {
        const double stretch = even.stretch_at(voxel.place_mm.z);
        set_size(voxel, spacing, stretch);
        glm::dvec3 fall = density.fall_at(even(voxel.place_mm));
        fall.z /= stretch;
        if (glm::length(fall) * spacing.up_mm > 1e-4) voxel.normal = glm::normalize(fall);
    }
    for (int i = 0; i < 10; ++i) density.blur();
    for (Voxel& voxel : voxels) {
        voxel.open = static_cast<float>(1.0 - std::clamp(density.at(even(voxel.place_mm)), 0.0, 1.0));
    }
    return voxels;
}

}  // namespace xorvox::sim
