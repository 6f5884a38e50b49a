// LabelColor: each part of a labelled volume in a colour of its own.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "driver/host/color.h"
#include "driver/host/volume_placement.h"
#include "voxelizer/sampled_volume.h"

namespace xorvox::host {

/// The linear light of a label where there is no palette: hues of Oklab that follow each other by the golden angle, so
/// that any few labels in a row differ well, in three lightnesses. Label 0, what is outside, is grey: #808080. From
/// label 256 on they begin again with that of label 1.
glm::dvec3 distinct_color(std::uint32_t label);

/// Whether the values of `volume` can be labels: Labels and Binary are, and a Scalar of whole numbers from 0 to 2^24.
bool has_labels(const SampledVolume& volume);

class LabelColor final : public ColorField {
public:
    /// A point has the colour of the nearest voxel's label. Label L has that of entry L of the volume's palette,
    /// without regard to its opacity; where `colors` (linear light) are given, label 1 has the first of them and so on,
    /// over and over; else, and beyond the palette, it is distinct_color(L). Label 0 is that of distinct_color() in any
    /// case. `volume`, not null, must pass has_labels(); it is shared and must not change. `placement` as for
    /// TextureColor.
    LabelColor(std::shared_ptr<const SampledVolume> volume, const glm::dmat4& placement,
               std::span<const glm::dvec3> colors);

    /// Where the volume lies from now on; no thread may evaluate meanwhile.
    void set_placement(const glm::dmat4& placement) { place_.set(placement); }

    void evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> colors) const override;

private:
    std::shared_ptr<const SampledVolume> volume_;
    VolumePlacement place_;
    std::vector<glm::vec3> palette_;  ///< Of labels from 0 on; those beyond have one of the entries from repeats_ on.
    std::uint32_t repeats_ = 1;
};

}  // namespace xorvox::host
