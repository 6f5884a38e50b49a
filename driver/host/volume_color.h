// VolumeColor: the colours that a volume of another program has of its own.
#pragma once

#include <memory>
#include <optional>

#include <glm/mat4x4.hpp>

#include "driver/host/color.h"
#include "voxelizer/sampled_volume.h"
#include "voxelizer/transfer_function.h"

namespace xorvox::host {

/// From 0 … 1 along the sides of a box to voxels: (i, j, k) is the centre of voxel (i, j, k). `to_volume` takes places
/// of the box's own space to voxels.
glm::dmat4 box_to_volume(const glm::dvec3& lower, const glm::dvec3& upper, const glm::dmat4& to_volume);

/// Colors and Labels have the colour of the nearest voxel, dimmed by its opacity; labels that the palette does not have
/// take turns through twelve colours of ours. Scalar: the transfer function of the value between the voxels. Binary:
/// white. Beyond the volume it is as at its edge.
class VolumeColor final : public ColorField {
public:
    /// `volume` has a voxel at least; `box_to_volume` as above; `transfer` is asked of Scalar only, and is
    /// default_transfer() of its values when there is none.
    VolumeColor(std::shared_ptr<const SampledVolume> volume, const glm::dmat4& box_to_volume,
                std::optional<TransferFunction> transfer = std::nullopt);

    void evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> colors) const override;
    std::optional<glm::vec3> constant() const override;

private:
    glm::vec3 at(const glm::dvec3& place) const;

    std::shared_ptr<const SampledVolume> volume_;
    glm::dmat4 to_volume_;
    std::optional<TransferFunction> transfer_;
};

/// From blue over green to gold, ever lighter, between two values; gold alone when they are equal.
TransferFunction default_transfer(double least, double most);

}  // namespace xorvox::host
