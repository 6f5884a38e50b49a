// Rows of pixels of a page, in scan-out order (driver/display/description.h), and the pixels of a row that are lit.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "driver/display/description.h"

namespace xorvox::sim {

/// The eight bytes of `row` from `first` on, the first one lowest; what lies beyond the row is zero.
inline std::uint64_t read_word(std::span<const std::byte> row, std::size_t first) {
    std::uint64_t word = 0;
    if (first + 8 <= row.size()) {
        if constexpr (std::endian::native == std::endian::little) {
            std::memcpy(&word, row.data() + first, 8);
            return word;
        }
    }
    for (std::size_t i = first; i < std::min(first + 8, row.size()); ++i) {
        word |= std::to_integer<std::uint64_t>(row[i]) << (8 * (i - first));
    }
    return word;
}

/// Calls lit(column, code) for every pixel of a row, `bits` each, that has one of the bits `shown` set. Goes from set
/// bit to set bit.
template <class Lit>
void for_each_lit(std::span<const std::byte> row, std::uint32_t columns, std::uint32_t bits, std::uint32_t shown,
                  const Lit& lit) {
    const std::size_t end = std::size_t{columns} * bits;
    for (std::size_t at = 0; at < end;) {
        const std::uint64_t ahead = read_word(row, at / 8) >> (at % 8);
        if (ahead == 0) {
            at = (at / 8 + 8) * 8;
            continue;
        }
        const std::size_t column = (at + static_cast<std::size_t>(std::countr_zero(ahead))) / bits;
        if (column >= columns) return;
        const std::size_t first = column * bits;
        const auto code = static_cast<std::uint32_t>(read_word(row, first / 8) >> (first % 8)) & ((1u << bits) - 1u);
        if ((code & shown) != 0) lit(static_cast<std::uint32_t>(column), code);
        at = first + bits;
    }
}

/// Calls visit(slice, panel, row, pixels) for every row of `page`, in scan-out order.
template <class Visit>
void for_each_row(const DisplayDescription& display, std::span<const std::byte> page, const Visit& visit) {
    for (std::uint32_t slice = 0; slice < display.slices; ++slice) {
        for (std::uint32_t p = 0; p < display.panel_count; ++p) {
            const std::size_t length = row_bytes(display.panels[p], display.format);
            for (std::uint32_t row = 0; row < display.panels[p].rows; ++row) {
                visit(slice, p, row, page.first(length));
                page = page.subspan(length);
            }
        }
    }
}

}  // namespace xorvox::sim
