// Pictures of a light field: a perspective view drawn with OpenGL, and orthographic views that need none.
//
// The eye of a picture sees what the eye of a person fuses: every place that flashed in the cycle, at once. Flashes at
// one place are drawn as one voxel in the mean of their light. A voxel is drawn as large as the space it stands for and
// shaded from the lie of its lit neighbours, so that they read as one solid.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "driver/display/description.h"
#include "sim/image.h"
#include "sim/optics.h"
#include "voxelizer/error.h"
#include "voxelizer/gl/context.h"

namespace xorvox::sim {

/// What a picture is filled with.
enum class Framing : std::uint8_t {
    Object,  ///< What is lit, as large as it fits. Nothing lit: the display.
    Display  ///< All of the display, wherever it is lit, and light outside of it; +x and the axis of what turns marked.
};

struct PictureOptions {
    std::uint32_t width = 960;    ///< 16 … 4096.
    std::uint32_t height = 720;   ///< 16 … 4096.
    double azimuth_deg = 30.0;    ///< Where the camera stands: 0 in front (at -y), 90 on the right (+x).
    double elevation_deg = 22.0;  ///< And how high: -89 … 89; 90 would look straight down.
    Framing framing = Framing::Object;
    gl::ContextKind context = gl::ContextKind::Auto;
    /// What the camera frames instead of the light that it shows, so that pictures can be laid over each other;
    /// borrowed.
    const LightField* framed = nullptr;
};

/// An image and how well it is filled.
struct Picture {
    Image image;
    std::vector<float> cover;  ///< Of each pixel the part, 0 … 1, that shows the lit object.
    double covered = 0.0;      ///< Share of the pixels that show the lit object: at least half of each.
    double clipped = 0.0;      ///< Share of the pixels with a channel at 255.
    std::string drawn_by;      ///< The OpenGL context and renderer, or "CPU".
};

/// A view in perspective from slightly above: the camera looks from the side of azimuth_deg, as near as what it
/// frames fits, before a dark ground with the display's outline.
/// Errors: options out of range; no OpenGL (the message says what was tried and what to install).
Expected<Picture> render_perspective(const DisplayDescription& display, const LightField& field,
                                     const PictureOptions& options = {});

/// Three views side by side at one scale, without OpenGL: front (from -y: x to the right, z up), side (from +x: y to
/// the right, z up) and top (from +z: x to the right, y up), with their names from 240 pixels on. The scale is the
/// largest at which what it frames fits, with a margin. What is nearer is brighter; the ground is lighter where the
/// display is. The picture is 3·`side` pixels wide and `side` high. `side`: 16 … 2048.
Picture render_orthographic(const DisplayDescription& display, const LightField& field, std::uint32_t side = 480,
                            Framing framing = Framing::Object);

}  // namespace xorvox::sim
