#include "tools/placement.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>

#include <fmt/format.h>
#include <sys/resource.h>
#include <glm/geometric.hpp>

#include "driver/display/lattice.h"
#include "voxelizer/fit.h"

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

std::uint64_t available_bytes() {
    rlimit limit = {};
    std::uint64_t allowed = std::numeric_limits<std::uint64_t>::max();
    if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) allowed = limit.rlim_cur;
    std::ifstream meminfo("/proc/meminfo");
    std::string key;
    std::uint64_t kib = 0;
    while (meminfo >> key) {
        if (key == "MemAvailable:" && meminfo >> kib) return std::min(allowed, kib * 1024);
    }
    return allowed;
}

Expected<void> check_memory(std::uint64_t bytes, const std::string& what) {
    const std::uint64_t available = available_bytes();
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

Expected<void> fit_to_display(Mesh& mesh, const DisplayDescription& display, const std::string& source, bool turns) {
    const Expected<Box> box = bounds(mesh.view());
    if (!box) return fail(source + ": " + box.error().message);
    const DisplayExtent room = extent(display);
    const glm::dvec3 center = (box->lower + box->upper) / 2.0;
    const glm::dvec3 size = box->upper - box->lower;
    const glm::dvec3 space = room.upper - room.lower;

    double scale = std::numeric_limits<double>::infinity();
    const auto limit = [&scale](double available, double needed) {
        if (needed > 0.0) scale = std::min(scale, available / needed);
    };
    limit(space.z, size.z);
    if (room.radius_mm > 0.0 || turns) {
        const double radius = room.radius_mm > 0.0 ? room.radius_mm : std::min(space.x, space.y) / 2.0;
        double reach = 0.0;
        for (const std::uint32_t index : mesh.indices) {
            reach = std::max(reach, glm::distance(glm::dvec2(mesh.positions[index]), glm::dvec2(center)));
        }
        limit(radius, reach);
    } else {
        limit(space.x, size.x);
        limit(space.y, size.y);
    }
    if (!std::isfinite(scale) || scale <= 0.0) {
        return fail(fmt::format("{}: all vertices are at one place; there is nothing to show", source));
    }
    const glm::dvec3 middle = (room.lower + room.upper) / 2.0;
    for (glm::dvec3& position : mesh.positions) position = (position - center) * (scale * kFilled) + middle;
    return {};
}

}  // namespace xorvox::tools
