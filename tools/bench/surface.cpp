#include "tools/bench/surface.h"

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace xorvox::tools {

std::size_t count_surface(ConstBitVolumeView volume) {
    const std::vector<std::uint64_t> outside(row_words(volume.nx), 0);
    std::size_t count = 0;
    for (std::uint32_t z = 0; z < volume.nz; ++z) {
        for (std::uint32_t y = 0; y < volume.ny; ++y) {
            const std::span<const std::uint64_t> here = volume.row(y, z);
            const std::span<const std::uint64_t> below = z == 0 ? outside : volume.row(y, z - 1);
            const std::span<const std::uint64_t> above = z + 1 == volume.nz ? outside : volume.row(y, z + 1);
            const std::span<const std::uint64_t> front = y == 0 ? outside : volume.row(y - 1, z);
            const std::span<const std::uint64_t> back = y + 1 == volume.ny ? outside : volume.row(y + 1, z);
            for (std::size_t w = 0; w < here.size(); ++w) {
                const std::uint64_t left = here[w] << 1 | (w == 0 ? 0 : here[w - 1] >> 63);
                const std::uint64_t right = here[w] >> 1 | (w + 1 == here.size() ? 0 : here[w + 1] << 63);
                const std::uint64_t inner = below[w] & above[w] & front[w] & back[w] & left & right;
                count += static_cast<std::size_t>(std::popcount(here[w] & ~inner));
            }
        }
    }
    return count;
}

}  // namespace xorvox::tools
