// Example frames: what a display's frames come down to when they are compressed, measured on a solid that every display
// can show.
//
// The solid is a ball with five lobes that fills the display and turns about the z axis ten times a minute. It is an
// example: a model with finer detail takes more, a smaller or still one less.
#pragma once

#include <cstdint>

#include "driver/display/description.h"
#include "voxelizer/error.h"

namespace xorvox::host {

/// Bytes of one frame on the wire, packets' headers included.
struct ExampleBytes {
    double keyframe = 0.0;  ///< Alone.
    double moving = 0.0;    ///< After the frame before it: as a delta, or a keyframe where that is shorter.
};

struct ExampleFrames {
    ExampleBytes constant;              ///< In white.
    ExampleBytes gradient;              ///< From bottom to top in many colours.
    double lit = 0.0;                   ///< The part of the samples that is inside.
    std::uint32_t measured_slices = 0;  ///< Of the display's; if not all, the numbers above are scaled up.
};

/// Voxelizes, paints and encodes two frames of the example in two colourings, on as many slices as have at most
/// `most_samples` samples, at least one. `display` must be valid (validate_display). Fails with the voxelizer's
/// message. Throws std::bad_alloc.
Expected<ExampleFrames> measure_example(const DisplayDescription& display, std::uint64_t most_samples);

/// Bytes on the wire of a frame of `frame_bytes` that is sent as it is, in packets of up to 64 KiB.
std::uint64_t raw_wire_bytes(std::uint64_t frame_bytes);

}  // namespace xorvox::host
