#include "driver/host/label_color.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "driver/host/color_space.h"
#include "voxelizer/volume_place.h"

namespace xorvox::host {
namespace {

constexpr std::uint32_t kDistinctLabels = 255;
constexpr float kMostLabel = 0x1p24f;

}  // namespace

glm::dvec3 distinct_color(std::uint32_t label) {
    if (label == 0) return linear_from_hex(0x808080);
    constexpr double kGoldenTurn = 0.3819660112501051;  // 2 - the golden ratio
    constexpr std::array kLightness{0.72, 0.85, 0.58};
    const std::uint32_t number = (label - 1) % kDistinctLabels;
    const double turns = 0.08 + kGoldenTurn * number;
    return linear_from_oklch(kLightness[number % 3], 0.17, turns - static_cast<std::uint32_t>(turns));
}

bool has_labels(const SampledVolume& volume) {
    if (volume.kind == VolumeKind::Colors) return false;
    return std::ranges::all_of(volume.values, [](float value) {
        return value >= 0.0f && value <= kMostLabel && static_cast<float>(static_cast<std::uint32_t>(value)) == value;
    });
}

LabelColor::LabelColor(std::shared_ptr<const SampledVolume> volume, const glm::dmat4& placement,
                       std::span<const glm::dvec3> colors)
    : volume_(std::move(volume)), place_(*volume_, placement) {
    palette_.emplace_back(distinct_color(0));
    if (!colors.empty()) {
        palette_.insert(palette_.end(), colors.begin(), colors.end());
        return;
    }
    const std::array<float, 256>& light = srgb_light();
    const auto& codes = volume_->palette;
    for (std::size_t label = 1; label < codes.size(); ++label) {
        palette_.emplace_back(light[codes[label][0]], light[codes[label][1]], light[codes[label][2]]);
    }
    // A whole round of the others: each of them is the same, one round of labels further on.
    repeats_ = static_cast<std::uint32_t>(palette_.size());
    for (std::uint32_t i = 0; i < kDistinctLabels; ++i) palette_.emplace_back(distinct_color(repeats_ + i));
}

void LabelColor::evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> colors) const {
    const auto size = static_cast<std::uint32_t>(palette_.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const std::size_t voxel = nearest_voxel(*volume_, place_.at(points[i]));
        const auto label = static_cast<std::uint32_t>(volume_->values[voxel]);
        colors[i] = palette_[label < size ? label : repeats_ + (label - repeats_) % (size - repeats_)];
    }
}

}  // namespace xorvox::host
