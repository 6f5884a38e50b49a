// TriangleSource: the triangles of a mesh in blocks, each thread its own blocks. Lists of triangles are used as they
// are; polygons are fanned on the way.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "voxelizer/faces.h"
#include "voxelizer/kernels/kernel_table.h"
#include "voxelizer/mesh.h"

namespace xorvox::kernels {

/// The vertex numbers of a well-formed mesh in which every face is one triangle; empty for any other mesh.
std::span<const std::uint32_t> triangle_list(const MeshView& mesh);

class TriangleSource {
public:
    /// The part `number` of `count` of a mesh that passes validate(), with its triangle_list() and snapped vertices.
    TriangleSource(const MeshView& mesh, std::span<const std::uint32_t> list, SnappedVertices points, unsigned number,
                   unsigned count);

    /// The next at most kBlockTriangles triangles; none when there are no more. Valid until the next call.
    Triangles next();

    /// How much of this part has been given out, 0 to 1.
    double fraction() const;

private:
    Triangles next_fans();
    void next_face();

    MeshView mesh_;
    SnappedVertices points_;
    std::span<const std::uint32_t> list_;
    unsigned count_;
    std::size_t block_;
    std::size_t face_;
    std::size_t ring_ = 0;
    std::size_t edge_ = 0;
    bool in_face_ = false;
    std::uint32_t apex_ = 0;
    std::array<std::uint32_t, 3 * kBlockTriangles> fans_;
};

}  // namespace xorvox::kernels
