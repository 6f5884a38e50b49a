// pattern: a bring-up picture, drawn on a display's pixels as they are wired, and sent like any other frame.
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

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

std::string light_json(const std::optional<LightSeen>& light) {
    std::string text = light ? sim::to_json(light->statistics) : "null";
    while (text.ends_with('\n')) text.pop_back();
    return text;
}

void print_picture(const DeliveryOptions& options, const std::optional<LightSeen>& light) {
    if (options.png.empty() || !light) return;
    fmt::print("picture: {}, {:.1f} % of it is lit\n", options.png, 100.0 * light->picture_covered);
}

/// What is the same of patterns that stand and that move: the beginning of a JSON object.
std::string heading_json(const DeliveryOptions& options, const DisplayDescription& display,
                         const host::PatternInfo& info) {
    return fmt::format("{{\"display\": {}, \"pattern\": {}, \"moves\": {}, \"frames\": {}, \"to\": {}, \"picture\": {}",
                       json_string(display.name.view()), json_string(info.name), info.moves,
                       host::pattern_frames(display, info.pattern), json_string(options.to),
                       options.png.empty() ? "null" : json_string(options.png));
}

Expected<void> show_still(const DeliveryOptions& options, const transport::Address& address,
                          const DisplayDescription& display, const host::PatternInfo& info, io::AtomicFile* png) {
    std::vector<std::byte> frame(frame_bytes(display));
    const host::PatternLight lit = host::paint_pattern(display, info.pattern, 0, frame);
    const Expected<Delivery> delivery = deliver(options, address, display, frame, lit.pixels, png);
    if (!delivery) return tl::unexpected(delivery.error());
    const std::uint64_t slice_pixels = frame_pixels(display) / display.slices;
    if (options.json) {
        fmt::print("{}, \"pixels_lit\": {}, \"most_in_slice\": {}, \"slice_pixels\": {}, \"light\": {}}}\n",
                   heading_json(options, display, info), lit.pixels, lit.most_in_slice, slice_pixels,
                   light_json(delivery->light));
        return {};
    }
    fmt::print("{} on {}: {}\n", info.name, display.name.view(), info.summary);
    fmt::print("lit: {} pixels, at most {} of the {} of a slice\n", thousands(lit.pixels), thousands(lit.most_in_slice),
               thousands(slice_pixels));
    print_picture(options, delivery->light);
    return {};
}

Expected<void> show_moving(const DeliveryOptions& options, const transport::Address& address,
                           const DisplayDescription& display, const host::PatternInfo& info, double seconds,
                           io::AtomicFile* png) {
    const std::uint64_t frames = host::pattern_frames(display, info.pattern);
    if (!options.json) {
        fmt::print("{} on {}: {}; {} frames, once through takes {}\n", info.name, display.name.view(), info.summary,
                   thousands(frames), duration(seconds_through(display, info.pattern)));
    }
    const FrameSource source = [&](const FrameMoment& moment, std::span<std::byte> frame) {
        if (seconds == 0.0 && moment.number >= frames) return false;
        host::paint_pattern(display, info.pattern, moment.number, frame);
        return true;
    };
    const Expected<StreamDelivery> delivery = deliver_stream(options, address, display, source, seconds, png);
    if (!delivery) return tl::unexpected(delivery.error());
    if (options.json) {
        fmt::print("{}, {}, \"light\": {}}}\n", heading_json(options, display, info), stream_json(*delivery),
                   light_json(delivery->light));
        return {};
    }
    print_stream(*delivery);
    print_picture(options, delivery->light);
    return {};
}

}  // namespace

Expected<void> pattern(const PatternOptions& options) {
    const Expected<transport::Address> address = transport::parse_address(options.delivery.to);
    if (!address) return fail("--to: " + address.error().message);
    if (const auto possible = check_delivery(options.delivery, *address, ""); !possible) return possible;
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
    if (info->moves) return show_moving(options.delivery, *address, *display, *info, options.seconds, picture);
    return show_still(options.delivery, *address, *display, *info, picture);
}

}  // namespace xorvox::tools
