#include "sim/develop.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/vec3.hpp>

namespace xorvox::sim {
namespace {

constexpr glm::vec3 kGroundTop(0.0055f, 0.0065f, 0.0095f);
constexpr glm::vec3 kGroundBottom(0.0125f, 0.0145f, 0.0200f);
constexpr float kWhite = 250.0f;       ///< What endless light becomes, of 255.
constexpr float kExposure = 1.2f;      ///< White in full light is shown near kWhite.
constexpr float kGlowOnObject = 0.2f;  ///< More would take the contrast from the object's shading.

/// The running sums of a blur would carry what is no number over all the rest of the picture.
std::vector<glm::vec4> finite(std::vector<glm::vec4> pixels) {
    for (glm::vec4& pixel : pixels) {
        for (int channel = 0; channel < 4; ++channel) {
            if (!std::isfinite(pixel[channel])) pixel[channel] = 0.0f;
        }
    }
    return pixels;
}

/// The mean over 2·radius + 1 pixels along every row of `lines`, and rows become columns.
std::vector<glm::vec3> box_blur_turned(const std::vector<glm::vec3>& lines, std::uint32_t width, std::uint32_t height,
                                       std::uint32_t radius) {
    std::vector<glm::vec3> turned(lines.size());
    const auto reach = static_cast<std::ptrdiff_t>(radius);
    const auto last = static_cast<std::ptrdiff_t>(width) - 1;
    for (std::uint32_t row = 0; row < height; ++row) {
        const glm::vec3* line = lines.data() + std::size_t{row} * width;
        const auto at = [&](std::ptrdiff_t x) { return line[std::clamp<std::ptrdiff_t>(x, 0, last)]; };
        glm::vec3 sum(0.0f);
        for (std::ptrdiff_t x = -reach; x <= reach; ++x) sum += at(x);
        for (std::uint32_t x = 0; x < width; ++x) {
            turned[std::size_t{x} * height + row] = sum / static_cast<float>(2 * radius + 1);
            const auto here = static_cast<std::ptrdiff_t>(x);
            sum += at(here + reach + 1) - at(here - reach);
        }
    }
    return turned;
}

/// Three boxes in a row are nearly a bell.
std::vector<glm::vec3> blur(std::vector<glm::vec3> pixels, std::uint32_t width, std::uint32_t height,
                            std::uint32_t radius) {
    for (int pass = 0; pass < 3; ++pass) {
        pixels = box_blur_turned(pixels, width, height, radius);
        pixels = box_blur_turned(pixels, height, width, radius);
    }
    return pixels;
}

float srgb(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

/// 0 … 1, evenly spread over neighbouring pixels (interleaved gradient noise, Jimenez 2014): rounding by it instead of
/// by a half keeps the dark ground from falling into bands.
float dither(std::uint32_t column, std::uint32_t row) {
    const double inner = 0.06711056 * column + 0.00583715 * row;
    const double outer = 52.9829189 * (inner - std::floor(inner));
    return static_cast<float>(outer - std::floor(outer));
}

/// The strongest channel is held below 1 and the others keep their share of it, so that strong light keeps its colour.
glm::vec3 tone(const glm::vec3& light) {
    const float strongest = std::max({light.r, light.g, light.b});
    if (!(strongest > 0.0f)) return glm::vec3(0.0f);
    return glm::max(light, 0.0f) * ((1.0f - std::exp(-kExposure * strongest)) / strongest);
}

}  // namespace

Image develop(const Film& film, float glow) {
    const std::vector<glm::vec4> pixels = finite(film.pixels);
    std::vector<glm::vec3> bright(pixels.size());
    for (std::size_t i = 0; i < bright.size(); ++i) bright[i] = glm::vec3(pixels[i]) * pixels[i].w;
    const std::uint32_t narrow = std::max(1u, film.height / 120);
    const std::vector<glm::vec3> near_glow = blur(bright, film.width, film.height, narrow);
    const std::vector<glm::vec3> far_glow = blur(near_glow, film.width, film.height, 4 * narrow);

    Image image{film.width, film.height, {}};
    image.rgb.reserve(3 * pixels.size());
    for (std::uint32_t row = 0; row < film.height; ++row) {
        const float down = (static_cast<float>(row) + 0.5f) / static_cast<float>(film.height);
        const glm::vec3 ground = glm::mix(kGroundTop, kGroundBottom, down);
        for (std::uint32_t column = 0; column < film.width; ++column) {
            const std::size_t i = std::size_t{row} * film.width + column;
            const float bare = 1.0f - pixels[i].w;
            const glm::vec3 halo = glow * (0.5f * near_glow[i] + 0.5f * far_glow[i]);
            const glm::vec3 light = glm::vec3(pixels[i]) + bare * ground + glm::mix(kGlowOnObject, 1.0f, bare) * halo;
            const float rounding = dither(column, row);
            const glm::vec3 shown = tone(light);
            for (int channel = 0; channel < 3; ++channel) {
                image.rgb.push_back(static_cast<std::uint8_t>(kWhite * srgb(shown[channel]) + rounding));
            }
        }
    }
    return image;
}

std::vector<float> cover_of(const Film& film) {
    std::vector<float> cover;
    cover.reserve(film.pixels.size());
    for (const glm::vec4& pixel : film.pixels) cover.push_back(pixel.w);
    return cover;
}

double covered_share(const Film& film) {
    const auto covered =
        std::count_if(film.pixels.begin(), film.pixels.end(), [](const glm::vec4& pixel) { return pixel.w >= 0.5f; });
    return static_cast<double>(covered) / static_cast<double>(film.pixels.size());
}

double clipped_share(const Image& image) {
    std::size_t clipped = 0;
    for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3) {
        clipped += image.rgb[i] == 255 || image.rgb[i + 1] == 255 || image.rgb[i + 2] == 255;
    }
    return static_cast<double>(clipped) / (static_cast<double>(image.width) * image.height);
}

}  // namespace xorvox::sim
