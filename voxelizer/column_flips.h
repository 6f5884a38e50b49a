// ColumnFlips: the events of the parity method, kept in the output volume itself.
//
// While faces are visited, bit (column, k) says whether an odd number of faces lies between samples k-1 and k. Then
// every layer is XORed with the one below, and the bits are the parities. Freestanding; internal to the voxelizer.
#pragma once

#include <cstddef>
#include <cstdint>

#include "voxelizer/bit_volume.h"

namespace xorvox {

class ColumnFlips {
public:
    /// Clears `volume`, which is borrowed for the life of this object.
    explicit ColumnFlips(BitVolumeView volume)
        : words_(volume.words.data()), layer_words_(row_words(volume.nx) * volume.ny), nz_(volume.nz) {
        for (std::uint64_t& word : volume.words) word = 0;
    }

    std::uint32_t nz() const { return nz_; }
    std::size_t count() const { return count_; }

    /// A face crosses the column of this bit of a layer just below sample k; k < nz().
    void flip(std::size_t bit, std::uint32_t k) {
        words_[k * layer_words_ + bit / 64] ^= std::uint64_t{1} << (bit % 64);
        ++count_;
    }

    /// Turns the events into parities, once, after the last flip.
    void accumulate() {
        for (std::size_t i = layer_words_; i < layer_words_ * nz_; ++i) words_[i] ^= words_[i - layer_words_];
    }

private:
    std::uint64_t* words_;
    std::size_t layer_words_;
    std::uint32_t nz_;
    std::size_t count_ = 0;
};

/// The bit of column (x, y) in a layer whose rows have nx voxels.
constexpr std::size_t column_bit(std::uint32_t nx, std::uint32_t x, std::uint32_t y) {
    return row_words(nx) * 64 * y + x;
}

}  // namespace xorvox
