// plan: will a display fit its link, its scan-out, its supply and its controller?
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "driver/device/device.h"
#include "driver/device/scan_control.h"
#include "driver/display/timing.h"
#include "driver/display/toml.h"
#include "driver/host/plan.h"
#include "tools/commands.h"
#include "tools/console.h"
#include "tools/placement.h"

namespace xorvox::tools {
namespace {

/// The example is measured on as many slices as have so many samples, which takes less than a second.
constexpr std::uint64_t kMeasuredSamples = 20'000'000;

/// What a device half keeps besides its buffers.
constexpr std::uint64_t kStateBytes = sizeof(device::Device) + sizeof(device::ScanControl);

/// 5898240 as "5.9 MB", with `per` after it.
std::string bytes_text(double bytes, std::string_view per = "") {
    const char* unit = "B";
    for (const char* larger : {"kB", "MB", "GB", "TB"}) {
        if (bytes < 1000.0) break;
        bytes /= 1000.0;
        unit = larger;
    }
    return fmt::format("{:.3g} {}{}", bytes, unit, per);
}

std::string time_text(double ns) {
    const char* unit = "ns";
    for (const char* larger : {"µs", "ms", "s"}) {
        if (ns < 1000.0) break;
        ns /= 1000.0;
        unit = larger;
    }
    return fmt::format("{:.3g} {}", ns, unit);
}

std::string current_text(double ma) {
    return ma < 1000.0 ? fmt::format("{:.3g} mA", ma) : fmt::format("{:.3g} A", ma / 1000.0);
}

constexpr double kSlowestRate = 0.001;

/// "24" and "19.5", of any size.
std::string rate_text(double per_second) {
    if (per_second < kSlowestRate) return "less than 0.001";
    return per_second < 1000.0 ? fmt::format("{:.3g}", per_second) : thousands(static_cast<std::uint64_t>(per_second));
}

void line(std::string_view what, std::string_view text) {
    fmt::print("  {:<19} {}\n", what, text);
}

std::string_view fit_name(host::Fit fit) {
    switch (fit) {
        case host::Fit::Raw: return "yes";
        case host::Fit::Compressed: return "with compression";
        case host::Fit::No: break;
    }
    return "no";
}

bool scan_is_slow(const host::ScanPlan& scan) {
    return scan.planes_fit < scan.planes_shown;
}

std::string verdict(const host::Plan& plan) {
    std::string text;
    switch (plan.link.fit) {
        case host::Fit::Raw: text = "yes, it fits"; break;
        case host::Fit::Compressed: text = "with compression, as far as the example goes"; break;
        case host::Fit::No: text = "no, not at its full rate"; break;
    }
    if (scan_is_slow(plan.scan)) text += "; but its scan-out is too slow";
    if (plan.current.white_part < 1.0) text += "; all white is dimmed";
    return text;
}

void print_frame(const DisplayDescription& display, const host::Plan& plan, const host::ExampleFrames& example) {
    const host::LinkPlan& link = plan.link;
    const char* const scaled = example.measured_slices < display.slices ? "about " : "";
    fmt::print("frame\n");
    line("samples", fmt::format("{} in {} slices", thousands(plan.samples), thousands(display.slices)));
    line("voxels", fmt::format("{}: the grid of {} × {} × {} that fills its box at its pixel pitch",
                               thousands(plan.bright.voxels), plan.cartesian_size[0], plan.cartesian_size[1],
                               plan.cartesian_size[2]));
    line("raw", fmt::format("{} bytes of {}, {} with packet headers", thousands(frame_bytes(display)),
                            to_string(display.format), thousands(static_cast<std::uint64_t>(link.frame_wire_bytes))));
    const auto compressed = [&](const char* name, const host::ExampleBytes& bytes) {
        line(name, fmt::format("{}{} bytes while it turns, {} as a keyframe", scaled,
                               thousands(static_cast<std::uint64_t>(bytes.moving)),
                               thousands(static_cast<std::uint64_t>(bytes.keyframe))));
    };
    compressed("example, white", example.constant);
    compressed("example, gradient", example.gradient);
    line("", fmt::format("a ball with five lobes that fills {:.0f} % of the samples and turns 10 times a minute",
                         100.0 * example.lit));
    if (*scaled != '\0') {
        line("", fmt::format("measured on {} of {} slices", example.measured_slices, thousands(display.slices)));
    }
}

/// "98.3 % of the voxels within reach, each 1 to 79 times a frame, 5.6 on average".
std::string coverage_text(const host::SliceCoverage& light) {
    const double covered = static_cast<double>(light.covered);
    const std::string share = fmt::format("{:.3g} % of the voxels within reach, each",
                                          100.0 * covered / static_cast<double>(light.reachable));
    if (light.most_visits == 1) return share + " once a frame";
    if (light.most_visits == light.least_visits) return fmt::format("{} {} times a frame", share, light.most_visits);
    return fmt::format("{} {} to {} times a frame, {:.3g} on average", share, light.least_visits, light.most_visits,
                       static_cast<double>(light.visits) / covered);
}

void print_light(const host::Plan& plan) {
    fmt::print("light\n");
    line("bright", coverage_text(plan.bright));
    line("uniform", coverage_text(plan.uniform));
}

std::string coverage_json(const host::SliceCoverage& light) {
    return fmt::format(
        "{{\"reachable\": {}, \"covered\": {}, \"visits\": {}, \"least_visits\": {}, \"most_visits\": {}}}",
        light.reachable, light.covered, light.visits, light.least_visits, light.most_visits);
}

/// What would do where the link does not: "2.4 frames a second in rgb332, 5 in mono4, 10 in mono1", and the links that
/// carry the display as it is.
void print_way_out(const host::LinkPlan& link, const std::vector<host::FormatRate>& rates) {
    std::vector<std::string> ways;
    for (const host::FormatRate& way : rates) {
        ways.push_back(fmt::format("{}{} in {}", rate_text(way.frames_per_second),
                                   ways.empty() ? " frames a second" : "", to_string(way.format)));
    }
    if (rates.back().frames_per_second < kSlowestRate) {
        line("would work", "in no format at as much as a frame in 1000 seconds");
    } else {
        line("would work", fmt::format("{}, with compression", fmt::join(ways, ", ")));
    }
    std::vector<std::string> links;
    for (const host::LinkCeiling& other : host::link_ceilings()) {
        if (link.rate_compressed > other.bytes_per_second) continue;
        links.push_back(fmt::format("{}{}", other.name, link.rate_raw > other.bytes_per_second ? "" : " (raw)"));
    }
    line("", links.empty() ? "over none of the links at its full rate in its own format"
                           : fmt::format("at its full rate in its own format: over {}", fmt::join(links, ", ")));
}

void print_link(const DisplayDescription& display, const host::Plan& plan, const host::LinkCeiling& ceiling,
                const std::vector<host::FormatRate>& rates) {
    const host::LinkPlan& link = plan.link;
    fmt::print("link: {}, {}\n", ceiling.what, bytes_text(ceiling.bytes_per_second, "/s at best"));
    line("needed", fmt::format("{} raw, {} compressed, for {} frames a second", bytes_text(link.rate_raw, "/s"),
                               bytes_text(link.rate_compressed, "/s"), rate_text(plan.frames_per_second)));
    line("fits", fit_name(link.fit));
    line("frames a second", fmt::format("{} raw, {} compressed, at the most", rate_text(link.frames_per_second_raw),
                                        rate_text(link.frames_per_second_compressed)));
    if (link.fit == host::Fit::Raw) return;
    if (display.kind != DisplayKind::FreePoints) {
        line("slices that fit", fmt::format("{} raw, about {} compressed, of {}", thousands(link.slices_raw),
                                            thousands(link.slices_compressed), thousands(display.slices)));
    }
    std::vector<std::string_view> formats;
    for (const PixelFormat format : link.formats_raw) formats.push_back(to_string(format));
    line("formats that fit", formats.empty() ? "none raw" : fmt::format("{} raw", fmt::join(formats, ", ")));
    if (link.fit == host::Fit::No) print_way_out(link, rates);
}

void print_scan(const DisplayDescription& display, const host::ScanPlan& scan) {
    fmt::print("scan-out\n");
    const char* const of = keeps_light(display) ? "a frame" : "a slice";
    line("time", fmt::format("{} for {}", time_text(scan.slice_ns), of));
    if (scan.scan_ns == 0.0) {
        line("needed", "unknown: the display file gives no [scan] times");
    } else {
        line("needed",
             fmt::format("{} for {} bit plane{} a channel, {:.3g} % of it", time_text(scan.scan_ns), scan.planes_shown,
                         scan.planes_shown == 1 ? "" : "s", 100.0 * scan.scan_ns / scan.slice_ns));
        line("bit planes that fit", fmt::format("{} of {}", scan.planes_fit, bits_per_channel(display.format)));
        if (scan.slices_fit > 0.0) line("slices that fit", thousands(static_cast<std::uint64_t>(scan.slices_fit)));
    }
    if (scan.projector_hz > 0.0) {
        line("projector", fmt::format("{} frames a second, {} slice{} in each", rate_text(scan.projector_hz),
                                      display.scan.planes_per_frame, display.scan.planes_per_frame == 1 ? "" : "s"));
    }
}

void print_current(const host::CurrentPlan& current) {
    fmt::print("current\n");
    if (current.all_white_ma == 0.0) {
        line("all white", "unknown: the display file gives no [power] led_ma");
        return;
    }
    line("all white",
         fmt::format("{}, {} LEDs at a time", current_text(current.all_white_ma), thousands(current.lit_leds)));
    if (current.limit_ma == 0.0) {
        line("limit", "none: the display file gives no [power] limit_ma");
    } else if (current.white_part < 1.0) {
        line("limit", fmt::format("{}: {:.0f} % of the pixels white; beyond that the device dims",
                                  current_text(current.limit_ma), 100.0 * current.white_part));
    } else {
        line("limit", fmt::format("{}: never reached", current_text(current.limit_ma)));
    }
}

void print_memory(const host::MemoryPlan& memory) {
    fmt::print("memory of the device half\n");
    line("2 pages",
         fmt::format("{} bytes: pages of {}, {} for packets, about {} of state", thousands(memory.two_pages_bytes),
                     thousands(memory.page_bytes), thousands(memory.packet_bytes), thousands(memory.state_bytes)));
    line("3 pages", fmt::format("{} bytes: receives one while another waits", thousands(memory.three_pages_bytes)));
    for (const host::Controller& controller : host::common_controllers()) {
        const char* answer = "no";
        if (fits(controller, memory.two_pages_bytes)) answer = "2 pages";
        if (fits(controller, memory.three_pages_bytes)) answer = "3 pages";
        const bool small = controller.ram_bytes < 1u << 20;
        const std::string ram = fmt::format("{} {}", controller.ram_bytes >> (small ? 10 : 20), small ? "KiB" : "MiB");
        fmt::print("    {:<29} {:>8}  {}\n", controller.name, ram, answer);
    }
    line("", "a quarter of a controller's memory is left for the program");
}

void print_motion(const DisplayDescription& display, const host::MotionPlan& motion) {
    if (motion.fastest_m_per_s == 0.0) return;
    fmt::print("motion\n");
    if (motion.turns_per_second > 0.0) {
        line("turns", fmt::format("{} a second, {} rpm", rate_text(motion.turns_per_second),
                                  thousands(static_cast<std::uint64_t>(60.0 * motion.turns_per_second + 0.5))));
        line("rim", fmt::format("{:.3g} m/s at {:.0f} mm from the axis", motion.fastest_m_per_s, motion.rim_mm));
    } else {
        line("sweeps",
             fmt::format("{} up and down a second over {:.3g} mm, {:.3g} m/s where it is fastest",
                         rate_text(display.cycles_per_second), display.motion.stroke_mm, motion.fastest_m_per_s));
    }
}

std::string number(double value, bool known = true) {
    return known ? fmt::format("{:.6g}", value) : "null";
}

std::string example_json(const host::ExampleBytes& bytes) {
    return fmt::format("{{\"moving_bytes\": {:.0f}, \"keyframe_bytes\": {:.0f}}}", bytes.moving, bytes.keyframe);
}

void print_json(const DisplayDescription& display, const host::LinkCeiling& ceiling, const host::ExampleFrames& example,
                const host::Plan& plan, const std::vector<host::FormatRate>& rates) {
    const host::LinkPlan& link = plan.link;
    fmt::print(
        "{{\"display\": {}, \"verdict\": {}, \"samples\": {}, \"slices\": {}, \"format\": \"{}\",\n"
        " \"cartesian\": [{}], \"cartesian_voxels\": {}, \"frames_per_second\": {},\n",
        json_string(display.name.view()), json_string(verdict(plan)), plan.samples, display.slices,
        to_string(display.format), fmt::join(plan.cartesian_size, ", "), plan.bright.voxels,
        number(plan.frames_per_second));
    fmt::print(" \"frame_bytes\": {}, \"frame_wire_bytes\": {:.0f},\n", frame_bytes(display), link.frame_wire_bytes);
    fmt::print(" \"bright\": {}, \"uniform\": {},\n", coverage_json(plan.bright), coverage_json(plan.uniform));
    fmt::print(" \"example\": {{\"white\": {}, \"gradient\": {}, \"lit\": {}, \"measured_slices\": {}}},\n",
               example_json(example.constant), example_json(example.gradient), number(example.lit),
               example.measured_slices);
    std::vector<std::string> formats;
    for (const PixelFormat format : link.formats_raw) formats.push_back(json_string(to_string(format)));
    std::vector<std::string> ways;
    for (const host::FormatRate& way : rates) {
        ways.push_back(fmt::format("{{\"format\": {}, \"frames_per_second\": {}}}", json_string(to_string(way.format)),
                                   number(way.frames_per_second)));
    }
    fmt::print(
        " \"link\": {{\"name\": {}, \"bytes_per_second\": {}, \"fits\": \"{}\", \"needed_raw\": {}, "
        "\"needed_compressed\": {}, \"frames_per_second_raw\": {}, \"frames_per_second_compressed\": {}, "
        "\"slices_raw\": {}, \"slices_compressed\": {}, \"formats_raw\": [{}], \"would_work\": [{}]}},\n",
        json_string(ceiling.name), number(ceiling.bytes_per_second), fit_name(link.fit), number(link.rate_raw),
        number(link.rate_compressed), number(link.frames_per_second_raw), number(link.frames_per_second_compressed),
        link.slices_raw, link.slices_compressed, fmt::join(formats, ", "), fmt::join(ways, ", "));
    const host::ScanPlan& scan = plan.scan;
    const bool timed = scan.scan_ns > 0.0;
    fmt::print(
        " \"scan\": {{\"slice_ns\": {}, \"scan_ns\": {}, \"planes_shown\": {}, \"planes_fit\": {}, \"slices_fit\": {}, "
        "\"projector_hz\": {}}},\n",
        number(scan.slice_ns), number(scan.scan_ns, timed), scan.planes_shown,
        timed ? std::to_string(scan.planes_fit) : "null", number(scan.slices_fit, scan.slices_fit > 0.0),
        number(scan.projector_hz, scan.projector_hz > 0.0));
    const host::CurrentPlan& current = plan.current;
    fmt::print(" \"current\": {{\"lit_leds\": {}, \"all_white_ma\": {}, \"limit_ma\": {}, \"white_part\": {}}},\n",
               current.lit_leds, number(current.all_white_ma, current.all_white_ma > 0.0),
               number(current.limit_ma, current.limit_ma > 0.0), number(current.white_part));
    const host::MemoryPlan& memory = plan.memory;
    fmt::print(
        " \"memory\": {{\"page_bytes\": {}, \"packet_bytes\": {}, \"state_bytes\": {}, \"two_pages_bytes\": {}, "
        "\"three_pages_bytes\": {}, \"controllers\": [",
        memory.page_bytes, memory.packet_bytes, memory.state_bytes, memory.two_pages_bytes, memory.three_pages_bytes);
    const char* separator = "";
    for (const host::Controller& controller : host::common_controllers()) {
        const int pages = fits(controller, memory.three_pages_bytes) ? 3
                          : fits(controller, memory.two_pages_bytes) ? 2
                                                                     : 0;
        fmt::print("{}{{\"name\": {}, \"ram_bytes\": {}, \"pages\": {}}}", separator, json_string(controller.name),
                   controller.ram_bytes, pages);
        separator = ", ";
    }
    const host::MotionPlan& motion = plan.motion;
    fmt::print("]}},\n \"motion\": {{\"turns_per_second\": {}, \"rim_mm\": {}, \"fastest_m_per_s\": {}}}}}\n",
               number(motion.turns_per_second), number(motion.rim_mm), number(motion.fastest_m_per_s));
}

}  // namespace

Expected<void> plan(const PlanOptions& options) {
    const Expected<host::LinkCeiling> ceiling = host::find_link(options.link, options.gpio_rate_hz);
    if (!ceiling) return tl::unexpected(ceiling.error());
    const Expected<DisplayFile> display = load_display(options.display);
    if (!display) return tl::unexpected(display.error());
    const Expected<host::ExampleFrames> example = host::measure_example(*display, kMeasuredSamples);
    if (!example) return fail(options.display + ": " + example.error().message);
    const host::Plan plan = host::make_plan(*display, *ceiling, *example, kStateBytes);
    std::vector<host::FormatRate> rates;
    if (plan.link.fit == host::Fit::No) {
        Expected<std::vector<host::FormatRate>> measured = host::compressed_rates(*display, *ceiling, kMeasuredSamples);
        if (!measured) return fail(options.display + ": " + measured.error().message);
        rates = std::move(*measured);
    }
    if (options.json) {
        print_json(*display, *ceiling, *example, plan, rates);
        return {};
    }
    fmt::print("{} over {}: {}\n\n", display->name.view(), ceiling->name, verdict(plan));
    print_frame(*display, plan, *example);
    print_light(plan);
    print_link(*display, plan, *ceiling, rates);
    print_scan(*display, plan.scan);
    print_current(plan.current);
    print_memory(plan.memory);
    print_motion(*display, plan.motion);
    return {};
}

}  // namespace xorvox::tools
