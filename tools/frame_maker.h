// FrameMaker: from what is shown to the frames of a display.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include <glm/mat4x4.hpp>

#include "driver/display/description.h"
#include "driver/host/color.h"
#include "driver/host/power_budget.h"
#include "driver/host/slice_map.h"
#include "driver/host/slices.h"
#include "tools/content.h"
#include "voxelizer/bit_volume.h"

namespace xorvox::tools {

struct FrameMakerOptions {
    host::LightSettings light;  ///< What it borrows is used until the maker is made.
    bool resampled = false;     ///< Voxelized on a grid of cubes, of which the display's samples then take the nearest.
    unsigned threads = 1;       ///< That paint.
};

class FrameMaker {
public:
    /// Borrows `display`, `content` and `color` for the maker's life. Without a colour, that of the content, which must
    /// bring one.
    static Expected<std::unique_ptr<FrameMaker>> make(const DisplayDescription& display, Content& content,
                                                      const host::ColorField* color, const FrameMakerOptions& options);

    /// Sets `volume()` to the samples inside of the content after `seconds`, moved by `pose`.
    Expected<void> draw(double seconds = 0.0, const glm::dmat4& pose = glm::dmat4(1.0));
    /// Colours volume() into `frame`, frame_bytes(display) long. `number` is the frame's, from 0 in steps of 1. Where
    /// the display's supply has a limit, all light is dimmed to keep it; dimmed_to() says how far.
    Expected<void> paint(std::span<std::byte> frame, std::uint32_t number = 0);
    float dimmed_to() const { return dimmed_to_; }

    /// On the lattice of the display.
    const BitVolume& volume() const { return volume_; }

private:
    FrameMaker(const DisplayDescription& display, Content& content, const host::ColorField* color,
               const FrameMakerOptions& options);
    Expected<void> paint_once(std::span<std::byte> frame, std::uint32_t number);

    Content& content_;
    const host::ColorField* color_;  ///< Null: the content's.
    std::uint32_t slices_;
    host::FramePainter painter_;
    host::PowerBudget budget_;
    float brightness_;
    float dimmed_to_ = 1.0f;
    BitVolume volume_;
    std::optional<host::SliceMap> map_;  ///< Where resampled.
    BitVolume cartesian_;
    unsigned threads_;
};

}  // namespace xorvox::tools
