// The colour functions that look into a volume or a picture, against plain arithmetic in doubles.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include <glm/geometric.hpp>

#include "driver/host/color_space.h"
#include "driver/host/label_color.h"
#include "driver/host/spherical_image_color.h"
#include "driver/host/texture_color.h"
#include "tests/catch.h"
#include "tests/unit/host/color_points.h"

using namespace xorvox;
using namespace xorvox::host;

namespace {

const std::vector<glm::dvec3> kRedToBlue{{1, 0, 0}, {0, 0, 1}};

SampledVolume volume_of(VolumeKind kind, std::uint32_t nx, std::uint32_t ny, std::uint32_t nz) {
    SampledVolume volume;
    volume.kind = kind;
    volume.nx = nx;
    volume.ny = ny;
    volume.nz = nz;
    std::mt19937 random(nx);
    for (std::size_t i = 0; i < volume.voxel_count(); ++i) {
        if (kind == VolumeKind::Colors) {
            const auto code = [&] { return static_cast<std::uint8_t>(random()); };
            volume.colors.push_back({code(), code(), code(), 255});
        } else {
            volume.values.push_back(static_cast<float>(random() % 300));
        }
    }
    return volume;
}

std::shared_ptr<const SampledVolume> shared(SampledVolume volume) {
    return std::make_shared<const SampledVolume>(std::move(volume));
}

double light(std::uint8_t code) {
    const double c = code / 255.0;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

glm::dvec3 light(const Rgba& code) {
    return {light(code[0]), light(code[1]), light(code[2])};
}

/// The weight of voxel i of n at the place 0 … 1 along an axis.
double weight(std::uint32_t i, std::uint32_t n, double p) {
    const double place = std::clamp(p * n - 0.5, 0.0, n - 1.0);
    return std::max(0.0, 1.0 - std::abs(place - i));
}

/// Calls visit(weight, index) for every voxel.
template <class Visit>
void for_each_voxel(const SampledVolume& v, const glm::vec3& point, Visit visit) {
    for (std::uint32_t k = 0; k < v.nz; ++k) {
        for (std::uint32_t j = 0; j < v.ny; ++j) {
            for (std::uint32_t i = 0; i < v.nx; ++i) {
                visit(weight(i, v.nx, point.x) * weight(j, v.ny, point.y) * weight(k, v.nz, point.z), v.index(i, j, k));
            }
        }
    }
}

}  // namespace

TEST_CASE("a texture of colours is trilinear in linear light") {
    for (const auto& [nx, ny, nz] : {std::array{5u, 4u, 3u}, {1u, 1u, 1u}, {1u, 7u, 2u}}) {
        const auto volume = shared(volume_of(VolumeKind::Colors, nx, ny, nz));
        const TextureColor field(volume, stretched(*volume), {});
        for (const glm::vec3& point : color_points()) {
            glm::dvec3 expected(0.0);
            for_each_voxel(*volume, point,
                           [&](double w, std::size_t at) { expected += w * light(volume->colors[at]); });
            REQUIRE(glm::distance(glm::dvec3(color_of(field, point)), expected) < 1e-5);
        }
        check_batches(field);
    }
}

TEST_CASE("transparent voxels of a texture do not darken the others") {
    SampledVolume volume = volume_of(VolumeKind::Colors, 4, 1, 1);
    volume.colors = {{0, 0, 0, 0}, {255, 0, 0, 255}, {0, 0, 255, 51}, {9, 9, 9, 0}};
    const TextureColor field(shared(volume), stretched(volume), {});
    CHECK(color_of(field, {0.3f, 0, 0}) == glm::vec3(1, 0, 0));
    const glm::vec3 between = color_of(field, {0.5f, 0.5f, 0.5f});
    CHECK(between.r == Approx(5.0 / 6.0));
    CHECK(between.b == Approx(1.0 / 6.0));
    CHECK(color_of(field, {1, 0, 0}).g == Approx(light(9)));
}

TEST_CASE("a texture of numbers goes through a ramp from the least to the most") {
    const auto volume = shared(volume_of(VolumeKind::Scalar, 5, 4, 3));
    const TextureColor field(volume, stretched(*volume), kRedToBlue);
    const Ramp ramp(kRedToBlue);
    const auto [least, most] = std::ranges::minmax(volume->values);
    for (const glm::vec3& point : color_points()) {
        double mean = 0.0;
        for_each_voxel(*volume, point, [&](double w, std::size_t at) { mean += w * volume->values[at]; });
        const glm::vec3 expected = ramp.at(static_cast<float>((mean - least) / (most - least)));
        REQUIRE(glm::distance(color_of(field, point), expected) < 1e-4f);
    }
    check_batches(field);

    SampledVolume wide = volume_of(VolumeKind::Scalar, 2, 1, 1);
    wide.values = {-3e38f, 3e38f};
    const TextureColor far(shared(wide), stretched(wide), kRedToBlue);
    CHECK(color_of(far, {0.5f, 0, 0}) == ramp.at(0.5f));
    SampledVolume even = volume_of(VolumeKind::Binary, 2, 2, 2);
    std::ranges::fill(even.values, 1.0f);
    CHECK(color_of(TextureColor(shared(even), stretched(even), kRedToBlue), {0.3f, 0.3f, 0.3f}) == ramp.at(0.0f));
}

TEST_CASE("a volume that is turned in its own millimetres is stretched the right way round") {
    SampledVolume volume = volume_of(VolumeKind::Scalar, 2, 3, 4);
    std::ranges::fill(volume.values, 0.0f);
    volume.values[volume.index(1, 0, 0)] = 1.0f;
    // i runs up, j to the left, k to the back; scaled and moved.
    volume.to_mm = glm::dmat4(0, 0, 2, 0, -3, 0, 0, 0, 0, 5, 0, 0, 7, -8, 9, 1);
    const TextureColor field(shared(volume), stretched(volume), kRedToBlue);
    CHECK(color_of(field, {1, 0, 1}).b == Approx(1.0f));
    CHECK(color_of(field, {0, 0, 1}).b == Approx(0.0f).margin(1e-6));
    CHECK(color_of(field, {1, 1, 1}).b == Approx(0.0f).margin(1e-6));
    CHECK(color_of(field, {1, 0, 0}).b == Approx(0.0f).margin(1e-6));
}

TEST_CASE("labels have the colour of the nearest voxel's label") {
    SampledVolume volume = volume_of(VolumeKind::Labels, 5, 4, 3);
    volume.palette = {{255, 255, 255, 255}, {255, 0, 0, 0}, {0, 255, 0, 255}};
    for (std::size_t i = 0; i < 30; ++i) volume.values[i] = static_cast<float>(i % 4);
    const auto nearest = [&](const glm::vec3& point) {
        const auto along = [](float p, std::uint32_t n) {
            return static_cast<std::uint32_t>(std::clamp(std::floor(double{p} * n), 0.0, n - 1.0));
        };
        return volume.values[volume.index(along(point.x, 5), along(point.y, 4), along(point.z, 3))];
    };
    const LabelColor own(shared(volume), stretched(volume), {});
    const std::vector<glm::dvec3> two{{0.5, 0, 0}, {0, 0.5, 0}};
    const LabelColor given(shared(volume), stretched(volume), two);
    for (const glm::vec3& point : color_points()) {
        if (std::abs(std::remainder(double{point.x} * 5, 1.0)) < 1e-6) continue;  // either side is right
        const auto label = static_cast<std::uint32_t>(nearest(point));
        const glm::vec3 in_palette[] = {distinct_color(0), {1, 0, 0}, {0, 1, 0}};
        REQUIRE(color_of(own, point) == (label < 3 ? in_palette[label] : glm::vec3(distinct_color(label))));
        REQUIRE(color_of(given, point) == glm::vec3(label == 0 ? distinct_color(0) : two[(label - 1) % 2]));
    }
    check_batches(own);
    check_batches(given);
}

TEST_CASE("labels without a palette differ, and are bright") {
    CHECK(distinct_color(0) == linear_from_hex(0x808080));
    CHECK(distinct_color(256) == distinct_color(1));
    CHECK(distinct_color(0xffff'ffff) == distinct_color((0xffff'ffffu - 1) % 255 + 1));
    for (std::uint32_t label = 1; label < 256; ++label) {
        const glm::dvec3 color = distinct_color(label);
        REQUIRE(std::max({color.r, color.g, color.b}) > 0.2);
        REQUIRE(std::min({color.r, color.g, color.b}) >= 0.0);
        for (std::uint32_t next = label + 1; next < label + 8; ++next) {
            REQUIRE(glm::distance(color, distinct_color(next)) > 0.1);
        }
    }
}

TEST_CASE("what can be labels is whole and not negative") {
    SampledVolume volume = volume_of(VolumeKind::Scalar, 2, 1, 1);
    volume.values = {0.0f, 16777216.0f};
    CHECK(has_labels(volume));
    for (const float wrong : {0.5f, -1.0f, 16777218.0f, std::numeric_limits<float>::infinity()}) {
        volume.values[1] = wrong;
        CHECK_FALSE(has_labels(volume));
    }
    CHECK_FALSE(has_labels(volume_of(VolumeKind::Colors, 2, 1, 1)));
}

TEST_CASE("a spherical picture is seen by direction from the middle") {
    Image image{8, 5, {}};
    std::mt19937 random(3);
    for (int i = 0; i < 40; ++i) {
        const auto code = [&] { return static_cast<std::uint8_t>(random()); };
        image.pixels.push_back({code(), code(), code(), code()});
    }
    const SphericalImageColor field(std::make_shared<const Image>(image));
    const auto pixel = [&](int x, int y) {
        // Beyond a pole, half way round.
        if (y < 0) y = 0, x += 4;
        if (y > 4) y = 4, x += 4;
        return light(image.pixels[static_cast<std::size_t>((x % 8 + 8) % 8 + 8 * y)]);
    };
    for (const glm::vec3& point : color_points()) {
        const glm::dvec3 d = glm::dvec3(point) - 0.5;
        const double u = 8.0 * (0.5 + std::atan2(d.y, d.x) / (2 * std::numbers::pi)) - 0.5;
        const double v = 5.0 * (0.5 - std::atan2(d.z, std::hypot(d.x, d.y)) / std::numbers::pi) - 0.5;
        const int x = static_cast<int>(std::floor(u));
        const int y = static_cast<int>(std::floor(v));
        const double right = u - x;
        const double low = v - y;
        const glm::dvec3 expected = (1 - low) * ((1 - right) * pixel(x, y) + right * pixel(x + 1, y)) +
                                    low * ((1 - right) * pixel(x, y + 1) + right * pixel(x + 1, y + 1));
        INFO(point.x << " " << point.y << " " << point.z);
        REQUIRE(glm::distance(glm::dvec3(color_of(field, point)), expected) < 1e-5);
    }
    check_batches(field);
    // The middle of the picture is towards +x, its right half towards +y, its upper border up.
    Image sides{4, 2, std::vector(8, std::array<std::uint8_t, 4>{0, 0, 0, 255})};
    sides.pixels[2] = sides.pixels[6] = {255, 0, 0, 255};
    const SphericalImageColor halves(std::make_shared<const Image>(sides));
    CHECK(color_of(halves, {0.9f, 0.9f, 0.5f}) == glm::vec3(1, 0, 0));
    CHECK(color_of(halves, {0.9f, 0.1f, 0.5f}) == glm::vec3(0));
}

TEST_CASE("colours of volumes and pictures have the same bits on every machine") {
    const auto colors = shared(volume_of(VolumeKind::Colors, 7, 6, 5));
    const auto numbers = shared(volume_of(VolumeKind::Scalar, 7, 6, 5));
    Image image{9, 6, {}};
    for (std::uint8_t i = 0; i < 54; ++i) {
        image.pixels.push_back({static_cast<std::uint8_t>(37 * i), static_cast<std::uint8_t>(91 * i), i, 255});
    }
    CHECK(hash_of(TextureColor(colors, stretched(*colors), {})) == 0x4321422fe1e55c06);
    CHECK(hash_of(TextureColor(numbers, stretched(*numbers), kRedToBlue)) == 0x41a6f507de22c673);
    CHECK(hash_of(LabelColor(numbers, stretched(*numbers), {})) == 0x1a22f15ba5bbe44e);
    CHECK(hash_of(SphericalImageColor(std::make_shared<const Image>(image))) == 0x149d625eb48e116f);
}
