#include "sim/exposure_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "sim/exposed_voxels.h"
#include "sim/json.h"

namespace xorvox::sim {
namespace {

double sum_of(const glm::vec3& light) {
    return double{light.x} + double{light.y} + double{light.z};
}

/// The light of the voxels of one code.
struct OfCode {
    double voxels = 0.0;
    double mean = 0.0;
    double squares = 0.0;  ///< Sum of the squared distances from the mean.

    /// Welford's way, which does not lose what is small beside the mean.
    void add(double light) {
        voxels += 1.0;
        const double away = light - mean;
        mean += away / voxels;
        squares += away * (light - mean);
    }
};

}  // namespace

ExposureStatistics measure(const Exposure& exposure, std::span<const std::byte> page, std::uint8_t brightness) {
    ExposureStatistics statistics;
    statistics.display = exposure.display().name.view();
    statistics.exposure_ms = static_cast<double>(exposure.to_ns() - exposure.from_ns()) * 1e-6;
    statistics.cycles = exposure.cycles();
    double sent = 0.0;
    double light = 0.0;
    double outside = 0.0;
    double ratios = 0.0;
    double least = std::numeric_limits<double>::infinity();
    std::unordered_map<std::uint32_t, OfCode> codes;
    for_each_voxel(exposure, page, brightness, [&](const ExposedVoxel& voxel) {
        if (voxel.due <= 0.0) return;
        light += sum_of(voxel.light);
        outside += sum_of(voxel.outside);
        const double is = sum_of(voxel.light) / voxel.due;
        statistics.lit += is > 0.0;
        statistics.lost += voxel.is_lost();
        statistics.extra += voxel.is_extra();
        statistics.stray_mm = std::max(statistics.stray_mm, voxel.stray_mm);
        statistics.stray_slices = std::max(statistics.stray_slices, voxel.stray_slices);
        const double should = sum_of(voxel.sent);
        if (should <= 0.0) return;
        ++statistics.sent;
        sent += should * voxel.due;
        ratios += is / should;
        least = std::min(least, is / should);
        statistics.uniformity.most = std::max(statistics.uniformity.most, is / should);
        codes[voxel.code].add(is);
    });
    if (light > 0.0) statistics.outside = outside / light;
    if (statistics.sent == 0) return statistics;

    const auto voxels = static_cast<double>(statistics.sent);
    statistics.light = light / sent;
    statistics.uniformity.least = least;
    statistics.uniformity.mean = ratios / voxels;
    double spread = 0.0;
    for (const auto& [code, of] : codes) {
        if (of.mean > 0.0) spread += of.squares / (of.mean * of.mean);
    }
    statistics.uniformity.spread = std::sqrt(spread / voxels);
    return statistics;
}

std::string to_json(const ExposureStatistics& statistics) {
    const ExposureStatistics::Uniformity& uniformity = statistics.uniformity;
    const std::string of_sent =
        statistics.sent == 0 ? std::string("null")
                             : fmt::format(R"({{"least": {:.6g}, "mean": {:.6g}, "most": {:.6g}, "spread": {:.6g}}})",
                                           uniformity.least, uniformity.mean, uniformity.most, uniformity.spread);
    const std::string light = statistics.sent == 0 ? std::string("null") : fmt::format("{:.6g}", statistics.light);
    return fmt::format(
        R"({{"display": {}, "exposure_ms": {:.6g}, "cycles": {:.6g}, "sent": {}, "lit": {}, "lost": {}, "extra": {}, "light": {}, )"
        R"("outside": {:.6g}, "stray_mm": {:.6g}, "stray_slices": {:.6g}, "uniformity": {}}})",
        json_quoted(statistics.display), statistics.exposure_ms, statistics.cycles, statistics.sent, statistics.lit,
        statistics.lost, statistics.extra, light, statistics.outside, statistics.stray_mm, statistics.stray_slices,
        of_sent);
}

}  // namespace xorvox::sim
