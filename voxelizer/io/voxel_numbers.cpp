#include "voxelizer/io/voxel_numbers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "voxelizer/io/load.h"

namespace xorvox::io {
namespace {

template <class T>
Expected<void> convert(std::string_view bytes, const NumberFormat& format, SampledVolume& volume,
                       std::string_view source) {
    const std::size_t count = volume.voxel_count();
    volume.values.resize(count);
    const bool labels = volume.kind == VolumeKind::Labels;
    for (std::size_t n = 0; n < count; ++n) {
        const auto number = static_cast<double>(load<T>(bytes.data() + n * sizeof(T), format.order));
        const double meant = format.slope * number + format.intercept;
        const bool is_label = !labels || (meant >= 0.0 && meant <= double{kMostLabel} && meant == std::floor(meant));
        if (!(std::abs(meant) <= double{std::numeric_limits<float>::max()}) || !is_label) {
            const std::size_t i = n % volume.nx;
            const std::size_t j = n / volume.nx % volume.ny;
            const std::size_t k = n / volume.nx / volume.ny;
            return fail(fmt::format("{}: voxel ({}, {}, {}) is {}, {}", source, i, j, k, meant,
                                    std::isfinite(meant) && !is_label
                                        ? "which is no label; labels are whole numbers from 0 to 16777216"
                                        : "where a finite number is needed; replace it and write the volume again"));
        }
        volume.values[n] = static_cast<float>(meant);
    }
    return {};
}

}  // namespace

std::size_t bytes_of(NumberType type) {
    constexpr std::array<std::size_t, 10> kBytes{1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
    return kBytes[static_cast<std::size_t>(type)];
}

Expected<void> check_sides(std::uint64_t nx, std::uint64_t ny, std::uint64_t nz, std::string_view source,
                           std::string_view where) {
    const std::uint64_t most = std::max({nx, ny, nz});
    const std::uint64_t least = std::min({nx, ny, nz});
    if (least >= 1 && most <= SampledVolume::kMostSide && nx * ny * nz <= SampledVolume::kMostVoxels) return {};
    return fail(
        fmt::format("{}: {}: a volume of {} × {} × {} voxels cannot be read; sides are 1 to {}, and voxels at "
                    "most {}",
                    source, where, nx, ny, nz, SampledVolume::kMostSide, SampledVolume::kMostVoxels));
}

Expected<void> read_values(std::string_view bytes, const NumberFormat& format, SampledVolume& volume,
                           std::string_view source) {
    switch (format.type) {
        case NumberType::Int8: return convert<std::int8_t>(bytes, format, volume, source);
        case NumberType::UInt8: return convert<std::uint8_t>(bytes, format, volume, source);
        case NumberType::Int16: return convert<std::int16_t>(bytes, format, volume, source);
        case NumberType::UInt16: return convert<std::uint16_t>(bytes, format, volume, source);
        case NumberType::Int32: return convert<std::int32_t>(bytes, format, volume, source);
        case NumberType::UInt32: return convert<std::uint32_t>(bytes, format, volume, source);
        case NumberType::Int64: return convert<std::int64_t>(bytes, format, volume, source);
        case NumberType::UInt64: return convert<std::uint64_t>(bytes, format, volume, source);
        case NumberType::Float32: return convert<float>(bytes, format, volume, source);
        case NumberType::Float64: break;
    }
    return convert<double>(bytes, format, volume, source);
}

void mark_binary(VolumeSequence& sequence) {
    const auto is_bit = [](float value) { return value == 0.0f || value == 1.0f; };
    for (const SampledVolume& volume : sequence.frames) {
        if (volume.kind != VolumeKind::Scalar || !std::ranges::all_of(volume.values, is_bit)) return;
    }
    for (SampledVolume& volume : sequence.frames) volume.kind = VolumeKind::Binary;
}

Expected<void> check_placement(const SampledVolume& volume, std::string_view source, std::string_view where) {
    constexpr double kMost = 1e30;
    constexpr double kLeast = 1e-30;
    const auto& m = volume.to_mm;
    bool sound = true;
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 3; ++row) sound = sound && std::abs(m[column][row]) <= kMost;
    }
    std::array<glm::dvec3, 3> axes{glm::dvec3(m[0]), glm::dvec3(m[1]), glm::dvec3(m[2])};
    for (glm::dvec3& axis : axes) {
        const double length = glm::length(axis);
        sound = sound && length >= kLeast;
        axis /= length;
    }
    // Axes of this volume span less than 1e-9 of what right angles would: one of them says nothing of its own.
    sound = sound && std::abs(glm::dot(axes[0], glm::cross(axes[1], axes[2]))) >= 1e-9;
    if (sound) return {};
    return fail(
        fmt::format("{}: {}: the axes of the volume do not span a space, or its numbers are beyond ±1e30; "
                    "they are ({}, {}, {}), ({}, {}, {}) and ({}, {}, {})",
                    source, where, m[0].x, m[0].y, m[0].z, m[1].x, m[1].y, m[1].z, m[2].x, m[2].y, m[2].z));
}

}  // namespace xorvox::io
