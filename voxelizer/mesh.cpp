#include "voxelizer/mesh.h"

#include <algorithm>

namespace xorvox {
namespace {

/// Whether `starts` never decreases and ends within `count` entries of the next array.
bool is_table(std::span<const std::uint32_t> starts, std::size_t count) {
    return starts.empty() || (std::is_sorted(starts.begin(), starts.end()) && starts.back() <= count);
}

}  // namespace

Status validate(const MeshView& mesh, std::size_t* bad_index) {
    const auto invalid_at = [bad_index](std::size_t place) {
        if (bad_index != nullptr) *bad_index = place;
        return Status::InvalidArgument;
    };
    if (mesh.ring_starts.empty() && mesh.indices.size() % 3 != 0) return invalid_at(mesh.indices.size());
    if (!is_table(mesh.ring_starts, mesh.indices.size())) return invalid_at(mesh.indices.size());
    if (!is_table(mesh.face_starts, mesh.ring_count())) return invalid_at(mesh.indices.size());
    const auto used = mesh.used_indices();
    // The largest is found by vectors; where it is wrong is asked only then.
    std::uint32_t largest = 0;
    for (const std::uint32_t index : used) largest = std::max(largest, index);
    if (used.empty() || largest < mesh.positions.size()) return Status::Ok;
    for (const std::uint32_t& index : used) {
        if (index >= mesh.positions.size()) return invalid_at(static_cast<std::size_t>(&index - mesh.indices.data()));
    }
    return Status::Ok;
}

}  // namespace xorvox
