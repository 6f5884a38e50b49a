#include "voxelizer/noise.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
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

glm::vec3 gradient(std::uint8_t hash) {
    const auto& parts = kGradients[hash & 15];
    return {parts[0], parts[1], parts[2]};
}

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

/// The lowest corner of the cell of whole numbers that a place is in.
glm::vec3 cell_of(const glm::vec3& point) {
    return {elementary::floor(point.x), elementary::floor(point.y), elementary::floor(point.z)};
}

/// Whether a place is in a cell whose numbers are below 2^23.
bool is_in(const glm::vec3& point, const glm::vec3& cell) {
    const glm::vec3 end = cell + 1.0f;
    return (point.x >= cell.x) & (point.x < end.x) & (point.y >= cell.y) & (point.y < end.y) & (point.z >= cell.z) &
           (point.z < end.z);
}

/// The gradients at the corners of a cell: of corner (i, j, k) entry i + 2·j + 4·k.
using CellGradients = std::array<glm::vec3, 8>;

CellGradients gradients_of(const glm::vec3& cell) {
    const int x = static_cast<int>(cell.x);
    const int y = static_cast<int>(cell.y);
    const int z = static_cast<int>(cell.z);
    CellGradients gradients;
    for (int i = 0; i < 2; ++i) {
        const int along_x = permute(x + i) + y;
        for (int j = 0; j < 2; ++j) {
            const int along_y = permute(along_x + j) + z;
            for (int k = 0; k < 2; ++k) {
                gradients[static_cast<std::size_t>(i + 2 * j + 4 * k)] = gradient(permute(along_y + k));
            }
        }
    }
    return gradients;
}

/// Noise at an offset of 0 … 1 from the lowest corner of a cell.
inline float in_cell(const CellGradients& gradients, const glm::vec3& offset) {
    const auto corner = [&](int i, int j, int k) {
        const glm::vec3& gradient = gradients[static_cast<std::size_t>(i + 2 * j + 4 * k)];
        return gradient.x * (offset.x - static_cast<float>(i)) + gradient.y * (offset.y - static_cast<float>(j)) +
               gradient.z * (offset.z - static_cast<float>(k));
    };
    const float u = fade(offset.x);
    const float v = fade(offset.y);
    const auto layer = [&](int k) {
        return mix(mix(corner(0, 0, k), corner(1, 0, k), u), mix(corner(0, 1, k), corner(1, 1, k), u), v);
    };
    return mix(layer(0), layer(1), fade(offset.z));
}

/// Places that are looked at together, if they are in one cell.
constexpr std::size_t kBlock = 8;

}  // namespace

float perlin_noise(const glm::vec3& point) {
    if (!is_in_range(point)) return 0.0f;
    const glm::vec3 cell = cell_of(point);
    return in_cell(gradients_of(cell), point - cell);
}

void perlin_noise(std::span<const glm::vec3> points, std::span<float> values) {
    // Neighbours are mostly in the cell of those before them.
    glm::vec3 cell(std::numeric_limits<float>::quiet_NaN());
    CellGradients gradients{};
    while (!points.empty()) {
        if (!is_in(points.front(), cell)) {
            cell = cell_of(points.front());
            if (!is_in_range(cell) || !is_in_range(cell + 1.0f)) {
                cell.x = std::numeric_limits<float>::quiet_NaN();
                values.front() = perlin_noise(points.front());
                points = points.subspan(1);
                values = values.subspan(1);
                continue;
            }
            gradients = gradients_of(cell);
        }
        std::size_t count = 1;
        while (count < std::min(kBlock, points.size()) && is_in(points[count], cell)) ++count;
        // The rest of the block is computed, too, and left.
        std::array<float, kBlock> x{}, y{}, z{}, found;
        for (std::size_t i = 0; i < count; ++i) {
            x[i] = points[i].x - cell.x;
            y[i] = points[i].y - cell.y;
            z[i] = points[i].z - cell.z;
        }
        // Nothing depends on tables here, so that compilers take several places at once.
        for (std::size_t i = 0; i < kBlock; ++i) found[i] = in_cell(gradients, {x[i], y[i], z[i]});
        std::copy_n(found.begin(), count, values.begin());
        points = points.subspan(count);
        values = values.subspan(count);
    }
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

void simplex_noise(std::span<const glm::vec3> points, std::span<float> values) {
    for (std::size_t i = 0; i < points.size(); ++i) values[i] = simplex_noise(points[i]);
}

}  // namespace xorvox
