// Floor: what a machine cannot do without to turn a mesh into bits, the measure of how much more is done.
#pragma once

#include <cstdint>

#include "voxelizer/bit_volume.h"
#include "voxelizer/mesh.h"

namespace xorvox::tools {

/// Writes every byte of the volume once.
void clear(BitVolumeView volume);

/// Reads every word of the volume and writes all but the lowest layer: each layer ^= the layer below, in place.
void xor_layers(BitVolumeView volume);

/// Reads the three coordinates of every corner of every face by its index; a number that depends on all of them, so
/// that no compiler leaves a read out. The mesh must pass validate().
std::uint64_t read_corners(const MeshView& mesh);

}  // namespace xorvox::tools
