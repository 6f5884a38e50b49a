#include "driver/host/volume_color.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "driver/host/color_list.h"
#include "driver/host/color_space.h"
#include "voxelizer/volume_place.h"

namespace xorvox::host {

glm::dmat4 box_to_volume(const glm::dvec3& lower, const glm::dvec3& upper, const glm::dmat4& to_volume) {
    glm::dmat4 box(1.0);
    for (int axis = 0; axis < 3; ++axis) {
        box[axis][axis] = upper[axis] - lower[axis];
        box[3][axis] = lower[axis];
    }
    return to_volume * box;
}

VolumeColor::VolumeColor(std::shared_ptr<const SampledVolume> volume, const glm::dmat4& placement,
                         std::optional<TransferFunction> transfer)
    : volume_(std::move(volume)), place_(*volume_, placement), transfer_(std::move(transfer)) {
    if (volume_->kind == VolumeKind::Labels) labels_.emplace(volume_, placement, std::span<const glm::dvec3>());
    if (volume_->kind != VolumeKind::Scalar || transfer_) return;
    const auto [least, most] = std::ranges::minmax_element(volume_->values);
    transfer_ = default_transfer(double{*least}, double{*most});
}

void VolumeColor::set_placement(const glm::dmat4& placement) {
    place_.set(placement);
    if (labels_) labels_->set_placement(placement);
}

void VolumeColor::evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> colors) const {
    const std::array<float, 256>& light = srgb_light();
    switch (volume_->kind) {
        case VolumeKind::Labels: return labels_->evaluate(points, colors);
        case VolumeKind::Binary: std::ranges::fill(colors, glm::vec3(1.0f)); return;
        case VolumeKind::Scalar:
            for (std::size_t i = 0; i < points.size(); ++i) {
                colors[i] = transfer_->at(value_between(*volume_, place_.at(points[i])));
            }
            return;
        case VolumeKind::Colors:
            for (std::size_t i = 0; i < points.size(); ++i) {
                const Rgba& code = volume_->colors[nearest_voxel(*volume_, place_.at(points[i]))];
                colors[i] =
                    glm::vec3(light[code[0]], light[code[1]], light[code[2]]) * (static_cast<float>(code[3]) / 255.0f);
            }
            return;
    }
}

std::optional<glm::vec3> VolumeColor::constant() const {
    if (volume_->kind == VolumeKind::Binary) return glm::vec3(1.0f);
    return std::nullopt;
}

TransferFunction default_transfer(double least, double most) {
    const auto colors = rising_colors();
    if (!(most > least)) return TransferFunction({{most, colors.back()}});
    std::vector<TransferFunction::Stop> stops;
    for (std::size_t n = 0; n < colors.size(); ++n) {
        const double part = static_cast<double>(n) / static_cast<double>(colors.size() - 1);
        stops.push_back({least + (most - least) * part, colors[n]});
    }
    return TransferFunction(std::move(stops));
}

}  // namespace xorvox::host
