// Histogram: how many voxels had how much light.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "sim/exposure.h"
#include "sim/image.h"

namespace xorvox::sim {

/// Voxels by light: the mean of the channels, steady full light is 1. Bin i holds those from i to i + 1 bin widths; the
/// last one all that had more.
struct LightHistogram {
    static constexpr std::size_t kBins = 60;
    static constexpr double kBinWidth = 0.02;

    std::string display;       ///< Its name.
    double exposure_ms = 0.0;  ///< For how long the shutter was open.
    std::array<std::uint64_t, kBins>
        sent{};  ///< Of the voxels that the frame lights, by the steady light of their codes.
    std::array<std::uint64_t, kBins> lit{};  ///< Of those that were lit, by their light.
    std::uint64_t lost = 0;                  ///< That the frame lights and that were not lit.
};

/// Of a shutter that was not open for whole cycles, voxels and their light count as in ExposureStatistics. A few
/// nanoseconds a voxel. `page` and `brightness` as for for_each_voxel() (sim/exposed_voxels.h). Throws
/// std::bad_alloc.
LightHistogram make_histogram(const Exposure& exposure, std::span<const std::byte> page, std::uint8_t brightness);

/// Lines of text: a header, then `from,to,sent,lit` for each bin; `to` of the last one is "inf".
std::string to_csv(const LightHistogram& histogram);

/// A chart of 960 × 540 pixels: what was lit as bars, what was sent as an outline; voxels on a logarithmic axis.
Image draw_chart(const LightHistogram& histogram);

}  // namespace xorvox::sim
