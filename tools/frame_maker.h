// FrameMaker: from a mesh in a display's millimetres to its frames, while the mesh moves.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "driver/display/description.h"
#include "driver/host/color.h"
#include "driver/host/slice_map.h"
#include "driver/host/slices.h"
#include "voxelizer/bit_volume.h"
#include "voxelizer/mesh.h"
#include "voxelizer/solid_voxelizer.h"

namespace xorvox::tools {

struct FrameMakerOptions {
    host::LightSettings light;
    bool resampled = false;  ///< Voxelized on a grid of cubes, of which the display's samples then take the nearest.
    unsigned threads = 1;    ///< Of both steps.
};

class FrameMaker {
public:
    /// Borrows `display`, `mesh`, which messages call `source`, and `color` for the maker's life.
    static Expected<std::unique_ptr<FrameMaker>> make(const DisplayDescription& display, const Mesh& mesh,
                                                      std::string source, const host::ColorField& color,
                                                      const FrameMakerOptions& options);

    /// Puts the vertices at `positions`, as many as the mesh has, which are borrowed until the next call; sets
    /// `volume()` to the samples inside.
    Expected<void> voxelize(std::span<const glm::dvec3> positions);
    /// Colours volume() into `frame`, frame_bytes(display) long.
    Expected<void> paint(std::span<std::byte> frame) const;

    /// On the lattice of the display.
    const BitVolume& volume() const { return volume_; }

private:
    FrameMaker(const DisplayDescription& display, const Mesh& mesh, std::string source, const host::ColorField& color,
               const FrameMakerOptions& options);
    Expected<void> begin();
    Lattice drawn_on() const { return map_ ? map_->grid() : painter_.lattice().view(); }

    std::string source_;
    const Mesh& mesh_;
    std::uint32_t slices_;
    const host::ColorField& color_;
    host::FramePainter painter_;
    BitVolume volume_;
    std::optional<host::SliceMap> map_;  ///< Where resampled.
    BitVolume cartesian_;
    unsigned threads_;
    SolidVoxelizer voxelizer_;
};

}  // namespace xorvox::tools
