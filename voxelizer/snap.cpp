#include "voxelizer/snap.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace xorvox {
namespace {

constexpr std::uint32_t kGridBits = 20;

double to_units(const SnapGrid& grid, double length, double from, double to) {
    return (to - from) / length * static_cast<double>(std::uint32_t{1} << grid.shift);
}

/// `value`, within kSnapLimit, to the nearest integer, ties to even: a double of this size has no bits below 1.
std::int32_t round_to_even(double value) {
    constexpr double kNoFraction = 0x1.8p52;
    return static_cast<std::int32_t>((value + kNoFraction) - kNoFraction);
}

/// False for NaN too.
bool is_in_range(double value) {
    return std::fabs(value) <= kSnapLimit;
}

}  // namespace

SnapGrid snap_grid(const Lattice& lattice) {
    if (lattice.is_regular()) {
        const std::uint32_t side = std::max({lattice.nx, lattice.ny, lattice.nz});
        const auto ceil_log2 = static_cast<std::uint32_t>(std::bit_width(side - 1));
        return {lattice.origin, lattice.pitch, kGridBits - ceil_log2};
    }
    const Box box = sample_bounds(lattice);
    const glm::dvec3 size = box.upper - box.lower;
    double plan = std::max(size.x, size.y);
    double height = size.z;
    if (plan == 0.0) plan = height;
    if (height == 0.0) height = plan;
    if (plan == 0.0) plan = height = 1.0;
    return {box.lower, {plan, plan, height}, kGridBits};
}

bool snap(const SnapGrid& grid, const glm::dvec3& point, glm::ivec3& snapped) {
    const double x = to_units(grid, grid.length.x, grid.origin.x, point.x);
    const double y = to_units(grid, grid.length.y, grid.origin.y, point.y);
    const double z = to_units(grid, grid.length.z, grid.origin.z, point.z);
    if (!is_in_range(x) || !is_in_range(y) || !is_in_range(z)) return false;
    snapped = {round_to_even(x), round_to_even(y), round_to_even(z)};
    return true;
}

glm::ivec3 snapped_column(const Lattice& lattice, const SnapGrid& grid, std::size_t column) {
    const double base = lattice.z0.empty() ? 0.0 : lattice.z0[column];
    glm::ivec3 snapped{0};
    // A point of the lattice is within 2^20 units of the grid's origin, so that this cannot fail.
    (void)snap(grid, {lattice.plan[column], base + lattice.z.front()}, snapped);
    return snapped;
}

std::int32_t snapped_rise(const Lattice& lattice, const SnapGrid& grid, std::uint32_t k) {
    SnapGrid from_lowest = grid;
    from_lowest.origin = {0.0, 0.0, lattice.z.front()};
    glm::ivec3 snapped{0};
    // At most 2^21 units, so that this cannot fail: a valid lattice's box is at least half as high as its table.
    (void)snap(from_lowest, {0.0, 0.0, lattice.z[k]}, snapped);
    return snapped.z;
}

}  // namespace xorvox
