#include "driver/host/spherical_image_color.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "driver/host/image_light.h"
#include "voxelizer/elementary.h"

namespace xorvox::host {
namespace {

glm::vec3 light_at(const Image& image, double u, double v) {
    const PixelPair columns = pixels_at(u, image.width, TextureWrap::Repeat);
    const double row = v * image.height - 0.5;
    if (row >= 0.0 && row <= image.height - 1.0) {
        return mix_pixels(image, columns, pixels_at(v, image.height, TextureWrap::Clamp));
    }
    // Beyond the pole the same row goes on, half way round.
    const std::uint32_t last = row < 0.0 ? 0 : image.height - 1;
    const PixelPair same{last, last, 0.0f};
    const glm::vec3 here = mix_pixels(image, columns, same);
    const glm::vec3 there = mix_pixels(image, pixels_at(u + 0.5, image.width, TextureWrap::Repeat), same);
    const auto share = static_cast<float>(row < 0.0 ? -row : row - last);
    return (1.0f - share) * here + share * there;
}

}  // namespace

void SphericalImageColor::evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> colors) const {
    constexpr double kPerTurn = 0.5 / std::numbers::pi;
    constexpr float kFar = 1e18f;  // squares of what is farther are too large
    const auto from_middle = [](float x) { return x > -kFar && x < kFar ? double{x} - 0.5 : 0.0; };
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double x = from_middle(points[i].x);
        const double y = from_middle(points[i].y);
        const double z = from_middle(points[i].z);
        const double east = elementary::atan2(y, x);
        const double north = elementary::atan2(z, std::sqrt(x * x + y * y));
        colors[i] = light_at(*image_, 0.5 + kPerTurn * east, 0.5 - 2.0 * kPerTurn * north);
    }
}

}  // namespace xorvox::host
