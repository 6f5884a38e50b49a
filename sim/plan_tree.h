// PlanTree: points of a plane, to be searched by place. A k-d tree without pointers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

namespace xorvox::sim {

class PlanTree {
public:
    /// Takes 1 … 2^32 − 1 points; each keeps its index. Throws std::bad_alloc.
    explicit PlanTree(const std::vector<glm::dvec2>& points);

    /// A point nearest to `place`, any one if there are several, and its distance.
    struct Nearest {
        std::uint32_t index = 0;
        double distance = 0.0;
    };
    Nearest nearest(glm::dvec2 place) const;

    /// The points within `radius` of `place`, by index.
    std::vector<std::uint32_t> within(glm::dvec2 place, double radius) const;

private:
    struct Node {
        glm::dvec2 point;
        std::uint32_t index;
    };
    void sort(std::size_t first, std::size_t last, int axis);
    template <class Found>
    void visit(std::size_t first, std::size_t last, int axis, glm::dvec2 place, double& limit_sq,
               const Found& found) const;

    std::vector<Node> nodes_;  ///< The middle one of a range divides it, in x and y by turns.
};

}  // namespace xorvox::sim
