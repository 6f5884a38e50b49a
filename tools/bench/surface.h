// Surface: how many voxels of a solid are at its surface.
#pragma once

#include <cstddef>

#include "voxelizer/bit_volume.h"

namespace xorvox::tools {

/// Set voxels with at least one of their six neighbours clear, or outside of the volume.
std::size_t count_surface(ConstBitVolumeView volume);

}  // namespace xorvox::tools
