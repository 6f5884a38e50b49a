#include "voxelizer/kernels/triangle_source.h"

#include <algorithm>

namespace xorvox::kernels {
namespace {

/// Faces that a thread takes before it leaves as many to each of the others.
constexpr std::size_t kBlockFaces = 128;

}  // namespace

std::span<const std::uint32_t> triangle_list(const MeshView& mesh) {
    const std::size_t faces = mesh.face_count();
    if (faces == 0) return {};
    if (!mesh.face_starts.empty()) {
        for (std::size_t face = 0; face < faces; ++face) {
            if (mesh.face_end(face) - mesh.face_begin(face) != 1) return {};
        }
    }
    if (!mesh.ring_starts.empty()) {
        for (std::size_t face = 0; face < faces; ++face) {
            if (mesh.ring(mesh.face_begin(face)).size() != 3) return {};
        }
    }
    return mesh.used_indices();
}

TriangleSource::TriangleSource(const MeshView& mesh, std::span<const std::uint32_t> list, SnappedVertices points,
                               unsigned number, unsigned count)
    : mesh_(mesh), points_(points), list_(list), count_(count), block_(number), face_(number * kBlockFaces) {}

Triangles TriangleSource::next() {
    if (list_.empty()) return next_fans();
    const std::size_t first = std::min(block_ * kBlockTriangles * 3, list_.size());
    const std::size_t size = std::min(kBlockTriangles * 3, list_.size() - first);
    block_ += count_;
    return {list_.data() + first, size / 3};
}

Triangles TriangleSource::next_fans() {
    std::size_t n = 0;
    while (n < kBlockTriangles && face_ < mesh_.face_count()) {
        if (!in_face_) {
            const glm::ivec3* const apex = smallest_vertex(mesh_, face_, points_);
            if (apex == nullptr) {
                next_face();
                continue;
            }
            apex_ = static_cast<std::uint32_t>(apex - points_.data());
            ring_ = mesh_.face_begin(face_);
            edge_ = 0;
            in_face_ = true;
        }
        const auto ring = mesh_.ring(ring_);
        for (; edge_ < ring.size() && n < kBlockTriangles; ++edge_) {
            const std::uint32_t from = ring[edge_];
            const std::uint32_t to = ring[edge_ + 1 == ring.size() ? 0 : edge_ + 1];
            if (from == apex_ || to == apex_) continue;
            fans_[3 * n] = apex_;
            fans_[3 * n + 1] = from;
            fans_[3 * n + 2] = to;
            ++n;
        }
        if (edge_ < ring.size()) break;
        edge_ = 0;
        if (++ring_ == mesh_.face_end(face_)) next_face();
    }
    return {fans_.data(), n};
}

void TriangleSource::next_face() {
    in_face_ = false;
    ++face_;
    if (face_ % kBlockFaces == 0) face_ += kBlockFaces * (count_ - 1);
}

double TriangleSource::fraction() const {
    const double done = list_.empty() ? static_cast<double>(face_) : static_cast<double>(block_ * kBlockTriangles);
    const double all = static_cast<double>(mesh_.face_count());
    return all == 0 ? 1.0 : std::min(done / all, 1.0);
}

}  // namespace xorvox::kernels
