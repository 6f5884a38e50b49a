#include "driver/host/volume_color.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "driver/host/color_space.h"
#include "voxelizer/volume_place.h"

namespace xorvox::host {
namespace {

// Neighbouring labels are far apart in hue; none is dark.
constexpr std::array<std::uint32_t, 12> kLabelColors{0xff5040, 0x30d050, 0x4080ff, 0xffd020, 0xd050ff, 0x20e0e0,
                                                     0xff9030, 0x90f030, 0x8060ff, 0xff60b0, 0x20ffa0, 0xffb0a0};

glm::vec3 light_of(const Rgba& color) {
    const glm::dvec3 linear(linear_from_srgb(color[0]), linear_from_srgb(color[1]), linear_from_srgb(color[2]));
    return glm::vec3(linear * (color[3] / 255.0));
}

glm::vec3 label_color(const SampledVolume& volume, float label) {
    const auto number = static_cast<std::size_t>(label);
    if (number < volume.palette.size()) return light_of(volume.palette[number]);
    return glm::vec3(linear_from_hex(kLabelColors[number % kLabelColors.size()]));
}

}  // namespace

glm::dmat4 box_to_volume(const glm::dvec3& lower, const glm::dvec3& upper, const glm::dmat4& to_volume) {
    glm::dmat4 box(1.0);
    for (int axis = 0; axis < 3; ++axis) {
        box[axis][axis] = upper[axis] - lower[axis];
        box[3][axis] = lower[axis];
    }
    return to_volume * box;
}

VolumeColor::VolumeColor(std::shared_ptr<const SampledVolume> volume, const glm::dmat4& box_to_volume,
                         std::optional<TransferFunction> transfer)
    : volume_(std::move(volume)), to_volume_(box_to_volume), transfer_(std::move(transfer)) {
    if (volume_->kind != VolumeKind::Scalar || transfer_) return;
    const auto [least, most] = std::ranges::minmax_element(volume_->values);
    transfer_ = default_transfer(double{*least}, double{*most});
}

glm::vec3 VolumeColor::at(const glm::dvec3& place) const {
    const SampledVolume& volume = *volume_;
    switch (volume.kind) {
        case VolumeKind::Scalar: return transfer_->at(value_between(volume, place));
        case VolumeKind::Colors: return light_of(volume.colors[nearest_voxel(volume, place)]);
        case VolumeKind::Labels: return label_color(volume, volume.values[nearest_voxel(volume, place)]);
        case VolumeKind::Binary: break;
    }
    return glm::vec3(1.0f);
}

void VolumeColor::evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> colors) const {
    const glm::dvec3 last(volume_->nx - 1, volume_->ny - 1, volume_->nz - 1);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::dvec3 place = mapped(to_volume_, glm::dvec3(points[i]));
        colors[i] = at(glm::clamp(place, glm::dvec3(0.0), last));
    }
}

std::optional<glm::vec3> VolumeColor::constant() const {
    if (volume_->kind == VolumeKind::Binary) return glm::vec3(1.0f);
    return std::nullopt;
}

TransferFunction default_transfer(double least, double most) {
    constexpr std::array<std::uint32_t, 5> kRamp{0x205cff, 0x00e0ff, 0x4ae258, 0xd0e030, 0xffd400};
    std::vector<TransferFunction::Stop> stops;
    if (!(most > least)) return TransferFunction({{most, linear_from_hex(kRamp.back())}});
    for (std::size_t n = 0; n < kRamp.size(); ++n) {
        const double part = static_cast<double>(n) / static_cast<double>(kRamp.size() - 1);
        stops.push_back({least + (most - least) * part, linear_from_hex(kRamp[n])});
    }
    return TransferFunction(std::move(stops));
}

}  // namespace xorvox::host
