#include "sim/grid.h"

#include <algorithm>

#include <glm/common.hpp>

namespace xorvox::sim {
namespace {

constexpr int kMargin = 6;  ///< Dark cells on every side.

}  // namespace

Cells::Cells(const Bounds& bounds, const glm::dvec3& cell_mm, std::size_t most_cells) : cell_mm_(cell_mm) {
    for (;; cell_mm_ *= 2.0) {
        const glm::dvec3 cells = glm::floor((bounds.upper - bounds.lower) / cell_mm_) + (1.0 + 2.0 * kMargin);
        if (cells.x * cells.y * cells.z > static_cast<double>(most_cells)) continue;
        for (int axis = 0; axis < 3; ++axis)
            size_[static_cast<std::size_t>(axis)] = static_cast<std::size_t>(cells[axis]);
        break;
    }
    origin_mm_ = bounds.lower - (kMargin + 0.5) * cell_mm_;
}

DensityGrid::DensityGrid(const Cells& cells)
    : cells_(cells),
      stride_{1, cells.size()[0], cells.size()[0] * cells.size()[1]},
      values_(stride_[2] * cells.size()[2]) {}

template <class Visit>
void DensityGrid::around(const glm::dvec3& place_mm, const Visit& visit) const {
    const glm::dvec3 steps = cells_.steps_to(place_mm) - 0.5;
    const glm::dvec3 first = glm::floor(steps);
    const glm::dvec3 part = steps - first;
    const std::size_t base = static_cast<std::size_t>(first.z) * stride_[2] +
                             static_cast<std::size_t>(first.y) * stride_[1] + static_cast<std::size_t>(first.x);
    for (unsigned corner = 0; corner < 8; ++corner) {
        double share = 1.0;
        std::size_t index = base;
        for (int axis = 0; axis < 3; ++axis) {
            const bool next = ((corner >> axis) & 1u) != 0;
            share *= next ? part[axis] : 1.0 - part[axis];
            index += next ? stride_[static_cast<std::size_t>(axis)] : 0;
        }
        visit(index, share);
    }
}

void DensityGrid::add(const glm::dvec3& place_mm, double amount) {
    around(place_mm, [&](std::size_t index, double share) { values_[index] += static_cast<float>(share * amount); });
}

double DensityGrid::at(const glm::dvec3& place_mm) const {
    double sum = 0.0;
    around(place_mm, [&](std::size_t index, double share) { sum += share * double{values_[index]}; });
    return sum;
}

void DensityGrid::blur() {
    std::vector<float> before;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        // The cells with one number along the axis lie in runs of `step`.
        const std::size_t step = stride_[axis];
        const std::size_t length = cells_.size()[axis];
        for (float* block = values_.data(); block != values_.data() + values_.size(); block += step * length) {
            before.assign(block, block + step);
            for (std::size_t i = 1; i + 1 < length; ++i) {
                float* here = block + i * step;
                for (std::size_t j = 0; j < step; ++j) {
                    const float old = here[j];
                    here[j] = 0.25f * before[j] + 0.5f * old + 0.25f * here[j + step];
                    before[j] = old;
                }
            }
        }
    }
}

glm::dvec3 DensityGrid::fall_at(const glm::dvec3& place_mm) const {
    glm::dvec3 fall(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 cell(0.0);
        cell[axis] = cells_.cell_mm()[axis];
        fall[axis] = (at(place_mm - cell) - at(place_mm + cell)) / cell[axis];
    }
    return fall;
}

WallGrid::WallGrid(const Cells& cells)
    : cells_(cells),
      row_words_((cells.size()[0] + 63) / 64),
      plane_words_(row_words_ * cells.size()[1]),
      words_(plane_words_ * cells.size()[2]) {}

void WallGrid::erode() {
    // The margin is dark: what a shift carries from one row or plane into the next is always zero.
    const std::size_t count = words_.size();
    std::vector<std::uint64_t> old = words_;
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint64_t below = i > 0 ? old[i - 1] >> 63 : 0;
        const std::uint64_t above = i + 1 < count ? old[i + 1] << 63 : 0;
        words_[i] = old[i] & (old[i] << 1 | below) & (old[i] >> 1 | above);
    }
    for (const std::size_t step : {row_words_, plane_words_}) {
        old = words_;
        for (std::size_t i = step; i + step < count; ++i) words_[i] = old[i] & old[i - step] & old[i + step];
    }
}

}  // namespace xorvox::sim
