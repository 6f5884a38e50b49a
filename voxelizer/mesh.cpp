#include "voxelizer/mesh.h"

#include <algorithm>

namespace xorvox {
namespace {

/// Whether `starts` never decreases and ends within `count` entries of the next array.
bool is_table(std::span<const std::uint32_t> starts, std::size_t count) {
    return starts.empty() || (std::is_sorted(starts.begin(), starts.end()) && starts.back() <= count);
}

/// Without a branch or a comparison an index, so that compilers use vectors, whatever these are.
bool all_below(std::span<const std::uint32_t> indices, std::size_t count) {
    constexpr std::uint32_t kSign = std::uint32_t{1} << 31;
    if (count == 0 || count > kSign)
        return std::all_of(indices.begin(), indices.end(), [count](auto i) { return i < count; });
    // Numbers below 2^31 differ by less, so that the sign of a difference tells which one is larger.
    const auto last = static_cast<std::uint32_t>(count - 1);
    std::uint32_t signs = 0;
    for (const std::uint32_t index : indices) signs |= index | (last - index);
    return (signs & kSign) == 0;
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
    if (all_below(used, mesh.positions.size())) return Status::Ok;
    for (const std::uint32_t& index : used) {
        if (index >= mesh.positions.size()) return invalid_at(static_cast<std::size_t>(&index - mesh.indices.data()));
    }
    return Status::Ok;
}

}  // namespace xorvox
