// MeshBuilder: a Mesh, vertex by vertex and corner by corner. Private to voxelizer/io.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "voxelizer/error.h"
#include "voxelizer/mesh.h"

namespace xorvox::io {

/// Has no limits of its own: kMaxMeshFileBytes keeps everything within 32 bits.
class MeshBuilder {
public:
    void add_vertex(const glm::dvec3& position) { mesh_.positions.push_back(position); }
    void add_corner(std::uint32_t vertex) { mesh_.indices.push_back(vertex); }
    /// Makes a face of the corners since the last one: at least three.
    void end_face() {
        const auto end = static_cast<std::uint32_t>(mesh_.indices.size());
        if (mesh_.ring_starts.empty()) {
            if (end - face_start_ != 3) {  // No longer triangles only: the ring table begins.
                for (std::uint32_t start = 0; start <= face_start_; start += 3) mesh_.ring_starts.push_back(start);
                mesh_.ring_starts.push_back(end);
            }
        } else {
            mesh_.ring_starts.push_back(end);
        }
        face_start_ = end;
    }

    void reserve_vertices(std::size_t count) { mesh_.positions.reserve(count); }
    void reserve_triangles(std::size_t count) { mesh_.indices.reserve(3 * count); }
    std::size_t vertex_count() const { return mesh_.positions.size(); }

    /// The mesh, or an error that begins with `source` when it has no face.
    Expected<Mesh> finish(std::string_view source) && {
        if (mesh_.indices.empty()) {
            return fail(fmt::format(
                "{}: {} vertices but no faces; a mesh needs faces, a cloud of points has to be meshed first", source,
                mesh_.positions.size()));
        }
        return std::move(mesh_);
    }

private:
    Mesh mesh_;
    std::uint32_t face_start_ = 0;
};

}  // namespace xorvox::io
