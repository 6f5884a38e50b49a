// Slices: voxels and colours into a frame, in the scan-out order of driver/display/description.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "driver/display/description.h"
#include "driver/display/lattice.h"
#include "driver/host/color.h"
#include "driver/host/pixel.h"
#include "voxelizer/bit_volume.h"

namespace xorvox::host {

/// Turns volumes on a display's lattice into frames. Makes its slice map once; then no allocation per frame.
class FramePainter {
public:
    /// `display` must be valid (validate_display). Throws std::bad_alloc.
    explicit FramePainter(const DisplayDescription& display);

    const DisplayLattice& lattice() const { return lattice_; }

    /// Writes frame_bytes(display) to `frame`: every set voxel lit in its colour, every other pixel and all padding
    /// dark. A set voxel whose colour is too faint for the pixel format is lit with the faintest codes of its strong
    /// channels (visible_code); only black is dark. `volume` has the shape of lattice(). `color` is asked only at set
    /// voxels, at points 0 … 1 along the box of extent(display). Ok or InvalidArgument. Several threads may paint
    /// different frames at once.
    Status paint(ConstBitVolumeView volume, const ColorField& color, std::span<std::byte> frame) const;

private:
    /// One row of a panel in one slice: `columns` voxels of row (y, k) of the volume, from x on.
    struct PixelRow {
        std::size_t offset_bytes;  ///< In the frame.
        std::uint32_t x, y, k;
        std::uint32_t columns;
    };

    DisplayDescription display_;
    DisplayLattice lattice_;
    DisplayExtent extent_;
    std::vector<PixelRow> rows_;  ///< The slice map: in frame order, each voxel in exactly one row.
};

}  // namespace xorvox::host
