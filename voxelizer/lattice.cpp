#include "voxelizer/lattice.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

namespace xorvox {
namespace {

Status validate_regular(const Lattice& lattice) {
    if (!lattice.z0.empty() || !lattice.z.empty()) return Status::InvalidArgument;
    if (std::max({lattice.nx, lattice.ny, lattice.nz}) > kMaxLatticeSide) return Status::OutOfRange;
    const glm::dvec3& pitch = lattice.pitch;
    if (!is_finite(lattice.origin) || !is_finite(pitch)) return Status::InvalidArgument;
    if (pitch.x <= 0.0 || pitch.y <= 0.0 || pitch.z <= 0.0) return Status::InvalidArgument;
    const glm::dvec3 last = sample_position(lattice, lattice.nx - 1, lattice.ny - 1, lattice.nz - 1);
    return is_finite(last) ? Status::Ok : Status::OutOfRange;
}

Status validate_table(const Lattice& lattice) {
    if (lattice.nz > kMaxLatticeSide) return Status::OutOfRange;
    const std::size_t columns = lattice.column_count();
    if (lattice.plan.size() != columns || lattice.z.size() != lattice.nz) return Status::InvalidArgument;
    if (!lattice.z0.empty() && lattice.z0.size() != columns) return Status::InvalidArgument;

    const auto all_finite = [](std::span<const double> values) {
        return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
    };
    const bool plan_finite = std::all_of(lattice.plan.begin(), lattice.plan.end(), [](const glm::dvec2& place) {
        return is_finite({place, 0.0});
    });
    if (!plan_finite || !all_finite(lattice.z0) || !all_finite(lattice.z)) return Status::InvalidArgument;
    const auto not_increasing = [](double a, double b) { return a >= b; };
    if (std::adjacent_find(lattice.z.begin(), lattice.z.end(), not_increasing) != lattice.z.end()) {
        return Status::InvalidArgument;
    }
    const Box box = sample_bounds(lattice);
    const glm::dvec3 size = box.upper - box.lower;
    const bool keeps_heights = 0.5 * (lattice.z.back() - lattice.z.front()) <= size.z;
    return is_finite(size) && keeps_heights ? Status::Ok : Status::OutOfRange;
}

}  // namespace

bool is_finite(const glm::dvec3& point) {
    return std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z);
}

Box sample_bounds(const Lattice& lattice) {
    if (lattice.is_regular()) {
        return {sample_position(lattice, 0, 0, 0),
                sample_position(lattice, lattice.nx - 1, lattice.ny - 1, lattice.nz - 1)};
    }
    glm::dvec2 lower = lattice.plan.front();
    glm::dvec2 upper = lower;
    for (const glm::dvec2& column : lattice.plan) {
        lower = glm::min(lower, column);
        upper = glm::max(upper, column);
    }
    double lowest = 0.0;
    double highest = 0.0;
    if (!lattice.z0.empty()) {
        const auto [low, high] = std::minmax_element(lattice.z0.begin(), lattice.z0.end());
        lowest = *low;
        highest = *high;
    }
    return {{lower.x, lower.y, lowest + lattice.z.front()}, {upper.x, upper.y, highest + lattice.z.back()}};
}

Status validate(const Lattice& lattice) {
    if (lattice.nx == 0 || lattice.ny == 0 || lattice.nz == 0) return Status::InvalidArgument;
    if (std::uint64_t{lattice.nx} * lattice.ny > kMaxLatticeColumns) return Status::OutOfRange;
    return lattice.is_regular() ? validate_regular(lattice) : validate_table(lattice);
}

}  // namespace xorvox
