// Comparison: sent, lit and their differences side by side, in the same view.
//
//   ┌────────────────┬────────────────┬────────────────┐
//   │ sent: what a   │ lit: what was  │ differences    │   What was lit as it was sent is grey among the
//   │ perfect display│ really seen    │                │   differences. In colours:
//   │ would show     │                │                │     lost       sent, and not lit
//   │                │                │                │     extra      lit, and not sent
//   ├────────────────┴────────────────┴────────────────┤     displaced  further from its sample than it may be
//   │ legend, with numbers of voxels                   │     changed    more or less light than sent by a quarter
//   └──────────────────────────────────────────────────┘                and more
//
// A difference stands where its voxel is, behind what is in front of it, through which it shines. Of a shutter
// that was not open for whole cycles, light is compared with what was due (ExposedVoxel::due).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "sim/exposure.h"
#include "sim/picture.h"
#include "voxelizer/error.h"

namespace xorvox::sim {

/// Draws all three with `options` (their framing is that of all light, sent and lit), each of options.width ×
/// options.height pixels; the picture is three times as wide, and higher by titles and legend. `page` and `brightness`
/// as for for_each_voxel() (sim/exposed_voxels.h). Picture::covered and clipped are of the left side. Errors as of
/// render_perspective(). Throws std::bad_alloc.
Expected<Picture> render_comparison(const Exposure& exposure, std::span<const std::byte> page, std::uint8_t brightness,
                                    const PictureOptions& options = {});

}  // namespace xorvox::sim
