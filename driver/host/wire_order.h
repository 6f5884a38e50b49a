// WireOrder: from the samples of a display's lattice to its pixels in the order of the wire, a panel of a slice at a
// time. Bits go as words; nothing is looked up for each of them but on a helix.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "driver/display/description.h"
#include "driver/display/lattice.h"
#include "voxelizer/bit_volume.h"

namespace xorvox::host {

/// A sample of a lattice.
struct Sample {
    std::uint32_t x = 0;
    std::uint32_t y = 0;
    std::uint32_t k = 0;
};

/// Rows that WireOrder::fetch gives at most, and words of the longest of them.
inline constexpr std::uint32_t kMostRows = 64;
inline constexpr std::size_t kMostWords = kMaxLatticeSide / 64;

class WireOrder {
public:
    /// Both are borrowed for the object's life.
    WireOrder(const DisplayDescription& display, const DisplayLattice& lattice);

    /// The sample that a pixel lights. All four are in range.
    Sample sample(std::uint32_t slice, std::uint32_t panel, std::uint32_t row, std::uint32_t column) const;

    /// The bits of rows first … first + count − 1, at most kMostRows, of panel `panel` in slice `slice` of `volume`,
    /// which has the lattice's shape: row after row of the wire, row_words(columns) words a row, column c at bit c % 64
    /// of word c / 64, padding zero. They stand at the start of `out`. Any number of threads; allocates nothing.
    std::span<std::uint64_t> fetch(ConstBitVolumeView volume, std::uint32_t slice, std::uint32_t panel,
                                   std::uint32_t first, std::uint32_t count,
                                   std::span<std::uint64_t, kMostRows * kMostWords> out) const;

private:
    void fetch_flat(ConstBitVolumeView volume, std::uint32_t slice, std::uint32_t first,
                    std::span<std::uint64_t> out) const;
    void fetch_helix(ConstBitVolumeView volume, std::uint32_t slice, std::uint32_t first,
                     std::span<std::uint64_t> out) const;
    void fetch_pixels(ConstBitVolumeView volume, std::uint32_t slice, std::uint32_t panel, std::uint32_t first,
                      std::span<std::uint64_t> out) const;
    void fetch_standing(ConstBitVolumeView volume, std::uint32_t slice, std::uint32_t panel, std::uint32_t first,
                        std::span<std::uint64_t> out) const;
    void fetch_on_its_side(ConstBitVolumeView volume, std::uint32_t slice, std::uint32_t panel, std::uint32_t first,
                           std::span<std::uint64_t> out) const;
    std::uint32_t helix_k(std::uint32_t slice, std::size_t column) const;

    enum class Shape : std::uint8_t { Flat, Helix, Upright, Pixels };

    const DisplayDescription& display_;
    const DisplayLattice& lattice_;
    Shape shape_;
    std::array<std::uint32_t, kMaxPanels> first_x_{};  ///< Of each panel: upright columns, or pixels, before it.
};

}  // namespace xorvox::host
