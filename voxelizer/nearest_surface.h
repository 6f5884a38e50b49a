// NearestSurface: the point of a mesh's surface that is nearest to any given one. Colours of a surface are carried
// inward by it: a voxel takes that of the nearest place.
//
// A polygon counts as the fans of its rings: triangles from a ring's first corner. Corners, with which colours come,
// are entries of the mesh's `indices`.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "voxelizer/mesh.h"

namespace xorvox {

/// A place on the surface.
struct SurfacePoint {
    std::uint32_t face = 0;
    std::array<std::uint32_t, 3> corners{};  ///< Of the face, as entries of MeshView::indices.
    glm::dvec3 weights{0.0};                 ///< Of the corners: none negative, 1 in all. The place is their mean.
    double distance_squared = 0.0;
};

/// A tree over the triangles. Hosted. Any number of threads may ask; set_positions() must not run meanwhile.
class NearestSurface {
public:
    /// `mesh` must pass validate(); coordinates finite and within ±1e15. Nothing of it is kept. Throws std::bad_alloc.
    explicit NearestSurface(const MeshView& mesh);

    /// Whether there is no triangle: then there is nothing to ask for.
    bool empty() const { return triangles_.empty(); }

    /// The mesh has moved, rigidly or not: as many positions as before. The tree keeps its branches, so that it gets
    /// slower, not wrong, when what was near is scattered. Allocates nothing.
    void set_positions(std::span<const glm::dvec3> positions);

    /// For each point, the nearest place; of several at the same distance the one of the lowest face, and in it of the
    /// lowest corners. The distance is that of the nearest point as doubles find it in each triangle alone: the same
    /// for every order of points, and the same bits on every machine. `points` finite and within ±1e15, best in an
    /// order in which neighbours follow each other: each search begins with the answer before. `places` has as many
    /// entries. Not empty().
    void nearest(std::span<const glm::dvec3> points, std::span<SurfacePoint> places) const;

    /// The same by looking at every triangle: slow, and the reference.
    SurfacePoint nearest_of_all(const glm::dvec3& point) const;

private:
    /// A triangle a, a + ab, a + ac, and what does not depend on the point that is asked for.
    struct Triangle {
        glm::dvec3 a, ab, ac;
        double ab_ab, ab_ac, ac_ac;               ///< Products.
        double per_ab, per_ac, per_bc, per_area;  ///< 1 / squared length, 1 / squared area; 0 where that is no number.
        bool is_thin;
        std::uint32_t number;  ///< Among all triangles, in the order of the faces.
    };
    /// Where a triangle of a number comes from.
    struct Source {
        std::uint32_t face;
        std::array<std::uint32_t, 3> corners;
        std::array<std::uint32_t, 3> vertices;
    };
    /// What holds a node's triangles: round plates, all places that are within `height` of a plane through `center`
    /// with the normal `normal`, and within `radius` of the axis. Unlike boxes they lie along the surface however it is
    /// turned, so that a point deep inside finds few plates as near as the nearest. Those of a node's four children
    /// stand side by side; relative to center_, rounded outward.
    struct Plates {
        float center[3][4];
        float normal[3][4];
        float height[4];
        float radius[4];

        /// At most the squared distances of the point, which is relative to center_, from the triangles.
        std::array<float, 4> distances(const glm::vec3& point) const;
    };
    /// The best place so far.
    struct Best {
        double distance_squared;
        std::uint32_t slot;  ///< In triangles_.
        double v, w;         ///< a + v·ab + w·ac.
    };

    void sort(std::span<const glm::dvec3> middles);
    void refit();
    void fit_plate(std::size_t begin, std::size_t end, double margin, Plates& plates, std::size_t child) const;
    std::size_t first_triangle(std::size_t leaf) const { return triangles_.size() * leaf / leaf_count_; }
    void look_at(std::uint32_t slot, const glm::dvec3& point, Best& best) const;
    Best search(const glm::dvec3& point, std::uint32_t start) const;
    SurfacePoint place(const Best& best) const;

    std::size_t vertex_count_ = 0;
    std::vector<Source> sources_;      ///< By number.
    std::vector<Triangle> triangles_;  ///< In the order of the leaves.
    std::size_t leaf_count_ = 1;       ///< A power of four.
    std::size_t inner_count_ = 0;      ///< Node n has the children 4n + 1 … 4n + 4; leaves follow the inner nodes.
    std::vector<Plates> plates_;       ///< Of the inner nodes.
    glm::dvec3 center_{0.0};
};

}  // namespace xorvox
