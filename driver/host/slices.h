// Slices: voxels and colours into a frame, through the light pipeline of driver/host/light.h, in the scan-out order of
// driver/display/description.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "driver/display/description.h"
#include "driver/display/lattice.h"
#include "driver/host/color.h"
#include "driver/host/light.h"
#include "driver/host/light_gain.h"
#include "driver/host/pixel_encoder.h"
#include "driver/host/sample_points.h"
#include "driver/host/wire_order.h"
#include "voxelizer/bit_volume.h"

namespace xorvox::host {

/// Turns volumes on a display's lattice into frames. Makes its tables once; then no allocation per frame.
class FramePainter {
public:
    /// `display` must be valid (validate_display); what it borrows must outlive the painter. Throws std::bad_alloc.
    explicit FramePainter(const DisplayDescription& display, const LightSettings& settings = {});
    FramePainter(const FramePainter&) = delete;
    FramePainter& operator=(const FramePainter&) = delete;

    const DisplayLattice& lattice() const { return lattice_; }

    /// Of the frames that are painted from now on: 0 … 1. Not while one is being painted.
    void set_brightness(float brightness);

    /// Writes frame_bytes(display) to `frame`: every set voxel that the mode allows lit in its colour, with the light
    /// that the settings make of it, every other pixel and all padding dark. Without dithering a set voxel whose light
    /// is too faint for the display is lit with the faintest codes of its strong channels (PixelEncoder::nearest); only
    /// black is dark. `number` is the frame's, from 0 in steps of 1: with Dither::Temporal thresholds go by it.
    /// `volume` has the shape of lattice(). `color` is asked only at voxels to be lit, at points 0 … 1 along the box of
    /// extent(display). Ok or InvalidArgument. Several threads may paint different frames at once.
    Status paint(ConstBitVolumeView volume, const ColorField& color, std::span<std::byte> frame,
                 std::uint32_t number = 0) const;

    /// The same for slices first … first + count − 1 alone; the rest of `frame`, which is whole, is left as it is.
    /// Several threads may paint different slices of one frame at once.
    Status paint_slices(ConstBitVolumeView volume, const ColorField& color, std::span<std::byte> frame,
                        std::uint32_t first, std::uint32_t count, std::uint32_t number = 0) const;

private:
    DisplayDescription display_;
    DisplayLattice lattice_;
    WireOrder order_;
    SamplePoints points_;
    PixelEncoder encoder_;
    SampleGains gains_;
    Dither dither_;
    glm::vec3 white_;
    float brightness_ = 1.0f;
    std::vector<std::uint64_t> allowed_;  ///< Uniform mode: the bits of all rows as WireOrder::fetch gives them.
    std::size_t slice_words_ = 0;         ///< Of allowed_, for one slice.
};

}  // namespace xorvox::host
