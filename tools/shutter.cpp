#include "tools/shutter.h"

#include <cstddef>
#include <cstdio>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "driver/host/faults.h"
#include "sim/comparison.h"
#include "sim/histogram.h"
#include "tools/console.h"
#include "tools/delivery.h"
#include "tools/stop.h"

namespace xorvox::tools {
namespace {

constexpr double kLongest_s = 60.0;

bool is_png(const std::string& path) {
    return extension_of(path) == ".png";
}

Expected<void> write_image(io::AtomicFile& file, const sim::Image& image) {
    const std::vector<std::byte> png = sim::encode_png(image);
    const auto written = file.write({reinterpret_cast<const char*>(png.data()), png.size()});
    return written ? file.commit() : written;
}

/// "16.7 ms", "1.50 s".
std::string duration(double ms) {
    return ms < 1000.0 ? fmt::format("{:.3g} ms", ms) : fmt::format("{:.2f} s", ms * 1e-3);
}

}  // namespace

Expected<void> Shutter::check(const SimulationOptions& options) {
    if (!options.trace.empty() && options.fidelity == "strobes") {
        return fail("--trace follows the pins, which --fidelity strobes does not have; leave out one of them");
    }
    if (options.exposure_s && *options.exposure_s > kLongest_s) {
        return fail(fmt::format("--exposure {}: a shutter is open for up to {} s", *options.exposure_s, kLongest_s));
    }
    if (!options.compare.empty() && !is_png(options.compare)) {
        return fail(
            fmt::format("--compare {}: the picture is a PNG; give it a name that ends in .png", options.compare));
    }
    const std::string extension = extension_of(options.histogram);
    if (!options.histogram.empty() && extension != ".png" && extension != ".csv") {
        return fail(
            fmt::format("--histogram {}: give it a name that ends in .csv, for numbers, or in .png, for a chart",
                        options.histogram));
    }
    return {};
}

bool Shutter::is_wanted(const SimulationOptions& options, const sim::Conditions& conditions) {
    return conditions.rotor || !options.fidelity.empty() || options.exposure_s || !options.trace.empty() ||
           !options.histogram.empty() || !options.compare.empty();
}

sim::Fidelity Shutter::fidelity(const SimulationOptions& options) {
    const bool edges = options.fidelity == "edges" || !options.trace.empty();
    return edges ? sim::Fidelity::Edges : sim::Fidelity::Strobes;
}

Expected<Shutter> Shutter::make(const SimulationOptions& options) {
    Shutter shutter;
    const auto begin = [](const char* option, const std::string& path,
                          std::optional<io::AtomicFile>& file) -> Expected<void> {
        if (path.empty()) return {};
        Expected<io::AtomicFile> made = io::AtomicFile::create(path);
        if (!made) return fail(fmt::format("{} {}", option, made.error().message));
        file = std::move(*made);
        return {};
    };
    for (const Expected<void>& begun :
         {begin("--trace", options.trace, shutter.trace_), begin("--histogram", options.histogram, shutter.histogram_),
          begin("--compare", options.compare, shutter.comparison_)}) {
        if (!begun) return tl::unexpected(begun.error());
    }
    return shutter;
}

void Shutter::open(sim::Simulator& simulator, const SimulationOptions& options) {
    watch_ = std::make_unique<Watch>(simulator, options.exposure_s, trace_ ? &*trace_ : nullptr);
}

bool Shutter::is_over(std::uint64_t now_ns) {
    return watch_ && watch_->is_over(now_ns);
}

Expected<SeenInTime> Shutter::close(sim::Simulator& simulator, std::uint64_t now_ns, const DeliveryOptions& options,
                                    const Meanwhile& meanwhile) {
    const SimulationOptions& wanted = options.simulation;
    if (!watch_) open(simulator, wanted);
    const device::Shown shown = simulator.device().shown();
    {
        const Progress progress("watching the display");
        watch_->wait(now_ns, meanwhile);
    }
    if (asked_to_stop()) return fail("interrupted while the display was watched");

    SeenInTime seen;
    seen.timing = simulator.timing().timing();
    const Progress progress("measuring the light");
    if (const auto finished = watch_->finish(seen.trace_ended_ms); !finished) return tl::unexpected(finished.error());
    const sim::Exposure& exposure = watch_->exposure();
    seen.exposure = sim::measure(exposure, shown.page, shown.brightness);
    if (histogram_) {
        const sim::LightHistogram histogram = sim::make_histogram(exposure, shown.page, shown.brightness);
        Expected<void> written;
        if (is_png(wanted.histogram)) {
            written = write_image(*histogram_, sim::draw_chart(histogram));
        } else {
            written = histogram_->write(sim::to_csv(histogram));
            if (written) written = histogram_->commit();
        }
        if (!written) return tl::unexpected(written.error());
    }
    if (comparison_) {
        sim::PictureOptions picture;
        picture.framing = options.frame == "display" ? sim::Framing::Display : sim::Framing::Object;
        picture.width = options.size ? options.size->width : 720;
        picture.height = options.size ? options.size->height : 540;
        Expected<sim::Picture> drawn = sim::render_comparison(exposure, shown.page, shown.brightness, picture);
        if (!drawn) return tl::unexpected(drawn.error());
        if (const auto written = write_image(*comparison_, drawn->image); !written) {
            return tl::unexpected(written.error());
        }
    }
    seen.light = exposure.light();
    watch_.reset();
    return seen;
}

void print_timing(const sim::Timing& timing) {
    std::string latency;
    if (timing.latency.frames > 0) {
        latency = fmt::format("; first light {} after the first packet", duration(timing.latency.mean_ns * 1e-6));
        if (timing.latency.frames > 1) {
            latency +=
                fmt::format(" on average, {} at most", duration(static_cast<double>(timing.latency.most_ns) * 1e-6));
        }
    }
    fmt::print("in time: {} frame{} shown, {} late, {} dropped, {} cycles torn{}\n", thousands(timing.presented),
               timing.presented == 1 ? "" : "s", thousands(timing.late), thousands(timing.dropped),
               thousands(timing.torn), latency);
    for (std::uint8_t number = 1; number < timing.faults.size(); ++number) {
        if (timing.faults[number] == 0) continue;
        fmt::print("fault {}: {}\n", number, host::describe(static_cast<wire::Fault>(number)));
    }
}

void print_in_time(const SimulationOptions& options, const std::optional<SeenInTime>& seen) {
    if (!seen) return;
    const sim::ExposureStatistics& light = seen->exposure;
    fmt::print("seen in {}: of {} voxels {} {} were lit, {} not; {} were lit that were not sent\n",
               duration(light.exposure_ms), thousands(light.sent),
               seen->timing.presented > 1 ? "of the last frame" : "sent", thousands(light.lit - light.extra),
               thousands(light.lost), thousands(light.extra));
    if (light.lit > 0) {
        fmt::print(
            "light: {:.1f} % of what was sent, uneven by {:.1f} %; {:.2f} % of it out of place, by up to {:.2f} "
            "mm, {:.2f} slices\n",
            100.0 * light.light, 100.0 * light.uniformity.spread, 100.0 * light.outside, light.stray_mm,
            light.stray_slices);
    }
    print_timing(seen->timing);
    if (!options.trace.empty()) fmt::print("trace: {}\n", options.trace);
    if (seen->trace_ended_ms) {
        warn(fmt::format("{} is full after {}; a shorter --exposure makes a whole one", options.trace,
                         duration(*seen->trace_ended_ms)));
    }
    if (!options.histogram.empty()) fmt::print("histogram: {}\n", options.histogram);
    if (!options.compare.empty()) fmt::print("comparison: {}\n", options.compare);
}

std::string in_time_json(const SimulationOptions& options, const std::optional<SeenInTime>& seen) {
    if (!seen) return "null";
    const auto object = [](std::string text) {
        while (text.ends_with('\n')) text.pop_back();
        return text;
    };
    std::string faults;
    for (const std::string& fault : options.faults) faults += (faults.empty() ? "" : ", ") + json_string(fault);
    return fmt::format(
        "{{\"setup\": {{\"fidelity\": \"{}\", \"rotor\": {}, \"faults\": [{}], \"sim\": {}, \"seed\": {}}}, "
        "\"exposure\": {}, \"timing\": {}, \"trace_ended_ms\": {}}}",
        Shutter::fidelity(options) == sim::Fidelity::Edges ? "edges" : "strobes",
        options.rotor.empty() ? "null" : json_string(options.rotor), faults,
        options.file.empty() ? "null" : json_string(options.file),
        options.seed ? fmt::format("{}", *options.seed) : "null", object(sim::to_json(seen->exposure)),
        object(sim::to_json(seen->timing)),
        seen->trace_ended_ms ? fmt::format("{:.6g}", *seen->trace_ended_ms) : "null");
}

}  // namespace xorvox::tools
