#include "voxelizer/kernels/events.h"

namespace xorvox::kernels {

/// At least one open chunk a bin, and what may be pushed after one question for room.
std::size_t EventBins::chunks_for(std::uint32_t layers, std::size_t bytes) {
    return std::max(bytes / kChunkBytes, 2 * std::size_t{layers} + Events::kMaxPushed / kEntries + 2);
}

std::size_t EventBins::reserved_bytes(std::uint32_t layers, std::size_t bytes) {
    return chunks_for(layers, bytes) * kChunkBytes + layers * sizeof(std::uint32_t*);
}

void EventBins::reserve(std::uint32_t layers, std::size_t bytes) {
    const std::size_t chunks = chunks_for(layers, bytes);
    if (chunks > chunk_count_) {
        chunk_count_ = 0;
        chunks_.reset();
        chunks_.reset(static_cast<Chunk*>(::operator new (chunks * sizeof(Chunk), std::align_val_t{kChunkBytes})));
        chunk_count_ = chunks;
    }
    cursors_.resize(layers);
    layers_ = layers;
    clear();
}

void EventBins::clear() {
    std::fill(cursors_.begin(), cursors_.end(), nullptr);
    next_chunk_ = 0;
}

void Events::reserve(std::uint32_t layers, std::size_t layer_bits, std::size_t pool_bytes, bool in_bins) {
    columns_ = {};
    bins_.reserve(layers, pool_bytes);
    const bool fits = layer_bits * sizeof(std::uint64_t) <= pool_bytes;
    if (!in_bins && layers <= kMaxColumnLayers && fits) columns_ = bins_.borrow(layer_bits);
    clear();
}

void Events::clear() {
    if (columns_.empty()) {
        bins_.clear();
    } else {
        std::fill(columns_.begin(), columns_.end(), 0);
    }
    count_ = 0;
}

void Events::push(const std::uint64_t* events, std::size_t count) {
    count_ += count;
    if (columns_.empty()) {
        for (std::size_t i = 0; i < count; ++i) {
            bins_.push(static_cast<std::uint32_t>(events[i] >> 32), static_cast<std::uint32_t>(events[i]));
        }
        return;
    }
    for (std::size_t i = 0; i < count; ++i) {
        columns_[static_cast<std::uint32_t>(events[i])] ^= ~std::uint64_t{0} << (events[i] >> 32);
    }
}

}  // namespace xorvox::kernels
