// BitVolume: one bit a sample.
//
//   byte      0                         1                  …  7 | 8 …
//   bit       0  1  2  3  4  5  6  7    0  1  2  …
//   voxel x   0  1  2  3  4  5  6  7    8  9  10 …              | 64 …
//
// Voxel x of a row is bit x % 8 of byte x / 8, least significant first. A row is padded to a multiple of 8 bytes;
// padding bits are always zero. Rows follow each other in y, layers of ny rows in z. All machines that xorvox runs on
// are little-endian, so a row is also an array of std::uint64_t with voxel x at bit x % 64 of word x / 64.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "voxelizer/lattice.h"

namespace xorvox {

static_assert(std::endian::native == std::endian::little, "the layout above is also a layout of 64-bit words");

/// Words of 64 voxels in a row of `nx` voxels.
constexpr std::size_t row_words(std::uint32_t nx) {
    return (std::size_t{nx} + 63) / 64;
}
/// Words of a volume of this shape. The product must not exceed SIZE_MAX: lattices that pass validate() are fine.
constexpr std::size_t volume_words(std::uint32_t nx, std::uint32_t ny, std::uint32_t nz) {
    return row_words(nx) * ny * nz;
}

/// A borrowed volume; `Word` is std::uint64_t or const std::uint64_t. `words` has volume_words(nx, ny, nz) entries,
/// which the caller keeps alive. Freestanding. Different rows may be written by different threads.
template <class Word>
struct BasicBitVolumeView {
    std::span<Word> words;
    std::uint32_t nx = 0;
    std::uint32_t ny = 0;
    std::uint32_t nz = 0;

    /// The words of row y of layer z; y < ny, z < nz.
    constexpr std::span<Word> row(std::uint32_t y, std::uint32_t z) const {
        const std::size_t n = row_words(nx);
        return words.subspan((std::size_t{z} * ny + y) * n, n);
    }
    /// x < nx, y < ny, z < nz.
    constexpr bool test(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
        return (row(y, z)[x / 64] >> (x % 64)) & 1u;
    }
    constexpr void flip(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
        row(y, z)[x / 64] ^= std::uint64_t{1} << (x % 64);
    }
    constexpr std::size_t size_bytes() const { return words.size_bytes(); }
    /// Number of set voxels.
    constexpr std::size_t count() const {
        std::size_t n = 0;
        for (const auto word : words) n += static_cast<std::size_t>(std::popcount(word));
        return n;
    }
    constexpr operator BasicBitVolumeView<const Word>() const { return {words, nx, ny, nz}; }
};

using BitVolumeView = BasicBitVolumeView<std::uint64_t>;
using ConstBitVolumeView = BasicBitVolumeView<const std::uint64_t>;

/// Gives memory that begins at a cache line and, where the system can, lies in huge pages: a large volume then costs
/// one page fault for 2 MiB instead of 512. Hosted; throws std::bad_alloc.
std::uint64_t* allocate_words(std::size_t words);
void release_words(std::uint64_t* first, std::size_t words);

/// The same for std::vector<std::uint64_t>.
template <class Word>
struct WordAllocator {
    static_assert(sizeof(Word) == sizeof(std::uint64_t));
    using value_type = Word;

    Word* allocate(std::size_t words) { return allocate_words(words); }
    void deallocate(Word* first, std::size_t words) { release_words(first, words); }
    friend bool operator==(const WordAllocator&, const WordAllocator&) = default;
};

/// A volume that owns its words, all clear at first. Hosted only; throws std::bad_alloc as a vector does.
class BitVolume {
public:
    BitVolume() = default;
    BitVolume(std::uint32_t nx, std::uint32_t ny, std::uint32_t nz)
        : words_(volume_words(nx, ny, nz)), nx_(nx), ny_(ny), nz_(nz) {}
    explicit BitVolume(const Lattice& lattice) : BitVolume(lattice.nx, lattice.ny, lattice.nz) {}

    BitVolumeView view() { return {words_, nx_, ny_, nz_}; }
    ConstBitVolumeView view() const { return {words_, nx_, ny_, nz_}; }
    bool test(std::uint32_t x, std::uint32_t y, std::uint32_t z) const { return view().test(x, y, z); }
    std::size_t count() const { return view().count(); }
    friend bool operator==(const BitVolume&, const BitVolume&) = default;

private:
    std::vector<std::uint64_t, WordAllocator<std::uint64_t>> words_;
    std::uint32_t nx_ = 0;
    std::uint32_t ny_ = 0;
    std::uint32_t nz_ = 0;
};

}  // namespace xorvox
