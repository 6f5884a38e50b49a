// Comparison: sent and seen side by side, in the same view.
//
//   ┌────────────────┬────────────────┐
//   │ sent: what a   │ lit: what was  │   What was lit as it was sent is grey on the right. In colours, and seen
//   │ perfect display│ really lit     │   through what stands before it:
//   │ would show     │                │     lost       sent, and not lit
//   │                │                │     extra      lit, and not sent
//   ├────────────────┴────────────────┤     displaced  further from its sample than it may be
//   │ legend, with numbers of voxels  │     changed    more or less light than sent by a quarter and more
//   └─────────────────────────────────┘
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "sim/exposure.h"
#include "sim/picture.h"
#include "voxelizer/error.h"

namespace xorvox::sim {

/// Draws both with `options` (their framing is that of all light, sent and lit), each of options.width × options.height
/// pixels; the picture is twice as wide, and higher by the legend. `page` and `brightness` as for for_each_voxel()
/// (sim/exposed_voxels.h). Picture::covered and clipped are of the left side. Errors as of render_perspective().
/// Throws std::bad_alloc.
Expected<Picture> render_comparison(const Exposure& exposure, std::span<const std::byte> page, std::uint8_t brightness,
                                    const PictureOptions& options = {});

}  // namespace xorvox::sim
