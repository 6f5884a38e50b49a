// Surface nets: the zero set of a function as a closed mesh of even triangles.
#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

#include "voxelizer/mesh.h"

namespace xorvox::examples {

/// Triangles along the surface where `field` changes its sign, outward (towards positive values), within the box from
/// `min` to `max`, on whose sides `field` must be positive. Samples a grid of about `step` units (S. Gibson,
/// "Constrained Elastic Surface Nets", 1998), then evens the vertices out along the surface and moves them onto it, and
/// rounds them to float. The same numbers on every machine if `field` gives the same.
Mesh surface_nets(double (*field)(const glm::dvec3&), const glm::dvec3& min, const glm::dvec3& max, double step);

}  // namespace xorvox::examples
