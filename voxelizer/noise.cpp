#include "voxelizer/noise.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "voxelizer/elementary.h"

namespace xorvox {
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

/// Brings the largest value of simplex noise, found by climbing from millions of places, to 0.99.
constexpr float kSimplexScale = 76.0f;

int whole_below(double value) {
    const int truncated = static_cast<int>(value);
    return truncated - (static_cast<double>(truncated) > value ? 1 : 0);
}

std::uint8_t permute(int value) {
    return kPermutation[static_cast<std::size_t>(value & 255)];
}

/// The directions to a cube's 12 edges; four come twice, to make 16.
constexpr float kGradients[16][3] = {{1, 1, 0},  {-1, 1, 0},  {1, -1, 0}, {-1, -1, 0}, {1, 0, 1},  {-1, 0, 1},
                                     {1, 0, -1}, {-1, 0, -1}, {0, 1, 1},  {0, -1, 1},  {0, 1, -1}, {0, -1, -1},
                                     {1, 1, 0},  {0, -1, 1},  {-1, 1, 0}, {0, -1, -1}};

/// The offset's product with one of them.
float along_gradient(std::uint8_t hash, float x, float y, float z) {
    const auto& gradient = kGradients[hash & 15];
    return gradient[0] * x + gradient[1] * y + gradient[2] * z;
}

float fade(float t) {
    return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
}

bool is_in_range(const glm::vec3& point) {
    constexpr float kMost = 0x1p22f;
    return point.x >= -kMost && point.x <= kMost && point.y >= -kMost && point.y <= kMost && point.z >= -kMost &&
           point.z <= kMost;
}

float mix(float a, float b, float t) {
    return a + t * (b - a);
}

}  // namespace

float perlin_noise(const glm::vec3& point) {
    if (!is_in_range(point)) return 0.0f;
    const float floor_x = elementary::floor(point.x);
    const float floor_y = elementary::floor(point.y);
    const float floor_z = elementary::floor(point.z);
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

float simplex_noise(const glm::vec3& point) {
    if (!is_in_range(point)) return 0.0f;
    // Skewed along the main diagonal, six tetrahedra of equal shape make up each cube.
    const glm::dvec3 exact(point);
    const glm::dvec3 skewed = exact + (exact.x + exact.y + exact.z) / 3.0;
    const glm::ivec3 cell(whole_below(skewed.x), whole_below(skewed.y), whole_below(skewed.z));
    const double unskew = static_cast<double>(cell.x + cell.y + cell.z) / 6.0;
    const glm::vec3 offset(exact - (glm::dvec3(cell) - unskew));
    // From the cube's lowest corner to its highest, by the axis of the largest part first.
    const int x_y = offset.x >= offset.y;
    const int y_z = offset.y >= offset.z;
    const int x_z = offset.x >= offset.z;
    const glm::ivec3 first(x_y & x_z, (1 - x_y) & y_z, (1 - x_z) & (1 - y_z));
    const glm::ivec3 second(x_y | x_z, (1 - x_y) | y_z, (1 - x_z) | (1 - y_z));
    const auto corner = [&](const glm::ivec3& step, float back) {
        const float x = offset.x - static_cast<float>(step.x) + back;
        const float y = offset.y - static_cast<float>(step.y) + back;
        const float z = offset.z - static_cast<float>(step.z) + back;
        const float near = 0.5f - x * x - y * y - z * z;
        const float rest = near > 0.0f ? near : 0.0f;
        const glm::ivec3 place = cell + step;
        const float weight = rest * rest * rest * rest;
        return weight * along_gradient(permute(permute(permute(place.x) + place.y) + place.z), x, y, z);
    };
    const float sum =
        corner({0, 0, 0}, 0.0f) + corner(first, 1.0f / 6.0f) + corner(second, 1.0f / 3.0f) + corner({1, 1, 1}, 0.5f);
    return kSimplexScale * sum;
}

void perlin_noise(std::span<const glm::vec3> points, std::span<float> values) {
    for (std::size_t i = 0; i < points.size(); ++i) values[i] = perlin_noise(points[i]);
}

void simplex_noise(std::span<const glm::vec3> points, std::span<float> values) {
    for (std::size_t i = 0; i < points.size(); ++i) values[i] = simplex_noise(points[i]);
}

}  // namespace xorvox
