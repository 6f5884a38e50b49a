#include "sim/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "sim/json.h"
#include "sim/rebuild.h"
#include "sim/space.h"

namespace xorvox::sim {
Statistics measure(const DisplayDescription& display, const LightField& field, const wire::DeviceStatus& device) {
    const DisplaySamples samples(display);
    const Rebuilt seen = samples.rebuild(field);

    Statistics statistics;
    statistics.display = display.name.view();
    statistics.samples = samples.size();
    statistics.places = samples.place_count();
    statistics.pixels_lit = field.flashes.size();
    statistics.voxels_lit = seen.places.size();
    statistics.light_outside = seen.outside;
    statistics.has_frame = device.has_frame != 0;
    statistics.frame = device.shown_frame;
    statistics.brightness = device.brightness;
    statistics.blank = device.blank != 0;
    if (seen.places.empty()) return statistics;

    const SampleVolumes volumes = sample_volumes(display);
    std::vector<double> group_area(samples.group_count());
    const std::size_t columns = samples.lattice().column_count();
    for (std::size_t column = 0; column < columns; ++column) {
        group_area[samples.group_of(column)] += volumes.at_x(column % samples.lattice().nx);
    }
    const double infinity = std::numeric_limits<double>::infinity();
    Statistics::Visits visits{std::numeric_limits<std::uint32_t>::max(), 0.0, 0};
    double dimmest = infinity;
    double brightest = 0.0;
    for (const SeenPlace& place : seen.places) {
        const auto column = static_cast<std::size_t>(place.sample % columns);
        const double volume =
            group_area[samples.group_of(column)] * volumes.at_k(static_cast<std::size_t>(place.sample / columns));
        dimmest = std::min(dimmest, place.visits / volume);
        brightest = std::max(brightest, place.visits / volume);
        visits.least = std::min(visits.least, place.visits);
        visits.most = std::max(visits.most, place.visits);
    }
    const auto lit = static_cast<double>(statistics.voxels_lit);
    visits.mean = static_cast<double>(statistics.pixels_lit - statistics.light_outside) / lit;
    statistics.visits = visits;
    statistics.coverage = lit / static_cast<double>(statistics.places);
    statistics.brightness_ratio = brightest / dimmest;
    return statistics;
}

std::string to_json(const Statistics& statistics) {
    const std::string frame = statistics.has_frame ? fmt::format("{}", statistics.frame) : "null";
    const Statistics::Visits& visits = statistics.visits;
    const std::string seen =
        statistics.voxels_lit > 0
            ? fmt::format(R"({{"least": {}, "mean": {:.6g}, "most": {}}}, "brightness_ratio": {:.6g})", visits.least,
                          visits.mean, visits.most, statistics.brightness_ratio)
            : R"(null, "brightness_ratio": null)";
    return fmt::format(
        R"({{"display": {}, "samples": {}, "places": {}, "pixels_lit": {}, "voxels_lit": {}, "light_outside": {}, )"
        R"("coverage": {:.6g}, "visits": {}, "frame": {}, "brightness": {}, "blank": {}}})",
        json_quoted(statistics.display), statistics.samples, statistics.places, statistics.pixels_lit,
        statistics.voxels_lit, statistics.light_outside, statistics.coverage, seen, frame, statistics.brightness,
        statistics.blank);
}

}  // namespace xorvox::sim
