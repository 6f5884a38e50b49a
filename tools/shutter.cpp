#include "tools/shutter.h"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "driver/host/faults.h"
#include "sim/comparison.h"
#include "sim/histogram.h"
#include "sim/scan_out.h"
#include "sim/vcd.h"
#include "tools/console.h"
#include "tools/delivery.h"
#include "tools/stop.h"

namespace xorvox::tools {
namespace {

constexpr double kLongest_s = 60.0;

bool is_png(const std::string& path) {
    return extension_of(path) == ".png";
}

/// When the shutter opens and closes: with the second cycle that the device begins, for the time that was asked for or
/// for that cycle. In the first one, strings of LEDs are sent the frame.
class Opening {
public:
    Opening(const sim::Simulator& simulator, const std::optional<double>& exposure_s)
        : simulator_(simulator), exposure_s_(exposure_s), before_ns_(simulator.cycle_begin_ns()) {}

    /// Looks at the simulator, which has gone on.
    void look() {
        const std::uint64_t begin_ns = simulator_.cycle_begin_ns();
        if (begin_ns == before_ns_) return;
        if (!is_open_) {
            if (++begun_ == 2) open_at(begin_ns);
        } else if (to_ns_ == kNever) {
            to_ns_ = begin_ns;
        }
        before_ns_ = begin_ns;
    }
    void open_at(std::uint64_t from_ns) {
        is_open_ = true;
        from_ns_ = from_ns;
        if (exposure_s_) to_ns_ = from_ns + static_cast<std::uint64_t>(*exposure_s_ * 1e9);
    }
    void close_at(std::uint64_t to_ns) { to_ns_ = to_ns; }

    bool is_open() const { return is_open_; }
    std::uint64_t from_ns() const { return from_ns_; }
    std::uint64_t to_ns() const { return to_ns_; }  ///< kNever: not known yet.

    static constexpr std::uint64_t kNever = ~std::uint64_t{0} / 2;

private:
    const sim::Simulator& simulator_;
    std::optional<double> exposure_s_;
    std::uint64_t before_ns_;
    int begun_ = 0;
    bool is_open_ = false;
    std::uint64_t from_ns_ = 0;
    std::uint64_t to_ns_ = kNever;
};

/// The part of a trace in which the shutter is open.
class Trace {
public:
    Trace(const sim::Simulator& simulator, Opening& opening, io::AtomicFile& file)
        : file_(file),
          opening_(opening),
          writer_(sim::pin_names(simulator.display()), options(simulator),
                  [this](std::string_view bytes) { return file_.write(bytes); }) {}

    void on_pins(std::uint64_t time_ns, LineMask levels, LineMask changed) {
        opening_.look();
        if (!opening_.is_open()) {
            before_ = levels;
            return;
        }
        if (time_ns > opening_.to_ns()) return;
        if (!begun_) writer_.on_pins(opening_.from_ns(), before_, ~LineMask{0});
        begun_ = true;
        writer_.on_pins(time_ns, levels, changed);
    }

    Expected<std::optional<double>> finish() {
        if (const auto written = writer_.finish(opening_.to_ns()); !written) return tl::unexpected(written.error());
        if (const auto kept = file_.commit(); !kept) return tl::unexpected(kept.error());
        const auto ended = writer_.ended_early_ns();
        if (!ended) return std::optional<double>();
        return std::optional(static_cast<double>(*ended - opening_.from_ns()) * 1e-6);
    }

private:
    static sim::VcdOptions options(const sim::Simulator& simulator) {
        sim::VcdOptions options;
        options.scope = simulator.display().name.view();
        return options;
    }

    io::AtomicFile& file_;
    Opening& opening_;
    sim::VcdWriter writer_;
    LineMask before_ = 0;
    bool begun_ = false;
};

Expected<void> write_image(io::AtomicFile& file, const sim::Image& image) {
    const std::vector<std::byte> png = sim::encode_png(image);
    const auto written = file.write({reinterpret_cast<const char*>(png.data()), png.size()});
    return written ? file.commit() : written;
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

Expected<SeenInTime> Shutter::open(sim::Simulator& simulator, std::uint64_t now_ns, const DeliveryOptions& options,
                                   const Meanwhile& meanwhile) {
    const SimulationOptions& wanted = options.simulation;
    const device::Shown shown = simulator.device().shown();
    const std::uint64_t cycle = cycle_ns(simulator.display());
    Opening opening(simulator, wanted.exposure_s);
    std::optional<Trace> trace;
    if (trace_) trace.emplace(simulator, opening, *trace_);
    std::optional<sim::Exposure> exposure;
    const auto expose = [&] {
        exposure.emplace(
            simulator.display(), simulator.built(), [&](std::uint64_t time_ns) { return simulator.cycles_at(time_ns); },
            opening.from_ns(), opening.to_ns(), simulator.faults());
    };
    simulator.watch([&](const sim::Strobe& strobe) {
        opening.look();
        if (!opening.is_open()) return;
        if (!exposure) expose();
        if (exposure->to_ns() != opening.to_ns()) exposure->close(opening.to_ns());
        exposure->add(strobe);
    });
    if (trace) {
        simulator.watch_pins([&](std::uint64_t time_ns, LineMask levels, LineMask changed) {
            trace->on_pins(time_ns, levels, changed);
        });
    }
    {
        const Progress progress("watching the display");
        const auto go_until = [&](std::uint64_t end_ns, const auto& is_enough) {
            while (now_ns < end_ns && !is_enough() && !asked_to_stop()) {
                now_ns = std::min(std::max(simulator.next_boundary_ns(), now_ns + 1), end_ns);
                do {
                    meanwhile(now_ns);
                } while (simulator.poll(now_ns) == Status::Ok);
                opening.look();
            }
        };
        // A display that stands begins no cycle.
        constexpr std::uint64_t kPatience = 8;
        go_until(now_ns + kPatience * cycle, [&] { return opening.is_open(); });
        if (!opening.is_open()) opening.open_at(now_ns);
        go_until(now_ns + kPatience * cycle, [&] { return opening.to_ns() != Opening::kNever; });
        if (opening.to_ns() == Opening::kNever) opening.close_at(now_ns);
        // Strobes are told when they have ended: of LEDs that keep their light, with the next frame.
        go_until(opening.to_ns() + 2 * cycle, [] { return false; });
    }
    if (!exposure) expose();
    if (exposure->to_ns() != opening.to_ns()) exposure->close(opening.to_ns());
    simulator.watch({});
    simulator.watch_pins({});
    if (asked_to_stop()) return fail("interrupted while the display was watched");

    SeenInTime seen;
    seen.timing = simulator.timing().timing();
    const Progress progress("measuring the light");
    seen.exposure = sim::measure(*exposure, shown.page, shown.brightness);
    if (trace) {
        const Expected<std::optional<double>> ended = trace->finish();
        if (!ended) return tl::unexpected(ended.error());
        seen.trace_ended_ms = *ended;
    }
    if (histogram_) {
        const sim::LightHistogram histogram = sim::make_histogram(*exposure, shown.page, shown.brightness);
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
        Expected<sim::Picture> drawn = sim::render_comparison(*exposure, shown.page, shown.brightness, picture);
        if (!drawn) return tl::unexpected(drawn.error());
        if (const auto written = write_image(*comparison_, drawn->image); !written) {
            return tl::unexpected(written.error());
        }
    }
    seen.light = exposure->light();
    return seen;
}

void print_timing(const sim::Timing& timing) {
    std::string latency;
    if (timing.latency.frames > 0) {
        latency = fmt::format("; first light {:.3g} ms after the first packet", timing.latency.mean_ns * 1e-6);
        if (timing.latency.frames > 1) {
            latency +=
                fmt::format(" on average, {:.3g} ms at most", static_cast<double>(timing.latency.most_ns) * 1e-6);
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
    fmt::print("seen in {:.4g} ms: of {} voxels sent {} were lit, {} not; {} were lit that were not sent\n",
               light.exposure_ms, thousands(light.sent), thousands(light.lit - light.extra), thousands(light.lost),
               thousands(light.extra));
    if (light.lit > 0) {
        fmt::print(
            "light: {:.1f} % of what was sent, uneven by {:.1f} %; {:.2f} % of it out of place, by up to {:.3g} "
            "mm, {:.2g} slices\n",
            100.0 * light.light, 100.0 * light.uniformity.spread, 100.0 * light.outside, light.stray_mm,
            light.stray_slices);
    }
    print_timing(seen->timing);
    if (!options.trace.empty()) fmt::print("trace: {}\n", options.trace);
    if (seen->trace_ended_ms) {
        warn(fmt::format("{} is full after {:.3g} ms; a shorter --exposure makes a whole one", options.trace,
                         *seen->trace_ended_ms));
    }
    if (!options.histogram.empty()) fmt::print("histogram: {}\n", options.histogram);
    if (!options.compare.empty()) fmt::print("comparison: {}\n", options.compare);
}

std::string in_time_json(const std::optional<SeenInTime>& seen) {
    if (!seen) return "null";
    const auto object = [](std::string text) {
        while (text.ends_with('\n')) text.pop_back();
        return text;
    };
    return fmt::format("{{\"exposure\": {}, \"timing\": {}, \"trace_ended_ms\": {}}}",
                       object(sim::to_json(seen->exposure)), object(sim::to_json(seen->timing)),
                       seen->trace_ended_ms ? fmt::format("{:.6g}", *seen->trace_ended_ms) : "null");
}

}  // namespace xorvox::tools
