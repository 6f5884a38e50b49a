// Events: where faces cross columns. An event is the bit of a column in a layer of the volume, and the layer whose
// sample is the first above the face: from there up, the column is flipped.
//
// Each thread has events of its own, in one of two forms:
//
//   bins      one for each layer, chains of small chunks from a pool that never grows. Layer by layer, its events flip
//             bits of one running layer of parities, which stays in the cache and is copied to the volume.
//   columns   where there are at most 64 layers, a word for each column: an event flips all bits from its layer up.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <span>
#include <vector>

namespace xorvox::kernels {

/// The most layers that a word for each column can have.
inline constexpr std::uint32_t kMaxColumnLayers = 64;

class EventBins {
public:
    /// `layers` empty bins, and a pool of `bytes`, or larger when a chunk for each bin needs more.
    void reserve(std::uint32_t layers, std::size_t bytes);
    /// The pool, while nothing is binned: `count` words, which are not more than it has.
    std::span<std::uint64_t> borrow(std::size_t count) {
        return {reinterpret_cast<std::uint64_t*>(chunks_.get()), count};
    }
    static std::size_t reserved_bytes(std::uint32_t layers, std::size_t bytes);
    void clear();

    /// Whether `events` more of them are sure to find room, whatever their layers.
    bool has_room(std::size_t events) const {
        return std::min<std::size_t>(events, layers_) + events / kEntries + 1 <= chunk_count_ - next_chunk_;
    }
    void push(std::uint32_t layer, std::uint32_t bit) {
        std::uint32_t* p = cursors_[layer];
        // At the end of a chunk, and before the first one, the cursor is a multiple of its size.
        if (reinterpret_cast<std::uintptr_t>(p) % kChunkBytes == 0) p = open(p);
        *p = bit;
        cursors_[layer] = p + 1;
    }

    /// Calls visit(span of bits) for all events of a layer, in any order.
    template <class Visit>
    void visit(std::uint32_t layer, const Visit& visit) const {
        const std::uint32_t* const end = cursors_[layer];
        if (end == nullptr) return;
        const std::size_t used = (reinterpret_cast<std::uintptr_t>(end) - 1) % kChunkBytes + 1;
        const std::uint32_t* words = end - used / sizeof(std::uint32_t);
        std::size_t count = used / sizeof(std::uint32_t) - kHeader;
        while (true) {
            visit(std::span(words + kHeader, count));
            if (words[0] == 0) return;
            words = chunks_[words[0] - 1].words;
            count = kEntries;
        }
    }

private:
    static constexpr std::size_t kChunkBytes = 512;
    static constexpr std::size_t kHeader = 1;  // The number of the full chunk before, plus one.
    static constexpr std::size_t kEntries = kChunkBytes / sizeof(std::uint32_t) - kHeader;

    struct alignas(kChunkBytes) Chunk {
        std::uint32_t words[kChunkBytes / sizeof(std::uint32_t)];
    };

    static std::size_t chunks_for(std::uint32_t layers, std::size_t bytes);

    /// The first entry of a new chunk, which follows the one that ends at `end`.
    std::uint32_t* open(const std::uint32_t* end) {
        std::uint32_t* const words = chunks_[next_chunk_++].words;
        words[0] = 0;
        if (end != nullptr) {
            const auto* const next = reinterpret_cast<const Chunk*>(end);
            words[0] = static_cast<std::uint32_t>(next - chunks_.get());  // One more than the number of the one before.
        }
        return words + kHeader;
    }

    /// Memory without a type of its own: of chunks, or of the words that are borrowed.
    struct Release {
        void operator()(Chunk* chunks) const { ::operator delete (chunks, std::align_val_t{kChunkBytes}); }
    };

    std::unique_ptr<Chunk[], Release> chunks_;
    std::vector<std::uint32_t*> cursors_;
    std::size_t chunk_count_ = 0;
    std::size_t next_chunk_ = 0;
    std::uint32_t layers_ = 0;
};

class Events {
public:
    /// The most that are pushed after one question for room: the triangles of a batch, or a row of columns.
    static constexpr std::size_t kMaxPushed = 4096;

    /// For volumes of `layers` layers, in a pool of `pool_bytes`; as columns if `layer_bits` words fit into it and
    /// there are at most kMaxColumnLayers, unless they are wanted in bins. Whatever the form, the pool is the same.
    void reserve(std::uint32_t layers, std::size_t layer_bits, std::size_t pool_bytes, bool in_bins);
    void clear();

    bool has_room(std::size_t events) const { return !columns_.empty() || bins_.has_room(events); }
    void push(std::uint32_t layer, std::uint32_t bit) {
        if (columns_.empty()) {
            bins_.push(layer, bit);
        } else {
            columns_[bit] ^= ~std::uint64_t{0} << layer;
        }
        ++count_;
    }
    /// Pushes `count` events, each layer · 2^32 + bit.
    void push(const std::uint64_t* events, std::size_t count);

    /// Events since the last clear().
    std::size_t count() const { return count_; }
    const EventBins& bins() const { return bins_; }
    std::span<std::uint64_t> columns() { return columns_; }

private:
    EventBins bins_;
    std::span<std::uint64_t> columns_;  // Borrowed from the bins; empty when events are binned.
    std::size_t count_ = 0;
};

}  // namespace xorvox::kernels
