#include "tools/placement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "driver/display/lattice.h"
#include "voxelizer/fit.h"
#include "voxelizer/io/memory.h"

namespace xorvox::tools {
namespace {

constexpr std::uint32_t kDefaultSize = 64;
/// The part of a display's extent that a model may fill, so that its outermost faces do not run through the last
/// samples.
constexpr double kFilled = 63.0 / 64.0;

Expected<std::uint32_t> side(double number, char axis) {
    if (number >= 1.0 && number <= kMaxLatticeSide && number == std::floor(number)) {
        return static_cast<std::uint32_t>(number);
    }
    return fail(fmt::format("--grid has {} voxels along {}; it takes whole numbers from 1 to {}", number, axis,
                            kMaxLatticeSide));
}

Expected<Lattice> explicit_grid(const GridOptions& options) {
    if (!options.grid || !options.origin || !options.pitch) {
        return fail("--grid, --origin and --pitch belong together; give all three, or --size instead");
    }
    Lattice lattice;
    const auto nx = side(options.grid->x, 'x');
    const auto ny = side(options.grid->y, 'y');
    const auto nz = side(options.grid->z, 'z');
    for (const auto* n : {&nx, &ny, &nz}) {
        if (!*n) return tl::unexpected(n->error());
    }
    lattice.nx = *nx;
    lattice.ny = *ny;
    lattice.nz = *nz;
    lattice.origin = *options.origin;
    lattice.pitch = *options.pitch;
    for (int axis = 0; axis < 3; ++axis) {
        if (!std::isfinite(lattice.origin[axis])) return fail("--origin has a number that is not finite");
        if (!(lattice.pitch[axis] > 0.0) || !std::isfinite(lattice.pitch[axis])) {
            return fail(fmt::format("--pitch is {}; it takes positive numbers", lattice.pitch[axis]));
        }
    }
    return lattice;
}

}  // namespace

Expected<Lattice> place_grid(const GridOptions& options, const MeshView& mesh, const std::string& source) {
    if (options.grid || options.origin || options.pitch) return explicit_grid(options);
    const std::uint32_t size = options.size.value_or(kDefaultSize);
    if (size < 1 || size > kMaxLatticeSide) {
        return fail(fmt::format("--size is {}; it takes a whole number from 1 to {}", size, kMaxLatticeSide));
    }
    const Expected<Box> box = bounds(mesh);
    if (!box) return fail(source + ": " + box.error().message);
    Expected<Lattice> lattice = fit_cube(*box, size);
    if (!lattice) return fail(source + ": " + lattice.error().message);
    return lattice;
}

Expected<void> check_memory(std::uint64_t bytes, const std::string& what) {
    const std::uint64_t available = io::available_bytes();
    if (bytes <= available) return {};
    return fail(fmt::format("{} needs {} MiB of memory and there are {} MiB free; choose fewer voxels", what,
                            bytes >> 20, available >> 20));
}

Expected<void> check_display_fits(const DisplayDescription& display) {
    constexpr std::uint64_t kFrames = 8;
    constexpr std::uint64_t kBytesAColumn = 64;
    return check_memory(
        kFrames * frame_bytes(display) + lattice_columns(display) * kBytesAColumn + frame_pixels(display) / 8,
        fmt::format("the display {}", display.name.view()));
}

glm::dmat4 Placement::matrix() const {
    const glm::dmat4 one(1.0);
    return glm::translate(one, middle) * glm::scale(one, glm::dvec3(scale)) * glm::translate(one, -center);
}

Expected<Placement> fit_to_display(const PointSource& points, const DisplayDescription& display,
                                   const std::string& source, Turning turning) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    glm::dvec3 lower(kInfinity);
    glm::dvec3 upper(-kInfinity);
    points([&](std::span<const glm::dvec3> some) {
        for (const glm::dvec3& point : some) {
            lower = glm::min(lower, point);
            upper = glm::max(upper, point);
        }
    });
    const DisplayExtent room = extent(display);
    const glm::dvec3 center = (lower + upper) / 2.0;
    const glm::dvec3 size = upper - lower;
    const glm::dvec3 space = room.upper - room.lower;
    if (lower.x <= upper.x && !(std::isfinite(size.x) && std::isfinite(size.y) && std::isfinite(size.z))) {
        return fail(fmt::format("{}: it is larger than numbers go; choose another --unit", source));
    }

    double scale = kInfinity;
    const auto limit = [&scale](double available, double needed) {
        if (needed > 0.0) scale = std::min(scale, available / needed);
    };
    const auto farthest = [&](auto distance) {
        double reach = 0.0;
        points([&](std::span<const glm::dvec3> some) {
            for (const glm::dvec3& point : some) reach = std::max(reach, distance(point));
        });
        return reach;
    };
    const double radius = room.radius_mm > 0.0 ? room.radius_mm : std::min(space.x, space.y) / 2.0;
    if (turning == Turning::Anyhow) {
        limit(std::min(radius, space.z / 2.0), farthest([&](const auto& p) { return glm::distance(p, center); }));
    } else {
        limit(space.z, size.z);
        if (room.radius_mm > 0.0 || turning == Turning::Upright) {
            limit(radius, farthest([&](const auto& p) { return glm::distance(glm::dvec2(p), glm::dvec2(center)); }));
        } else {
            limit(space.x, size.x);
            limit(space.y, size.y);
        }
    }
    if (!std::isfinite(scale) || scale <= 0.0) {
        return fail(fmt::format("{}: all of it is at one place; there is nothing to show", source));
    }
    return Placement{center, scale * kFilled, (room.lower + room.upper) / 2.0};
}

}  // namespace xorvox::tools
