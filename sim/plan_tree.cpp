#include "sim/plan_tree.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace xorvox::sim {

PlanTree::PlanTree(const std::vector<glm::dvec2>& points) {
    assert(!points.empty());
    nodes_.reserve(points.size());
    for (const glm::dvec2& point : points) nodes_.push_back({point, static_cast<std::uint32_t>(nodes_.size())});
    sort(0, nodes_.size(), 0);
}

void PlanTree::sort(std::size_t first, std::size_t last, int axis) {
    if (last - first < 2) return;
    const std::size_t middle = first + (last - first) / 2;
    const auto at = [this](std::size_t i) { return nodes_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(first), at(middle), at(last),
                     [axis](const Node& a, const Node& b) { return a.point[axis] < b.point[axis]; });
    sort(first, middle, 1 - axis);
    sort(middle + 1, last, 1 - axis);
}

/// Calls found(node, squared distance) for the points within the square root of `limit_sq`, which `found` may lower.
template <class Found>
void PlanTree::visit(std::size_t first, std::size_t last, int axis, glm::dvec2 place, double& limit_sq,
                     const Found& found) const {
    if (first == last) return;
    const std::size_t middle = first + (last - first) / 2;
    const Node& node = nodes_[middle];
    const glm::dvec2 apart = place - node.point;
    const double apart_sq = apart.x * apart.x + apart.y * apart.y;
    if (apart_sq <= limit_sq) found(node, apart_sq);

    const double ahead = apart[axis];
    const bool low_side = ahead < 0.0;
    const auto visit_low = [&] { visit(first, middle, 1 - axis, place, limit_sq, found); };
    const auto visit_high = [&] { visit(middle + 1, last, 1 - axis, place, limit_sq, found); };
    low_side ? visit_low() : visit_high();
    if (ahead * ahead > limit_sq) return;
    low_side ? visit_high() : visit_low();
}

PlanTree::Nearest PlanTree::nearest(glm::dvec2 place) const {
    double best_sq = std::numeric_limits<double>::infinity();
    std::uint32_t best = 0;
    visit(0, nodes_.size(), 0, place, best_sq, [&](const Node& node, double apart_sq) {
        best_sq = apart_sq;
        best = node.index;
    });
    return {best, std::sqrt(best_sq)};
}

std::vector<std::uint32_t> PlanTree::within(glm::dvec2 place, double radius) const {
    std::vector<std::uint32_t> indices;
    double limit_sq = radius * radius;
    visit(0, nodes_.size(), 0, place, limit_sq, [&](const Node& node, double) { indices.push_back(node.index); });
    std::sort(indices.begin(), indices.end());
    return indices;
}

}  // namespace xorvox::sim
