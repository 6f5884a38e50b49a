#include "driver/host/sample_points.h"

#include <algorithm>

namespace xorvox::host {

SamplePoints::SamplePoints(const DisplayDescription& display, const DisplayLattice& lattice, const WireOrder& order)
    : lattice_(lattice), order_(order), is_helix_(display.kind == DisplayKind::Helix) {
    const DisplayExtent room = extent(display);
    lower_ = room.lower;
    scale_ = 1.0 / (room.upper - room.lower);
    const Lattice view = lattice.view();
    if (is_helix_) return;
    if (view.is_regular()) {
        for (std::uint32_t x = 0; x < view.nx; ++x) x_.push_back(point({x, 0, 0}).x);
        for (std::uint32_t y = 0; y < view.ny; ++y) y_.push_back(point({0, y, 0}).y);
        for (std::uint32_t k = 0; k < view.nz; ++k) z_.push_back(point({0, 0, k}).z);
        return;
    }
    const bool own_heights = !view.z0.empty();
    x_.reserve(view.column_count());
    y_.reserve(view.column_count());
    if (own_heights) z_.reserve(view.column_count());
    for (std::uint32_t y = 0; y < view.ny; ++y) {
        for (std::uint32_t x = 0; x < view.nx; ++x) {
            const glm::vec3 at = point({x, y, 0});
            x_.push_back(at.x);
            y_.push_back(at.y);
            if (own_heights) z_.push_back(at.z);
        }
    }
    for (std::uint32_t k = 0; !own_heights && k < view.nz; ++k) z_.push_back(point({0, 0, k}).z);
}

glm::vec3 SamplePoints::point(const Sample& sample) const {
    return glm::vec3((sample_position(lattice_.view(), sample.x, sample.y, sample.k) - lower_) * scale_);
}

void SamplePoints::of_row(std::uint32_t slice, std::uint32_t panel, std::uint32_t row,
                          std::span<const std::uint32_t> columns, glm::vec3* points) const {
    if (is_helix_) {
        // The one kind whose heights along a row do not go by steps.
        for (const std::uint32_t column : columns) *points++ = point(order_.sample(slice, panel, row, column));
        return;
    }
    const Lattice view = lattice_.view();
    const Sample first = order_.sample(slice, panel, row, 0);
    const Sample second = order_.sample(slice, panel, row, 1);  // of a row of one column it is not used
    const auto x_step = static_cast<std::ptrdiff_t>(second.x) - static_cast<std::ptrdiff_t>(first.x);
    const auto k_step = static_cast<std::ptrdiff_t>(second.k) - static_cast<std::ptrdiff_t>(first.k);
    const std::size_t column_of_lattice = std::size_t{first.y} * view.nx + first.x;
    const bool regular = view.is_regular();
    const bool own_heights = !view.z0.empty();
    const float* const x = x_.data() + (regular ? first.x : column_of_lattice);
    const float* const y = y_.data() + (regular ? first.y : column_of_lattice);
    const float* const z = z_.data() + (own_heights ? column_of_lattice : first.k);
    const std::ptrdiff_t y_step = regular ? 0 : x_step;
    const std::ptrdiff_t z_step = own_heights ? x_step : k_step;
    for (const std::uint32_t column : columns) {
        const auto c = static_cast<std::ptrdiff_t>(column);
        *points++ = {x[c * x_step], y[c * y_step], z[c * z_step]};
    }
}

}  // namespace xorvox::host
