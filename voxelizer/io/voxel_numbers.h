// The numbers of volume files: their types, and what every reader checks of them. Private to voxelizer/io.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "voxelizer/error.h"
#include "voxelizer/sampled_volume.h"

namespace xorvox::io {

enum class NumberType : std::uint8_t { Int8, UInt8, Int16, UInt16, Int32, UInt32, Int64, UInt64, Float32, Float64 };

std::size_t bytes_of(NumberType type);

/// How a file has its numbers; what they mean is slope · number + intercept.
struct NumberFormat {
    NumberType type = NumberType::UInt8;
    std::endian order = std::endian::little;
    double slope = 1.0;
    double intercept = 0.0;
};

/// An error when a side is none or beyond the limits of SampledVolume. `where`, as in "byte 42", begins the message
/// after `source`.
Expected<void> check_sides(std::uint64_t nx, std::uint64_t ny, std::uint64_t nz, std::string_view source,
                           std::string_view where);

/// Fills values of `volume`, whose sides and kind are set, from `bytes`, which has exactly as many numbers as it has
/// voxels. Errors: a number that is not finite, or no float can hold; of Labels also one that is not whole, below 0 or
/// above kMostLabel; each with its voxel.
Expected<void> read_values(std::string_view bytes, const NumberFormat& format, SampledVolume& volume,
                           std::string_view source);

/// Makes Scalar volumes Binary when all of them have no other values than 0 and 1.
void mark_binary(VolumeSequence& sequence);

/// The greatest label: floats tell whole numbers apart up to here.
inline constexpr float kMostLabel = 16777216.0f;

/// An error when `volume.to_mm` is not what SampledVolume promises: finite and invertible.
Expected<void> check_placement(const SampledVolume& volume, std::string_view source, std::string_view where);

}  // namespace xorvox::io
