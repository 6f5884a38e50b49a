#include "voxelizer/io/weld.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace xorvox::io {
namespace {

constexpr std::uint32_t kNone = 0xffff'ffff;

// Spreads the bits of three doubles over 64 (the finalizer of MurmurHash3, once a coordinate).
std::uint64_t hash(const glm::dvec3& position) {
    std::uint64_t h = 0;
    for (int axis = 0; axis < 3; ++axis) {
        h ^= std::bit_cast<std::uint64_t>(position[axis]);
        h = (h ^ (h >> 33)) * 0xff51'afd7'ed55'8ccd;
        h = (h ^ (h >> 33)) * 0xc4ce'b9fe'1a85'ec53;
        h ^= h >> 33;
    }
    return h;
}

// `parts` is empty or has one entry a vertex.
void weld_within(Mesh& mesh, std::span<std::uint32_t> parts) {
    std::vector<glm::dvec3>& positions = mesh.positions;
    std::vector<std::uint32_t> number(positions.size(), kNone);  // The new number of each old vertex.
    for (const std::uint32_t index : mesh.indices) number[index] = 0;

    // Open addressing, at most half full; entries are new numbers.
    const std::size_t mask = std::bit_ceil(2 * positions.size() + 1) - 1;
    std::vector<std::uint32_t> table(mask + 1, kNone);
    std::uint32_t count = 0;
    for (std::size_t vertex = 0; vertex < positions.size(); ++vertex) {
        if (number[vertex] == kNone) continue;
        const glm::dvec3 position = positions[vertex] + 0.0;  // -0 becomes 0.
        const auto is_same = [&](std::uint32_t other) {
            return positions[other] == position && (parts.empty() || parts[other] == parts[vertex]);
        };
        const std::uint64_t part = parts.empty() ? 0 : parts[vertex];
        std::size_t slot = (hash(position) ^ part * 0x9e37'79b9'7f4a'7c15) & mask;
        while (table[slot] != kNone && !is_same(table[slot])) slot = (slot + 1) & mask;
        if (table[slot] == kNone) {
            positions[count] = position;
            if (!parts.empty()) parts[count] = parts[vertex];
            table[slot] = count++;
        }
        number[vertex] = table[slot];
    }
    positions.resize(count);
    positions.shrink_to_fit();
    for (std::uint32_t& index : mesh.indices) index = number[index];
}

}  // namespace

void weld(Mesh& mesh) {
    weld_within(mesh, {});
}

void weld(Mesh& mesh, std::vector<std::uint32_t>& parts) {
    weld_within(mesh, parts);
    parts.resize(mesh.positions.size());
}

}  // namespace xorvox::io
