// For each set of at most eight lanes, the numbers of those in it, in order: Highway's own tables for 64-bit lanes are
// local to a function, and copied to the stack with every use.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace xorvox::kernels {

struct CompressTable {
    std::uint8_t lanes[256][8]{};

    constexpr CompressTable() {
        for (std::size_t set = 0; set < 256; ++set) {
            std::size_t n = 0;
            for (std::uint8_t lane = 0; lane < 8; ++lane) {
                if (set >> lane & 1) lanes[set][n++] = lane;
            }
        }
    }
};

inline constexpr CompressTable kCompressTable;

}  // namespace xorvox::kernels
