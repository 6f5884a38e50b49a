#include "voxelizer/kernels/layers.h"

#include <algorithm>

namespace xorvox::kernels {
namespace {

void flip(std::span<const Events> events, std::uint32_t layer, std::uint64_t* words) {
    for (const Events& each : events) {
        each.bins().visit(layer, [words](std::span<const std::uint32_t> bits) {
            for (const std::uint32_t bit : bits) words[bit / 64] ^= std::uint64_t{1} << (bit % 64);
        });
    }
}

/// Bit i of word j becomes bit j of word i: blocks of half the size change places, again and again.
void transpose(std::uint64_t (&block)[64]) {
    std::uint64_t low = 0x00000000ffffffff;
    for (std::uint32_t half = 32; half != 0; half /= 2, low ^= low << half) {
        for (std::uint32_t i = 0; i < 64; i = ((i | half) + 1) & ~half) {
            const std::uint64_t differs = ((block[i] >> half) ^ block[i | half]) & low;
            block[i] ^= differs << half;
            block[i | half] ^= differs;
        }
    }
}

std::size_t layer_words(const BitVolumeView& out) {
    return row_words(out.nx) * out.ny;
}

}  // namespace

void apply_events(std::span<const Events> events, LayerRange layers, std::uint64_t* parities,
                  const BitVolumeView* with) {
    for (std::uint32_t k = layers.begin; k < layers.end; ++k) {
        flip(events, k, parities);
        if (with == nullptr) continue;
        const std::size_t words = layer_words(*with);
        for (std::size_t i = 0; i < words; ++i) parities[i] ^= with->words[k * words + i];
    }
}

void finish_layers(const KernelTable& table, std::span<const Events> events, LayerRange layers, std::uint64_t* parities,
                   bool out_has_events, bool stream, BitVolumeView out) {
    const std::size_t words = layer_words(out);
    for (std::uint32_t k = layers.begin; k < layers.end; ++k) {
        std::uint64_t* const layer = out.words.data() + k * words;
        if (out_has_events) {
            for (std::size_t i = 0; i < words; ++i) parities[i] ^= layer[i];
        }
        flip(events, k, parities);
        table.copy_layer(parities, layer, words, stream);
    }
}

void add_events(std::span<const Events> events, LayerRange layers, bool first, BitVolumeView out) {
    const std::size_t words = layer_words(out);
    for (std::uint32_t k = layers.begin; k < layers.end; ++k) {
        std::uint64_t* const layer = out.words.data() + k * words;
        if (first) std::fill_n(layer, words, 0);
        flip(events, k, layer);
    }
}

void finish_columns(std::span<Events> events, std::size_t begin, std::size_t end, BitVolumeView out) {
    const std::size_t words = layer_words(out);
    std::uint64_t block[64];
    for (std::size_t w = begin; w < end; ++w) {
        std::copy_n(events[0].columns().data() + 64 * w, 64, block);
        for (std::size_t other = 1; other < events.size(); ++other) {
            const std::uint64_t* const columns = events[other].columns().data() + 64 * w;
            for (std::size_t i = 0; i < 64; ++i) block[i] ^= columns[i];
        }
        transpose(block);
        for (std::uint32_t k = 0; k < out.nz; ++k) out.words[k * words + w] = block[k];
    }
}

void keep_events(std::span<const Events> events, LayeredBits& kept) {
    for (std::uint32_t k = 0; k < kept.size(); ++k) {
        for (const Events& each : events) {
            each.bins().visit(k, [&](std::span<const std::uint32_t> bits) {
                kept[k].insert(kept[k].end(), bits.begin(), bits.end());
            });
        }
    }
}

void list_crossings(const LayeredBits& kept, CrossingLists& lists) {
    const std::size_t row_bits = row_words(lists.nx) * 64;
    const auto column_of = [&](std::uint32_t bit) { return bit / row_bits * lists.nx + bit % row_bits; };
    // Counting sort: the layers are visited from the top, so that each column, filled from its end, is in order.
    lists.starts.assign(std::size_t{lists.nx} * lists.ny + 1, 0);
    for (const auto& bits : kept) {
        for (const std::uint32_t bit : bits) ++lists.starts[column_of(bit)];
    }
    for (std::size_t c = 1; c < lists.starts.size(); ++c) lists.starts[c] += lists.starts[c - 1];
    lists.first_above.resize(lists.starts.back());
    for (std::size_t k = kept.size(); k-- > 0;) {
        for (const std::uint32_t bit : kept[k]) {
            lists.first_above[--lists.starts[column_of(bit)]] = static_cast<std::uint16_t>(k);
        }
    }
}

}  // namespace xorvox::kernels
