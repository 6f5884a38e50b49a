#include "driver/host/texture_color.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "voxelizer/volume_place.h"

namespace xorvox::host {
namespace {

/// The eight voxels around a place, and how much each counts: 1 in all.
struct Neighbours {
    std::array<std::size_t, 8> voxels;
    std::array<float, 8> weights;
};

Neighbours neighbours(const SampledVolume& volume, const glm::dvec3& place) {
    const auto i = static_cast<std::uint32_t>(place.x);
    const auto j = static_cast<std::uint32_t>(place.y);
    const auto k = static_cast<std::uint32_t>(place.z);
    const auto x = static_cast<float>(place.x - i);
    const auto y = static_cast<float>(place.y - j);
    const auto z = static_cast<float>(place.z - k);
    // At the last voxel nothing of the next one counts.
    const std::size_t right = i + 1 < volume.nx ? 1 : 0;
    const std::size_t back = j + 1 < volume.ny ? std::size_t{volume.nx} : 0;
    const std::size_t up = k + 1 < volume.nz ? std::size_t{volume.nx} * volume.ny : 0;
    const std::size_t first = volume.index(i, j, k);
    const std::array rows{(1.0f - y) * (1.0f - z), y * (1.0f - z), (1.0f - y) * z, y * z};
    const std::array starts{first, first + back, first + up, first + back + up};
    Neighbours near;
    for (std::size_t row = 0; row < 4; ++row) {
        near.voxels[2 * row] = starts[row];
        near.voxels[2 * row + 1] = starts[row] + right;
        near.weights[2 * row] = (1.0f - x) * rows[row];
        near.weights[2 * row + 1] = x * rows[row];
    }
    return near;
}

glm::vec3 mix_colors(const SampledVolume& volume, const Neighbours& near) {
    const std::array<float, 256>& light = srgb_light();
    glm::vec3 sum(0.0f);
    glm::vec3 transparent_sum(0.0f);
    float opaque = 0.0f;
    for (std::size_t i = 0; i < 8; ++i) {
        const Rgba& code = volume.colors[near.voxels[i]];
        const glm::vec3 color(light[code[0]], light[code[1]], light[code[2]]);
        const float counts = near.weights[i] * static_cast<float>(code[3]);
        sum += counts * color;
        transparent_sum += near.weights[i] * color;
        opaque += counts;
    }
    return opaque > 0.0f ? sum / opaque : transparent_sum;
}

}  // namespace

TextureColor::TextureColor(std::shared_ptr<const SampledVolume> volume, const glm::dmat4& placement,
                           std::span<const glm::dvec3> stops)
    : volume_(std::move(volume)), place_(*volume_, placement) {
    if (volume_->kind == VolumeKind::Colors) return;
    ramp_.emplace(stops);
    const auto [least, most] = std::ranges::minmax_element(volume_->values);
    least_ = *least;
    per_span_ = *most > *least ? 1.0 / (double{*most} - double{*least}) : 0.0;
}

void TextureColor::evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> colors) const {
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::dvec3 place = place_.at(points[i]);
        colors[i] = ramp_ ? ramp_->at(static_cast<float>((value_between(*volume_, place) - least_) * per_span_))
                          : mix_colors(*volume_, neighbours(*volume_, place));
    }
}

}  // namespace xorvox::host
