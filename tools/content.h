// Content: what is shown, at every moment of its own time, in the millimetres of the display that it was fitted to.
#pragma once

#include <glm/mat4x4.hpp>

#include "driver/host/color.h"
#include "voxelizer/bit_volume.h"
#include "voxelizer/error.h"
#include "voxelizer/lattice.h"

namespace xorvox::tools {

/// One thread at a time.
class Content {
public:
    virtual ~Content() = default;

    /// How long it lasts before it begins anew; 0: nothing in it moves.
    virtual double duration_seconds() const = 0;

    /// The sample points of the calls that follow. The lattice's tables are borrowed.
    virtual Expected<void> set_lattice(const Lattice& lattice) = 0;

    /// Sets `voxels`, of the lattice's shape, to the samples inside of what is there after `seconds`, moved by `pose`.
    virtual Expected<void> draw(double seconds, const glm::dmat4& pose, BitVolumeView voxels) = 0;

    /// Whether it brings colours.
    virtual bool has_own_color() const { return false; }
    /// These colours, as they lay when it was drawn last; only where it has them, after draw().
    virtual const host::ColorField* own_color() { return nullptr; }
};

}  // namespace xorvox::tools
