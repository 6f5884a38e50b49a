// VolumeColor: the colours that a volume of another program has of its own.
#pragma once

#include <memory>
#include <optional>

#include <glm/mat4x4.hpp>

#include "driver/host/color.h"
#include "driver/host/label_color.h"
#include "driver/host/volume_placement.h"
#include "voxelizer/sampled_volume.h"
#include "voxelizer/transfer_function.h"

namespace xorvox::host {

/// The placement (driver/host/volume_placement.h) of a volume in the box from `lower` to `upper`; `to_volume` takes
/// places of the box's own space to voxels.
glm::dmat4 box_to_volume(const glm::dvec3& lower, const glm::dvec3& upper, const glm::dmat4& to_volume);

/// Colors: the nearest voxel's, dimmed by its opacity. Labels: as LabelColor has them. Scalar: the transfer function of
/// the value between the voxels. Binary: white. Beyond the volume it is as at its edge.
class VolumeColor final : public ColorField {
public:
    /// `volume` has a voxel at least, and is shared; `transfer` is asked of Scalar only, and is default_transfer() of
    /// its values when there is none.
    VolumeColor(std::shared_ptr<const SampledVolume> volume, const glm::dmat4& placement,
                std::optional<TransferFunction> transfer = std::nullopt);

    /// Where the volume lies from now on; no thread may evaluate meanwhile.
    void set_placement(const glm::dmat4& placement);

    void evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> colors) const override;
    std::optional<glm::vec3> constant() const override;

private:
    std::shared_ptr<const SampledVolume> volume_;
    VolumePlacement place_;
    std::optional<TransferFunction> transfer_;
    std::optional<LabelColor> labels_;
};

/// From blue over green to gold, ever lighter, between two values; gold alone when they are equal.
TransferFunction default_transfer(double least, double most);

}  // namespace xorvox::host
