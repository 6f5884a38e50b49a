// SampledVolume: numbers or colours on a grid of voxels, as files of other programs bring them.
//
// Voxel (i, j, k) is entry i + nx·(j + ny·k). Its centre stands at to_mm · (i, j, k, 1), so that grids may be turned,
// mirrored or sheared, as those of medical scanners are.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/mat4x4.hpp>

namespace xorvox {

/// What the voxels of a volume are.
enum class VolumeKind : std::uint8_t {
    Binary,  ///< values: 0 outside, 1 inside.
    Scalar,  ///< values: a density, a temperature …; what is inside follows from a threshold.
    Labels,  ///< values: whole numbers from 0 on, 0 outside; palette: their colours, where the file has any.
    Colors   ///< colors: inside where they are not wholly transparent.
};

/// R, G, B as codes of sRGB, and opacity.
using Rgba = std::array<std::uint8_t, 4>;

struct SampledVolume {
    static constexpr std::uint32_t kMostSide = 16384;
    static constexpr std::size_t kMostVoxels = std::size_t{1} << 31;

    VolumeKind kind = VolumeKind::Binary;
    std::uint32_t nx = 0;  ///< 1 … kMostSide each; at most kMostVoxels in all.
    std::uint32_t ny = 0;
    std::uint32_t nz = 0;
    glm::dmat4 to_mm{1.0};      ///< Invertible; the last row is 0 0 0 1.
    std::vector<float> values;  ///< nx·ny·nz finite numbers; empty of Colors.
    std::vector<Rgba> colors;   ///< nx·ny·nz of Colors; else empty.
    std::vector<Rgba> palette;  ///< Of Labels: entry L is the colour of label L; may be shorter, or empty.

    std::size_t voxel_count() const { return std::size_t{nx} * ny * nz; }
    std::size_t index(std::uint32_t i, std::uint32_t j, std::uint32_t k) const {
        return i + std::size_t{nx} * (j + std::size_t{ny} * k);
    }
};

/// Volumes that follow each other in time; at least one.
struct VolumeSequence {
    std::vector<SampledVolume> frames;
};

}  // namespace xorvox
