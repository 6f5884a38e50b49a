// TextureColor: colours from a sampled 3D map (Rueda et al., sections 3 and 5), trilinear between its voxels.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "driver/host/color.h"
#include "driver/host/color_space.h"
#include "driver/host/volume_placement.h"
#include "voxelizer/sampled_volume.h"

namespace xorvox::host {

class TextureColor final : public ColorField {
public:
    /// A volume of Colors has its own colours, mixed in linear light; voxels count as much as they are opaque, wholly
    /// transparent ones only among themselves. The values of any other kind are mixed, and their least has the first
    /// of `stops`, their most the last. `stops`: two or more linear colours; of Colors not looked at. `volume`, not
    /// null, is shared and must not change. `placement` as in volume_placement.h, mostly stretched(*volume); outside of
    /// the volume the border's colours go on. Throws std::bad_alloc.
    TextureColor(std::shared_ptr<const SampledVolume> volume, const glm::dmat4& placement,
                 std::span<const glm::dvec3> stops);

    void evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> colors) const override;

private:
    std::shared_ptr<const SampledVolume> volume_;
    VolumePlacement place_;
    std::optional<Ramp> ramp_;  ///< None of Colors.
    double least_ = 0.0;
    double per_span_ = 0.0;  ///< 1 / (most - least); 0 when they are the same.
};

}  // namespace xorvox::host
