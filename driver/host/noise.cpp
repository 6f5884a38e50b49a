#include "driver/host/noise.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace xorvox::host {
namespace {

/// 0 … 255 shuffled (Fisher and Yates) by a fixed linear congruential generator.
constexpr std::array<std::uint8_t, 256> kPermutation = [] {
    std::array<std::uint8_t, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i) table[i] = static_cast<std::uint8_t>(i);
    std::uint64_t state = 2002;
    for (std::size_t i = table.size() - 1; i > 0; --i) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        std::swap(table[i], table[(state >> 33) % (i + 1)]);
    }
    return table;
}();

std::uint8_t permute(int value) {
    return kPermutation[static_cast<std::size_t>(value & 255)];
}

/// The offset's product with one of the directions to a cube's 12 edges; four come twice, to make 16.
float along_gradient(std::uint8_t hash, float x, float y, float z) {
    const int edge = hash & 15;
    const float u = edge < 8 ? x : y;
    const float v = edge < 4 ? y : (edge == 12 || edge == 14 ? x : z);
    return ((edge & 1) != 0 ? -u : u) + ((edge & 2) != 0 ? -v : v);
}

float fade(float t) {
    return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
}

float mix(float a, float b, float t) {
    return a + t * (b - a);
}

}  // namespace

float perlin_noise(const glm::vec3& point) {
    const float floor_x = std::floor(point.x);
    const float floor_y = std::floor(point.y);
    const float floor_z = std::floor(point.z);
    const float x = point.x - floor_x;
    const float y = point.y - floor_y;
    const float z = point.z - floor_z;
    const int cell_x = static_cast<int>(floor_x);
    const int cell_y = static_cast<int>(floor_y);
    const int cell_z = static_cast<int>(floor_z);

    const auto corner = [&](int i, int j, int k) {
        const std::uint8_t hash = permute(permute(permute(cell_x + i) + cell_y + j) + cell_z + k);
        return along_gradient(hash, x - static_cast<float>(i), y - static_cast<float>(j), z - static_cast<float>(k));
    };
    const float u = fade(x);
    const float v = fade(y);
    const auto layer = [&](int k) {
        return mix(mix(corner(0, 0, k), corner(1, 0, k), u), mix(corner(0, 1, k), corner(1, 1, k), u), v);
    };
    return mix(layer(0), layer(1), fade(z));
}

}  // namespace xorvox::host
