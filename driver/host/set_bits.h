// The set bits of a row, as numbers.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace xorvox::host {

/// Writes the numbers of the set bits of `word`, the first of which is `first`, upwards to `numbers`; how many.
inline std::size_t set_bits(std::uint64_t word, std::uint32_t first, std::span<std::uint32_t, 64> numbers) {
    if (word == ~std::uint64_t{0}) {
        for (std::uint32_t i = 0; i < 64; ++i) numbers[i] = first + i;
        return 64;
    }
    std::size_t count = 0;
    for (; word != 0; word &= word - 1) numbers[count++] = first + static_cast<std::uint32_t>(std::countr_zero(word));
    return count;
}

}  // namespace xorvox::host
