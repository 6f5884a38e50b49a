// What holds for every volume that a parser lets through, and for every message when it does not.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include <glm/matrix.hpp>

#include "voxelizer/error.h"
#include "voxelizer/sampled_volume.h"

inline void require(bool holds) {
    if (!holds) std::abort();
}

inline int check_volumes(const xorvox::Expected<xorvox::VolumeSequence>& sequence) {
    using xorvox::VolumeKind;
    if (!sequence) {
        require(sequence.error().message.starts_with("file: "));
        require(sequence.error().message.find('\n') == std::string::npos);
        return 0;
    }
    require(!sequence->frames.empty());
    for (const xorvox::SampledVolume& volume : sequence->frames) {
        constexpr std::uint32_t kMost = xorvox::SampledVolume::kMostSide;
        require(volume.nx >= 1 && volume.ny >= 1 && volume.nz >= 1);
        require(volume.nx <= kMost && volume.ny <= kMost && volume.nz <= kMost);
        const bool colors = volume.kind == VolumeKind::Colors;
        require(volume.values.size() == (colors ? 0 : volume.voxel_count()));
        require(volume.colors.size() == (colors ? volume.voxel_count() : 0));
        for (const float value : volume.values) {
            require(std::isfinite(value));
            if (volume.kind == VolumeKind::Binary) require(value == 0.0f || value == 1.0f);
            if (volume.kind == VolumeKind::Labels) require(value >= 0.0f && value == std::floor(value));
        }
        const glm::dmat4 inverse = glm::inverse(volume.to_mm);
        for (int column = 0; column < 4; ++column) {
            require(volume.to_mm[column][3] == (column == 3 ? 1.0 : 0.0));
            for (int row = 0; row < 4; ++row) require(std::isfinite(inverse[column][row]));
        }
    }
    return 0;
}
