// From events to bits or lists, layer by layer, in the cache.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "voxelizer/bit_volume.h"
#include "voxelizer/crossings.h"
#include "voxelizer/kernels/events.h"
#include "voxelizer/kernels/kernel_table.h"

namespace xorvox::kernels {

/// Layers begin <= k < end.
struct LayerRange {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
};

/// Flips the bits of all binned events of these layers in one layer of parities, and those of `with`, unless null,
/// which holds events that add_events() has put there.
void apply_events(std::span<const Events> events, LayerRange layers, std::uint64_t* parities,
                  const BitVolumeView* with);

/// Writes layers to `out`, given the parities below the first of them; those of the last one remain in `parities`.
/// `out_has_events`: it holds events that add_events() has put there before.
void finish_layers(const KernelTable& table, std::span<const Events> events, LayerRange layers, std::uint64_t* parities,
                   bool out_has_events, bool stream, BitVolumeView out);

/// Puts the binned events of these layers into `out`, to be finished later; the first time `out` is cleared.
void add_events(std::span<const Events> events, LayerRange layers, bool first, BitVolumeView out);

/// Writes words begin … end - 1 of every layer from the columns of all threads.
void finish_columns(std::span<Events> events, std::size_t begin, std::size_t end, BitVolumeView out);

/// The bits of events, a list for each layer.
using LayeredBits = std::vector<std::vector<std::uint32_t>>;

/// Appends the binned events of all layers.
void keep_events(std::span<const Events> events, LayeredBits& kept);

/// Makes crossing lists of kept events; `lists` has its shape.
void list_crossings(const LayeredBits& kept, CrossingLists& lists);

}  // namespace xorvox::kernels
