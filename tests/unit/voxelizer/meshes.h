// Small meshes for the tests.
#pragma once

#include <array>
#include <random>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "voxelizer/lattice.h"
#include "voxelizer/mesh.h"

namespace xorvox::test {

using Corners = std::array<glm::dvec3, 4>;

void add_triangle(Mesh& mesh, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);
void add_tetrahedron(Mesh& mesh, const Corners& corners);
/// Twelve triangles.
void add_box(Mesh& mesh, const glm::dvec3& lower, const glm::dvec3& upper);
Mesh box_mesh(const glm::dvec3& lower, const glm::dvec3& upper);

/// A face of several rings; the mesh must have been made of polygons from its first face on.
using Rings = std::vector<std::vector<glm::dvec3>>;
void add_polygon(Mesh& mesh, const Rings& rings);
/// The upright prism over a polygon with holes: two faces of several rings, and the walls.
using PlanRings = std::vector<std::vector<glm::dvec2>>;
Mesh prism(const PlanRings& rings, double bottom, double top);

/// Random points with integer coordinates from `lower` to `upper`, both included.
class IntegerPoints {
public:
    IntegerPoints(unsigned seed, const glm::ivec3& lower, const glm::ivec3& upper)
        : random_(seed), lower_(lower), upper_(upper) {}
    glm::dvec3 operator()();

private:
    std::mt19937 random_;
    glm::ivec3 lower_;
    glm::ivec3 upper_;
};

/// The boundaries of `count` tetrahedra with corners from `points`, each to be multiplied by `scale`: closed mod 2.
Mesh tetrahedra(IntegerPoints& points, int count, const glm::dvec3& scale = glm::dvec3(1.0));

/// The lattice whose samples stand at the integers 0 … n-1 of each axis, times `pitch`.
Lattice integer_lattice(const glm::uvec3& n, const glm::dvec3& pitch = glm::dvec3(1.0));

}  // namespace xorvox::test
