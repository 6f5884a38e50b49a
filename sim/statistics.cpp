#include "sim/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <string_view>
#include <vector>

#include "sim/rebuild.h"

namespace xorvox::sim {
namespace {

/// The space that one sample of a column stands for, by the column's number in a row of the lattice.
std::vector<double> sample_volumes_mm3(const DisplayDescription& display) {
    std::vector<double> volumes;
    if (display.kind == DisplayKind::StackedPlanes) {
        const Panel& panel = display.panels[0];
        volumes.assign(panel.columns, panel.column_pitch_mm * panel.row_pitch_mm * display.plane_pitch_mm);
        return volumes;
    }
    const double slice_rad = 2.0 * std::numbers::pi / display.slices;
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        const Panel& panel = display.panels[p];
        const double half = panel.column_pitch_mm / 2.0;
        for (std::uint32_t column = 0; column < panel.columns; ++column) {
            const double middle = panel.shift_mm + (column - (panel.columns - 1) / 2.0) * panel.column_pitch_mm;
            const double r = std::abs(middle);
            // The integral of |r| over the LED's pitch; an LED that reaches over the axis sweeps both sides of it.
            const double moment = r >= half ? 2.0 * half * r : r * r + half * half;
            volumes.push_back(moment * slice_rad * panel.row_pitch_mm);
        }
    }
    return volumes;
}

std::string quoted(std::string_view text) {
    std::string json = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') {
            json += '\\';
            json += c;
        } else if (static_cast<unsigned char>(c) < 0x20) {
            fmt::format_to(std::back_inserter(json), "\\u{:04x}", static_cast<unsigned>(c));
        } else {
            json += c;
        }
    }
    return json + '"';
}

}  // namespace

Statistics measure(const DisplayDescription& display, const LightField& field, const wire::DeviceStatus& device) {
    const DisplaySamples samples(display);
    const Rebuilt seen = samples.rebuild(field);
    const std::vector<double> volumes = sample_volumes_mm3(display);

    Statistics statistics;
    statistics.display = display.name.view();
    statistics.samples = samples.size();
    statistics.places = samples.group_count() * samples.height_count();
    statistics.pixels_lit = field.flashes.size();
    statistics.light_outside = seen.outside;
    statistics.has_frame = device.has_frame != 0;
    statistics.frame = device.shown_frame;
    statistics.brightness = device.brightness;
    statistics.blank = device.blank != 0;

    double least = std::numeric_limits<double>::infinity();
    double most = 0.0;
    for (std::size_t group = 0; group < samples.group_count(); ++group) {
        const auto columns = samples.columns_of(group);
        double volume = 0.0;
        for (const std::uint32_t column : columns) volume += volumes[column % volumes.size()];
        for (std::size_t k = 0; k < samples.height_count(); ++k) {
            const std::uint32_t visits = seen.visits[k * samples.column_count() + columns[0]];
            if (visits == 0) continue;
            ++statistics.voxels_lit;
            least = std::min(least, visits / volume);
            most = std::max(most, visits / volume);
        }
    }
    if (statistics.voxels_lit > 0) statistics.brightness_ratio = most / least;
    return statistics;
}

std::string to_json(const Statistics& statistics) {
    const std::string frame = statistics.has_frame ? fmt::format("{}", statistics.frame) : "null";
    const std::string ratio = statistics.voxels_lit > 0 ? fmt::format("{:.6g}", statistics.brightness_ratio) : "null";
    return fmt::format(
        R"({{"display": {}, "samples": {}, "places": {}, "pixels_lit": {}, "voxels_lit": {}, "light_outside": {}, )"
        R"("brightness_ratio": {}, "frame": {}, "brightness": {}, "blank": {}}})",
        quoted(statistics.display), statistics.samples, statistics.places, statistics.pixels_lit, statistics.voxels_lit,
        statistics.light_outside, ratio, frame, statistics.brightness, statistics.blank);
}

}  // namespace xorvox::sim
