#include "tools/bench/floor.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <span>

namespace xorvox::tools {
namespace {

/// Four words at once where the machine can; a vector extension that g++ and clang share.
using FourWords [[gnu::vector_size(32), gnu::aligned(8), gnu::may_alias]] = std::uint64_t;

[[gnu::always_inline]] inline void xor_into(std::uint64_t* above, const std::uint64_t* below, std::size_t count) {
    std::size_t i = 0;
    for (; i + 4 <= count; i += 4) {
        *reinterpret_cast<FourWords*>(above + i) ^= *reinterpret_cast<const FourWords*>(below + i);
    }
    for (; i < count; ++i) above[i] ^= below[i];
}

#if defined(__x86_64__)
// A program built for any x86-64 has vectors of two words; with four the pass is up to twice as fast, and a floor that
// is too high would flatter us.
[[gnu::target("avx2")]] void xor_into_avx2(std::uint64_t* above, const std::uint64_t* below, std::size_t count) {
    xor_into(above, below, count);
}
#endif

}  // namespace

void clear(BitVolumeView volume) {
    std::ranges::fill(volume.words, std::uint64_t{0});
}

void xor_layers(BitVolumeView volume) {
    const std::size_t layer = row_words(volume.nx) * volume.ny;
    const std::size_t rest = volume.words.size() - layer;
    // All layers in one go: words are changed in the order of their addresses, each layer before it is needed.
    std::uint64_t* const above = volume.words.data() + layer;
#if defined(__x86_64__)
    if (layer >= 4 && __builtin_cpu_supports("avx2")) return xor_into_avx2(above, volume.words.data(), rest);
#endif
    for (std::size_t i = 0; i < rest; ++i) above[i] ^= volume.words[i];
}

std::uint64_t read_corners(const MeshView& mesh) {
    // By exclusive or, in two chains, so that nothing but the reads takes time.
    const auto bits = [positions = mesh.positions.data()](std::uint32_t index) {
        const glm::dvec3& p = positions[index];
        return std::bit_cast<std::uint64_t>(p.x) ^ std::bit_cast<std::uint64_t>(p.y) ^
               std::bit_cast<std::uint64_t>(p.z);
    };
    const std::span<const std::uint32_t> indices = mesh.used_indices();
    std::uint64_t seen = 0;
    std::uint64_t also = 0;
    std::size_t i = 0;
    for (; i + 4 <= indices.size(); i += 4) {
        seen ^= bits(indices[i]) ^ bits(indices[i + 1]);
        also ^= bits(indices[i + 2]) ^ bits(indices[i + 3]);
    }
    for (; i < indices.size(); ++i) seen ^= bits(indices[i]);
    return seen ^ also;
}

}  // namespace xorvox::tools
