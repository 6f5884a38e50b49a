// pattern: a bring-up picture, drawn on a display's pixels as they are wired, and sent like any other frame.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "driver/display/lattice.h"
#include "driver/display/toml.h"
#include "driver/host/pattern.h"
#include "sim/statistics.h"
#include "tools/commands.h"
#include "tools/console.h"
#include "tools/delivery.h"
#include "tools/placement.h"
#include "tools/stream.h"

namespace xorvox::tools {
namespace {

double seconds_through(const DisplayDescription& display, host::Pattern pattern) {
    return static_cast<double>(host::pattern_frames(display, pattern)) / display.cycles_per_second;
}

/// "12.4 s", "3.5 minutes", "82 hours".
std::string duration(double seconds) {
    if (seconds < 120.0) return fmt::format("{:.1f} s", seconds);
    if (seconds < 7200.0) return fmt::format("{:.1f} minutes", seconds / 60.0);
    return fmt::format("{:.0f} hours", seconds / 3600.0);
}

void list(const DisplayDescription& display, bool json) {
    if (json) fmt::print("[");
    const char* separator = "";
    for (const host::PatternInfo& info : host::patterns()) {
        if (json) {
            fmt::print("{}\n  {{\"name\": {}, \"summary\": {}, \"moves\": {}, \"frames\": {}}}", separator,
                       json_string(info.name), json_string(info.summary), info.moves,
                       host::pattern_frames(display, info.pattern));
            separator = ",";
            continue;
        }
        fmt::print("{:<12} {}{}\n", info.name, info.summary,
                   info.moves ? fmt::format("; {} in all", duration(seconds_through(display, info.pattern))) : "");
    }
    if (json) fmt::print("\n]\n");
}

/// What there is to measure on the display: where the marks of `pattern` are to be.
std::vector<std::string> places(const DisplayDescription& display, host::Pattern pattern) {
    std::vector<std::string> lines;
    if (pattern == host::Pattern::Axis) {
        for (const host::AxisBand& band : host::axis_bands(display)) {
            lines.push_back(
                fmt::format("band {}{}: panel {}, {} side, {:.1f} mm from the axis; its arcs at {:.1f} and "
                            "{:.1f} mm",
                            lines.size(), lines.empty() ? ", the lowest" : "", band.panel,
                            band.right_side ? "right" : "left", band.radius_mm, band.low_arc_mm, band.high_arc_mm));
        }
    }
    const bool has_planes = display.kind == DisplayKind::StackedPlanes || display.kind == DisplayKind::SweptPlane;
    if (pattern == host::Pattern::Index && has_planes && display.slices > 1) {
        const DisplayLattice lattice(display);
        const auto height_mm = [&](std::uint32_t slice) { return sample_position(lattice.view(), 0, 0, slice).z; };
        const std::uint32_t border = host::index_border_slice(display);
        lines.push_back(fmt::format("slice 0, all of it, at {:.1f} mm; slice {}, its border, {:.1f} mm above it",
                                    height_mm(0), border, height_mm(border) - height_mm(0)));
    }
    return lines;
}

std::string places_json(const DisplayDescription& display, host::Pattern pattern) {
    std::string text;
    for (const std::string& line : places(display, pattern)) text += (text.empty() ? "" : ", ") + json_string(line);
    return '[' + text + ']';
}

bool is_here(const transport::Address& address) {
    return address.kind == transport::AddressKind::Loopback;
}

/// Of how many slices a display in this program shows one. Its light is kept flash by flash, so patterns that light
/// millions of pixels are thinned out; and in a picture of a rotor's whole turn, a pattern that is to be read at rest
/// would be a solid of revolution, so that slice 0 has to do.
std::uint32_t slice_step(const DeliveryOptions& options, const transport::Address& address,
                         const DisplayDescription& display, const host::PatternInfo& info,
                         const host::PatternLight& lit) {
    constexpr std::uint64_t kMostFlashes = 8'000'000;
    if (!is_here(address)) return 1;
    if (!options.png.empty() && info.at_rest && display.kind == DisplayKind::RotatingPanel) return display.slices;
    const std::uint64_t step = std::max<std::uint64_t>(1, (lit.pixels + kMostFlashes - 1) / kMostFlashes);
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(step, display.slices));
}

/// Darkens all slices but every `step`th; answers how many stay.
std::uint32_t thin_out(const DisplayDescription& display, std::uint32_t step, std::span<std::byte> frame) {
    std::uint32_t kept = 0;
    for (std::uint32_t slice = 0; slice < display.slices; ++slice) {
        if (slice % step == 0) {
            ++kept;
        } else {
            std::ranges::fill(frame.subspan(slice * slice_bytes(display), slice_bytes(display)), std::byte{0});
        }
    }
    return kept;
}

void print_thinned(const DisplayDescription& display, std::uint32_t slices) {
    if (slices == display.slices) return;
    if (slices == 1) {
        fmt::print("simulated: slice 0 alone, as a display at rest shows it\n");
    } else {
        fmt::print("simulated: {} of the {} slices; file: and tcp: get all of them\n", slices, display.slices);
    }
}

/// Where a pattern went that is not simulated here.
std::string gone_to(const transport::Address& address) {
    return address.kind == transport::AddressKind::File
               ? fmt::format("{} is written", address.path)
               : fmt::format("tcp:{}:{} has shown it", address.host, address.port);
}

void print_seen(const DeliveryOptions& options, const std::optional<LightSeen>& light) {
    if (!light) return;
    print_in_time(options.simulation, light->in_time);
    if (options.png.empty()) return;
    fmt::print("picture: {}, {:.1f} % of it is lit\n", options.png, 100.0 * light->picture_covered);
}

/// What is the same of patterns that stand and that move: the beginning of a JSON object.
std::string heading_json(const DeliveryOptions& options, const DisplayDescription& display,
                         const host::PatternInfo& info) {
    return fmt::format(
        "{{\"display\": {}, \"pattern\": {}, \"moves\": {}, \"frames\": {}, \"places\": {}, \"to\": {}, "
        "\"picture\": {}",
        json_string(display.name.view()), json_string(info.name), info.moves,
        host::pattern_frames(display, info.pattern), places_json(display, info.pattern), json_string(options.to),
        options.png.empty() ? "null" : json_string(options.png));
}

Expected<void> show_still(const DeliveryOptions& options, const transport::Address& address,
                          const DisplayDescription& display, const host::PatternInfo& info, io::AtomicFile* png,
                          sim::RecordingWriter* recording) {
    std::vector<std::byte> frame(frame_bytes(display));
    const host::PatternLight lit = host::paint_pattern(display, info.pattern, 0, frame);
    const std::uint32_t slices = thin_out(display, slice_step(options, address, display, info, lit), frame);
    if (!options.json) {
        fmt::print("{} on {}: {}\n", info.name, display.name.view(), info.summary);
        for (const std::string& line : places(display, info.pattern)) fmt::print("  {}\n", line);
        std::fflush(stdout);  // To be read while --hold waits.
    }
    const std::uint64_t most_flashes = std::min(lit.pixels, slices * lit.most_in_slice);
    const Expected<Delivery> delivery = deliver(options, address, display, frame, most_flashes, png, recording);
    if (!delivery) {
        keep_recording(options, recording);
        return tl::unexpected(delivery.error());
    }
    const std::uint64_t slice_pixels = frame_pixels(display) / display.slices;
    if (options.json) {
        fmt::print(
            "{}, \"pixels_lit\": {}, \"most_in_slice\": {}, \"slice_pixels\": {}, "
            "\"slices_shown\": {}, \"light\": {}}}\n",
            heading_json(options, display, info), lit.pixels, lit.most_in_slice, slice_pixels, slices,
            light_json(options, delivery->light));
        return finish_recording(options, recording);
    }
    fmt::print("{}: {} pixels, at most {} of the {} of a slice\n", is_here(address) ? "pattern" : "sent",
               thousands(lit.pixels), thousands(lit.most_in_slice), thousands(slice_pixels));
    if (!is_here(address)) fmt::print("{}\n", gone_to(address));
    print_thinned(display, slices);
    print_seen(options, delivery->light);
    return finish_recording(options, recording);
}

Expected<void> show_moving(const DeliveryOptions& options, const transport::Address& address,
                           const DisplayDescription& display, const host::PatternInfo& info, double seconds,
                           io::AtomicFile* png, sim::RecordingWriter* recording) {
    const std::uint64_t frames = host::pattern_frames(display, info.pattern);
    if (!options.json) {
        fmt::print("{} on {}: {}; {} frames, once through takes {}\n", info.name, display.name.view(), info.summary,
                   thousands(frames), duration(seconds_through(display, info.pattern)));
        std::fflush(stdout);
    }
    std::optional<Progress> progress("showing " + std::string(info.name));
    std::uint32_t slices = display.slices;
    const FrameSource source = [&](const FrameMoment& moment, std::span<std::byte> frame) {
        if (seconds == 0.0 && moment.number >= frames) return false;
        const host::PatternLight lit = host::paint_pattern(display, info.pattern, moment.number, frame);
        slices = thin_out(display, slice_step(options, address, display, info, lit), frame);
        if (!progress) return true;
        const double done =
            seconds > 0.0 ? moment.seconds / seconds : static_cast<double>(moment.number) / static_cast<double>(frames);
        const double one =
            seconds > 0.0 ? 1.0 / (display.cycles_per_second * seconds) : 1.0 / static_cast<double>(frames);
        progress->done(done);
        if (done + 1.5 * one > 1.0) progress.reset();  // Its last frame: --hold, or the picture, follows.
        return true;
    };
    const Expected<StreamDelivery> delivery =
        deliver_stream(options, address, display, source, seconds, png, recording);
    progress.reset();
    if (!delivery) return tl::unexpected(delivery.error());
    if (options.json) {
        fmt::print("{}, {}, \"slices_shown\": {}, \"light\": {}}}\n", heading_json(options, display, info),
                   stream_json(*delivery), slices, light_json(options, delivery->light));
    } else {
        print_stream(*delivery);
        if (!is_here(address) && !delivery->broken) fmt::print("{}\n", gone_to(address));
        print_thinned(display, slices);
        print_seen(options, delivery->light);
    }
    if (const auto kept = finish_recording(options, recording); !kept) return kept;
    return delivery->broken ? Expected<void>(tl::unexpected(*delivery->broken)) : Expected<void>();
}

}  // namespace

Expected<void> pattern(const PatternOptions& asked) {
    PatternOptions options = asked;
    const Expected<transport::Address> address = transport::parse_address(options.delivery.to);
    if (!address) return fail("--to: " + address.error().message);
    if (const auto possible = check_delivery(options.delivery, *address, ""); !possible) return possible;
    // The place of a pattern on the display is what it is about.
    if (options.delivery.frame.empty()) options.delivery.frame = "display";
    const Expected<DisplayFile> display = load_display(options.display);
    if (!display) return tl::unexpected(display.error());
    if (options.name.empty()) {
        list(*display, options.delivery.json);
        return {};
    }
    const Expected<host::PatternInfo> info = host::find_pattern(options.name);
    if (!info) return tl::unexpected(info.error());
    if (!(options.seconds >= 0.0) || !std::isfinite(options.seconds)) {
        return fail(fmt::format("--seconds is {}; it takes a number of seconds, at least 0", options.seconds));
    }
    if (options.seconds > 0.0 && !info->moves) {
        return fail(fmt::format("--seconds is for patterns that move; {} stands still", info->name));
    }
    if (const auto fits = check_display_fits(*display); !fits) return fits;
    std::optional<io::AtomicFile> png;
    if (!options.delivery.png.empty()) {
        Expected<io::AtomicFile> file = io::AtomicFile::create(options.delivery.png);
        if (!file) return tl::unexpected(file.error());
        png = std::move(*file);
    }
    io::AtomicFile* const picture = png ? &*png : nullptr;
    auto recording = make_recording(options.delivery, *display);
    if (!recording) return tl::unexpected(recording.error());
    sim::RecordingWriter* const recorder = *recording ? &**recording : nullptr;
    if (info->moves)
        return show_moving(options.delivery, *address, *display, *info, options.seconds, picture, recorder);
    return show_still(options.delivery, *address, *display, *info, picture, recorder);
}

}  // namespace xorvox::tools
