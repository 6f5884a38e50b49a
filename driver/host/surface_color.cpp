#include "driver/host/surface_color.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "driver/host/image_light.h"

namespace xorvox::host {

SurfaceColor::SurfaceColor(const MeshView& mesh, SurfaceColors colors, const glm::dvec3& lower_mm,
                           const glm::dvec3& upper_mm)
    : surface_(mesh), colors_(std::move(colors)), lower_mm_(lower_mm), size_mm_(upper_mm - lower_mm) {}

glm::vec3 SurfaceColor::color_at(const SurfacePoint& place) const {
    const auto mean = [&](const auto& table) {
        auto sum = static_cast<float>(place.weights[0]) * table[place.corners[0]];
        sum += static_cast<float>(place.weights[1]) * table[place.corners[1]];
        sum += static_cast<float>(place.weights[2]) * table[place.corners[2]];
        return sum;
    };
    const glm::vec3 own = colors_.corner_colors.empty() ? glm::vec3(1.0f) : mean(colors_.corner_colors);
    const std::size_t number = colors_.face_materials.empty() ? 0 : colors_.face_materials[place.face];
    if (number >= colors_.materials.size()) return own;
    const SurfaceMaterial& material = colors_.materials[number];
    if (material.image >= colors_.images.size() || colors_.corner_texcoords.empty()) return own * material.factor;
    const Image& image = colors_.images[material.image];
    if (image.pixels.empty()) return own * material.factor;
    const glm::vec2 at = mean(colors_.corner_texcoords);
    return own * material.factor *
           mix_pixels(image, pixels_at(at.x, image.width, material.wrap_u),
                      pixels_at(at.y, image.height, material.wrap_v));
}

void SurfaceColor::evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> colors) const {
    if (surface_.empty()) {
        std::ranges::fill(colors, glm::vec3(1.0f));
        return;
    }
    std::array<glm::dvec3, 256> places_mm;
    std::array<SurfacePoint, 256> nearest;
    for (std::size_t at = 0; at < points.size(); at += places_mm.size()) {
        const std::size_t count = std::min(places_mm.size(), points.size() - at);
        for (std::size_t i = 0; i < count; ++i) places_mm[i] = lower_mm_ + glm::dvec3(points[at + i]) * size_mm_;
        surface_.nearest(std::span(places_mm).first(count), std::span(nearest).first(count));
        for (std::size_t i = 0; i < count; ++i) colors[at + i] = color_at(nearest[i]);
    }
}

}  // namespace xorvox::host
