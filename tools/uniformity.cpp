// uniformity: how even the light of a display is in space, as it comes and corrected, in the simulator.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "driver/display/toml.h"
#include "driver/host/color.h"
#include "driver/host/light_gain.h"
#include "driver/host/slices.h"
#include "sim/pixel_light.h"
#include "sim/uniformity.h"
#include "tools/commands.h"
#include "tools/console.h"
#include "tools/placement.h"

namespace xorvox::tools {
namespace {

/// A display whose brightest cell has at most so many times the light of its darkest one is called even.
constexpr double kEven = 1.25;

struct Measured {
    std::string name;
    std::size_t samples = 0;
    sim::Uniformity bright;
    // Corrected: in the nearest levels, and dithered.
    sim::Uniformity nearest;
    sim::Uniformity ordered;
    sim::Uniformity temporal;
    std::uint32_t bits = 0;      ///< A channel that are shown.
    double faintest = 0.0;       ///< The least light of a sample that is lit, of 1.
    double smallest_gain = 0.0;  ///< That evenness asks of a sample.

    bool is_even() const { return std::min(ordered.ratio(), temporal.ratio()) <= kEven; }
    /// The part of the light that the correction leaves.
    double kept() const { return temporal.mean / bright.mean; }
};

BitVolume full_volume(const Lattice& lattice) {
    BitVolume volume(lattice);
    const BitVolumeView view = volume.view();
    for (std::uint32_t z = 0; z < view.nz; ++z) {
        for (std::uint32_t y = 0; y < view.ny; ++y) {
            const auto row = view.row(y, z);
            std::ranges::fill(row, ~std::uint64_t{0});
            if (view.nx % 64 != 0) row.back() = (std::uint64_t{1} << (view.nx % 64)) - 1;
        }
    }
    return volume;
}

/// Frames of nothing but white, painted by all cores.
class WhiteFrames {
public:
    explicit WhiteFrames(const DisplayDescription& display) : display_(display), frame_(frame_bytes(display)) {}

    sim::Uniformity measure(sim::UniformityMeter meter, const host::LightSettings& settings, std::uint32_t frames,
                            Progress& progress) {
        const host::FramePainter painter(display_, settings);
        if (volume_.view().nx == 0) volume_ = full_volume(painter.lattice().view());
        for (std::uint32_t number = 0; number < frames; ++number) {
            progress.done(static_cast<double>(number) / frames);
            paint(painter, number);
            meter.add(frame_);
        }
        return meter.result();
    }

private:
    void paint(const host::FramePainter& painter, std::uint32_t number) {
        const std::uint32_t bands = std::clamp(std::thread::hardware_concurrency(), 1u, display_.slices);
        std::vector<std::jthread> threads;
        for (std::uint32_t band = 0; band < bands; ++band) {
            threads.emplace_back([&, band] {
                const std::uint32_t first = band * display_.slices / bands;
                const std::uint32_t end = (band + 1) * display_.slices / bands;
                // Fails for volumes and frames of another shape alone.
                (void)painter.paint_slices(volume_.view(), *white_, frame_, first, end - first, number);
            });
        }
    }

    const DisplayDescription& display_;
    std::vector<std::byte> frame_;
    std::unique_ptr<host::ColorField> white_ = host::parse_color("constant:white").value();
    BitVolume volume_;
};

double smallest_gain(const DisplayDescription& display) {
    const host::SampleGains gains(display, {.mode = host::LightMode::Even});
    std::size_t pixels = 0;
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        pixels += std::size_t{display.panels[p].columns} * display.panels[p].rows;
    }
    double smallest = 1.0;
    for (std::uint32_t slice = 0; slice < display.slices; ++slice) {
        const auto of_slice = static_cast<double>(gains.of_slice(slice));
        smallest = std::min(smallest, of_slice);
        const glm::vec3* of_pixels = gains.of_pixels(slice);
        for (std::size_t i = 0; of_pixels != nullptr && i < pixels; ++i) {
            smallest = std::min(smallest, of_slice * static_cast<double>(of_pixels[i].g));
        }
    }
    return smallest;
}

/// Light of the code in which only the lowest bit of green that is shown is set.
double faintest_light(const DisplayDescription& display) {
    const sim::PixelLight pixels(display);
    double faintest = 1.0;
    for (std::uint32_t bit = 0; bit < bits_per_pixel(display.format); ++bit) {
        const float light = pixels.of(1u << bit).g;
        if (light > 0.0f) faintest = std::min(faintest, static_cast<double>(light));
    }
    return faintest;
}

Measured measure(const DisplayFile& display, std::uint32_t frames) {
    Progress progress(fmt::format("measuring {}", display.name.view()));
    WhiteFrames white(display);
    const sim::UniformityMeter meter(display);
    Measured measured;
    measured.name = display.name.view();
    measured.samples = frame_pixels(display);
    measured.bright = white.measure(meter, {}, 1, progress);
    const auto corrected = [&](host::Dither dither, std::uint32_t count) {
        return white.measure(meter, {.mode = host::LightMode::Even, .dither = dither}, count, progress);
    };
    measured.nearest = corrected(host::Dither::None, 1);
    measured.ordered = corrected(host::Dither::Ordered, 1);
    measured.temporal = corrected(host::Dither::Temporal, frames);
    measured.bits = shown_bit_planes(display);
    measured.faintest = faintest_light(display);
    measured.smallest_gain = smallest_gain(display);
    return measured;
}

std::string ratio_text(double ratio) {
    return std::isfinite(ratio) ? fmt::format("{:.2f}", ratio) : "dark";
}

std::string ratio_json(double ratio) {
    return std::isfinite(ratio) ? fmt::format("{:.6g}", ratio) : "null";
}

/// Whether it is even, and why not.
std::string verdict(const Measured& measured) {
    if (measured.bright.ratio() <= kEven) return "even";
    if (measured.nearest.ratio() <= kEven) return "even when corrected";
    return fmt::format("{}: {} bit{} a channel, whose first level is {:.2g}; the smallest gain is {:.2g}",
                       measured.is_even() ? "even when dithered" : "not even", measured.bits,
                       measured.bits == 1 ? "" : "s", measured.faintest, measured.smallest_gain);
}

void print_text(const std::vector<Measured>& all, std::uint32_t frames) {
    std::size_t width = 7;
    for (const Measured& measured : all) width = std::max(width, measured.name.size());
    fmt::print(
        "Light of the brightest cell ÷ that of the darkest, all white; even is at most {}.\n"
        "bright: as it comes. even: corrected, in the nearest levels; ordered: dithered in space; temporal: and in"
        " time, over {} frame{}.\n\n"
        "{:<{}}  {:>5}  {:>7}  {:>7}  {:>7}  {:>8}  light left\n",
        kEven, frames, frames == 1 ? "" : "s", "display", width, "cells", "bright", "even", "ordered", "temporal");
    for (const Measured& measured : all) {
        fmt::print("{:<{}}  {:>5}  {:>7}  {:>7}  {:>7}  {:>8}  {:>8.1f} %  {}\n", measured.name, width,
                   measured.bright.cells, ratio_text(measured.bright.ratio()), ratio_text(measured.nearest.ratio()),
                   ratio_text(measured.ordered.ratio()), ratio_text(measured.temporal.ratio()), 100.0 * measured.kept(),
                   verdict(measured));
    }
}

std::string json_of(const sim::Uniformity& found) {
    const auto place = [](const glm::dvec3& mm) { return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", mm.x, mm.y, mm.z); };
    return fmt::format(
        R"({{"ratio": {}, "most": {:.6g}, "mean": {:.6g}, "least": {:.6g}, "most_mm": {}, "least_mm": {}}})",
        ratio_json(found.ratio()), found.most, found.mean, found.least, place(found.most_mm), place(found.least_mm));
}

void print_json(const std::vector<Measured>& all, std::uint32_t frames) {
    const char* separator = "[";
    for (const Measured& measured : all) {
        fmt::print(
            "{}\n  {{\"display\": {}, \"samples\": {}, \"cells_a_side\": {}, \"cells\": {}, \"bright\": {}, "
            "\"nearest\": {},"
            " \"ordered\": {}, \"temporal\": {}, \"frames\": {}, \"bits\": {}, \"faintest_light\": {:.6g},"
            " \"smallest_gain\": {:.6g}, \"light_kept\": {:.6g}, \"even\": {}}}",
            separator, json_string(measured.name), measured.samples, measured.bright.cells_a_side,
            measured.bright.cells, json_of(measured.bright), json_of(measured.nearest), json_of(measured.ordered),
            json_of(measured.temporal), frames, measured.bits, measured.faintest, measured.smallest_gain,
            measured.kept(), measured.is_even());
        separator = ",";
    }
    fmt::print("\n]\n");
}

}  // namespace

Expected<void> uniformity(const UniformityOptions& options) {
    std::vector<std::string> names = options.displays;
    if (names.empty()) {
        for (const Preset& preset : presets()) names.emplace_back(preset.name);
    }
    std::vector<DisplayFile> displays;
    for (const std::string& name : names) {
        auto display = load_display(name);
        if (!display) return tl::unexpected<Error>(display.error());
        if (const auto fits = check_display_fits(*display); !fits) return fits;
        displays.push_back(std::move(*display));
    }
    std::vector<Measured> all;
    for (const DisplayFile& display : displays) all.push_back(measure(display, options.frames));
    if (options.json) {
        print_json(all, options.frames);
    } else {
        print_text(all, options.frames);
    }
    return {};
}

}  // namespace xorvox::tools
