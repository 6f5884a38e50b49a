// Exposure statistics: what was lit against what was sent, in numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "sim/exposure.h"

namespace xorvox::sim {

/// Of a shutter that was not open for whole cycles, only voxels of slices count that had at least one turn and of which
/// it cut none, and light is reckoned against the turns that the slice had (Exposure::due()).
struct ExposureStatistics {
    std::string display;        ///< Its name.
    double exposure_ms = 0.0;   ///< For how long the shutter was open.
    double cycles = 0.0;        ///< How many of the display's that is, as it is declared to run.
    std::size_t sent = 0;       ///< Voxels that the frame lights,
    std::size_t lit = 0;        ///< that were lit,
    std::size_t lost = 0;       ///< that the frame lights and that were not lit,
    std::size_t extra = 0;      ///< and that were lit though the frame does not light them.
    double light = 0.0;         ///< All light ÷ the steady light of the frame; 0 where it has none.
    double outside = 0.0;       ///< The part of the light that was further from its sample than it may be
                                ///< (sim/exposed_voxels.h).
    double stray_mm = 0.0;      ///< How far light was from its sample at most,
    double stray_slices = 0.0;  ///< and how many slices early or late.

    /// Light ÷ steady light of the voxels of the frame.
    struct Uniformity {
        double least = 0.0;
        double mean = 0.0;
        double most = 0.0;
        /// Standard deviation ÷ mean of the light of voxels of equal code; the root mean square over all codes. 0 is
        /// even.
        double spread = 0.0;
    };
    Uniformity uniformity;  ///< Of no voxels: zeros.
};

/// Measures what `exposure` saw of `page`, shown at `brightness`: both as for for_each_voxel(). Throws std::bad_alloc.
ExposureStatistics measure(const Exposure& exposure, std::span<const std::byte> page, std::uint8_t brightness);

/// One JSON object on one line, keys always in the same order. `light` and `uniformity` are null where the frame is
/// dark.
std::string to_json(const ExposureStatistics& statistics);

}  // namespace xorvox::sim
