// SphericalImageColor: an equirectangular picture, such as a map of the world, by direction from the box's centre.
#pragma once

#include <memory>
#include <span>
#include <utility>

#include <glm/vec3.hpp>

#include "driver/host/color.h"
#include "voxelizer/image.h"

namespace xorvox::host {

class SphericalImageColor final : public ColorField {
public:
    /// The picture's middle is towards +x, its right half goes on towards +y, as a globe is seen from outside; its
    /// upper border is up. Bilinear in linear light, without a seam. Directions are in the box's own measure, along
    /// each axis 0 … 1. `image`, not null and not empty, is shared and must not change.
    explicit SphericalImageColor(std::shared_ptr<const Image> image) : image_(std::move(image)) {}

    void evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> colors) const override;

private:
    std::shared_ptr<const Image> image_;
};

}  // namespace xorvox::host
