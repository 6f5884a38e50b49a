// bench displays: the way of a frame against the time that a display gives it, and what resampling costs and spoils.
#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdio>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "driver/display/lattice.h"
#include "driver/display/toml.h"
#include "driver/host/encoder.h"
#include "driver/host/slice_map.h"
#include "driver/wire/messages.h"
#include "tools/commands.h"
#include "tools/console.h"
#include "tools/frame_maker.h"
#include "tools/mesh_content.h"
#include "tools/mesh_input.h"
#include "tools/placement.h"

namespace xorvox::tools {
namespace {

using Clock = std::chrono::steady_clock;

/// Displays of more samples are measured with two threads as well, and with fewer frames.
constexpr std::size_t kLarge = 10'000'000;
constexpr double kTurnAFrame = 1.0 / 97.0;

/// Medians of one frame's steps, in milliseconds.
struct Steps {
    double voxelize_ms = 0.0;
    double paint_ms = 0.0;
    double encode_ms = 0.0;
    std::size_t bytes = 0;  ///< Of the packets of the last frame.

    double total_ms() const { return voxelize_ms + paint_ms + encode_ms; }
};

/// What a Cartesian volume makes of the same mesh.
struct Resampling {
    double million_samples_a_second = 0.0;
    std::size_t inside = 0;
    bool copied = false;    ///< The display is its own Cartesian volume.
    std::size_t wrong = 0;  ///< Samples that are not what they are when voxelized on the display's own lattice.
};

struct Measured {
    std::string name;
    std::size_t samples = 0;
    double budget_ms = 0.0;
    Steps one;
    std::optional<Steps> two;  ///< With two threads.
    Resampling resampling;
};

double since_ms(Clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

glm::dmat4 turned(double turns) {
    return glm::rotate(glm::dmat4(1.0), 2.0 * std::numbers::pi * turns, {0.0, 0.0, 1.0});
}

/// `mesh`, fitted into `display`.
Expected<std::unique_ptr<MeshContent>> place(const Mesh& mesh, const std::string& source,
                                             const DisplayDescription& display, unsigned threads) {
    std::vector<NamedScene> scenes(1);
    scenes.front().scene.mesh = mesh;
    scenes.front().source = source;
    return MeshContent::make(std::move(scenes), 0, display, Turning::Upright, 0.0, threads);
}

/// A frame's payloads as whole packets, as they go to the link. Their bytes.
std::size_t make_packets(const host::FrameEncoder& encoder, std::vector<std::byte>& packet) {
    std::size_t bytes = 0;
    for (std::size_t i = 0; i < encoder.payload_count(); ++i) {
        const host::Payload payload = encoder.payload(i);
        std::size_t size = 0;
        const wire::Header header{.type = payload.type, .session = 1, .sequence = static_cast<std::uint32_t>(i)};
        if (wire::encode_packet(header, payload.bytes, packet, size) == Status::Ok) bytes += size;
    }
    return bytes;
}

Expected<Steps> measure_frames(const DisplayDescription& display, const Mesh& mesh, const std::string& source,
                               unsigned threads, int frames) {
    const auto color = host::parse_color("constant:white");
    if (!color) return tl::unexpected(color.error());
    FrameMakerOptions options;
    options.threads = threads;
    auto content = place(mesh, source, display, threads);
    if (!content) return tl::unexpected(content.error());
    const auto maker = FrameMaker::make(display, **content, color->get(), options);
    if (!maker) return tl::unexpected(maker.error());
    host::FrameEncoder encoder({.max_packet_bytes = wire::kMaxPacketBytes, .lz4 = true});
    std::vector<std::byte> packet(wire::kMaxPacketBytes);
    std::vector<std::byte> frame(frame_bytes(display));
    std::vector<std::byte> base;
    std::vector<double> voxelize, paint, encode;
    Steps steps;
    // The first frames touch memory for the first time.
    for (int number = -2; number < frames; ++number) {
        const auto begin = Clock::now();
        if (const auto made = (*maker)->draw(0.0, turned(number * kTurnAFrame)); !made)
            return tl::unexpected(made.error());
        const double voxelized = since_ms(begin);
        if (const auto made = (*maker)->paint(frame); !made) return tl::unexpected(made.error());
        const double painted = since_ms(begin);
        encoder.encode({.id = static_cast<std::uint32_t>(number + 3),
                        .content = frame,
                        .present_at_ns = 0,
                        .base_id = static_cast<std::uint32_t>(number + 2),
                        .base = base});
        steps.bytes = make_packets(encoder, packet);
        const double encoded = since_ms(begin);
        base.assign(frame.begin(), frame.end());
        if (number < 0) continue;
        voxelize.push_back(voxelized);
        paint.push_back(painted - voxelized);
        encode.push_back(encoded - painted);
    }
    steps.voxelize_ms = median(voxelize);
    steps.paint_ms = median(paint);
    steps.encode_ms = median(encode);
    return steps;
}

Expected<Resampling> measure_resampling(const DisplayDescription& display, const Mesh& mesh, const std::string& source,
                                        int runs) {
    const auto color = host::parse_color("constant:white");
    if (!color) return tl::unexpected(color.error());
    FrameMakerOptions options;
    auto content = place(mesh, source, display, 1);
    if (!content) return tl::unexpected(content.error());
    const auto native = FrameMaker::make(display, **content, color->get(), options);
    if (!native) return tl::unexpected(native.error());
    if (const auto made = (*native)->draw(); !made) return tl::unexpected(made.error());
    options.resampled = true;
    const auto resampled = FrameMaker::make(display, **content, color->get(), options);
    if (!resampled) return tl::unexpected(resampled.error());
    if (const auto made = (*resampled)->draw(); !made) return tl::unexpected(made.error());

    Resampling result;
    result.inside = (*native)->volume().count();
    const auto right = (*native)->volume().view().words;
    const auto found = (*resampled)->volume().view().words;
    for (std::size_t i = 0; i < right.size(); ++i) {
        result.wrong += static_cast<std::size_t>(std::popcount(right[i] ^ found[i]));
    }
    const DisplayLattice lattice(display);
    const host::SliceMap map(display, lattice);
    const BitVolume volume(map.grid());
    result.copied = lattice.view().is_regular();
    BitVolume samples(lattice.view());
    std::vector<double> times;
    for (int run = 0; run < runs; ++run) {
        const auto begin = Clock::now();
        if (map.sample(volume.view(), samples.view()) != Status::Ok) return fail("resampling failed");
        times.push_back(since_ms(begin));
    }
    result.million_samples_a_second = static_cast<double>(lattice.view().sample_count()) / median(times) / 1e3;
    return result;
}

Expected<Measured> measure(const std::string& name, const Mesh& mesh, const BenchDisplayOptions& options) {
    const Expected<DisplayFile> display = load_display(name);
    if (!display) return tl::unexpected(display.error());
    if (const auto fits = check_display_fits(*display); !fits) return tl::unexpected(fits.error());
    Measured measured;
    measured.name = display->name.view();
    measured.samples = frame_pixels(*display);
    measured.budget_ms = 1e3 / display->cycles_per_second;
    const Progress progress("measuring " + measured.name);
    const bool large = measured.samples > kLarge;
    const int frames = options.quick ? 3 : large ? 9 : 101;
    const auto one = measure_frames(*display, mesh, options.mesh, 1, frames);
    if (!one) return tl::unexpected(one.error());
    measured.one = *one;
    if (large) {
        const auto two = measure_frames(*display, mesh, options.mesh, 2, frames);
        if (!two) return tl::unexpected(two.error());
        measured.two = *two;
    }
    const auto resampling = measure_resampling(*display, mesh, options.mesh, options.quick ? 3 : large ? 5 : 51);
    if (!resampling) return tl::unexpected(resampling.error());
    measured.resampling = *resampling;
    return measured;
}

void print_steps(const Measured& m, const Steps& steps, unsigned threads) {
    fmt::print("{:<15}{:>7}{:>10.2f}{:>10.2f}{:>10.2f}{:>10.2f}{:>10.1f}{:>12}\n", m.name, threads, steps.voxelize_ms,
               steps.paint_ms, steps.encode_ms, m.budget_ms, m.budget_ms / steps.total_ms(), thousands(steps.bytes));
}

void print_text(const std::vector<Measured>& all) {
    fmt::print(
        "A frame, from the mesh that turned to its packets, in milliseconds; headroom is budget ÷ all three steps\n\n");
    fmt::print("{:<15}{:>7}{:>10}{:>10}{:>10}{:>10}{:>10}{:>12}\n", "display", "threads", "voxelize", "paint", "encode",
               "budget", "headroom", "bytes sent");
    for (const Measured& m : all) {
        print_steps(m, m.one, 1);
        if (m.two) print_steps(m, *m.two, 2);
    }
    fmt::print("\nThe same mesh voxelized on a grid of cubes first, and sampled from it\n\n");
    fmt::print("{:<15}{:>14}{:>14}{:>14}{:>14}{:>18}\n", "display", "samples", "inside", "wrong", "wrong/inside",
               "million samples/s");
    for (const Measured& m : all) {
        const double share = m.resampling.inside == 0
                                 ? 0.0
                                 : static_cast<double>(m.resampling.wrong) / static_cast<double>(m.resampling.inside);
        const std::string speed =
            m.resampling.copied ? "copied" : fmt::format("{:.0f}", m.resampling.million_samples_a_second);
        fmt::print("{:<15}{:>14}{:>14}{:>14}{:>13.2f}%{:>18}\n", m.name, thousands(m.samples),
                   thousands(m.resampling.inside), thousands(m.resampling.wrong), 100.0 * share, speed);
    }
}

std::string steps_json(const Measured& m, const Steps& steps) {
    return fmt::format(
        "{{\"voxelize_ms\": {:.6g}, \"paint_ms\": {:.6g}, \"encode_ms\": {:.6g}, \"headroom\": {:.6g}, \"bytes_sent\": "
        "{}}}",
        steps.voxelize_ms, steps.paint_ms, steps.encode_ms, m.budget_ms / steps.total_ms(), steps.bytes);
}

void print_json(const std::vector<Measured>& all) {
    const char* separator = "";
    fmt::print("[");
    for (const Measured& m : all) {
        fmt::print(
            "{}\n  {{\"display\": {}, \"samples\": {}, \"budget_ms\": {:.6g}, \"one_thread\": {}, \"two_threads\": {}, "
            "\"resampling\": {{\"inside\": {}, \"wrong\": {}, \"samples_per_second\": {}}}}}",
            separator, json_string(m.name), m.samples, m.budget_ms, steps_json(m, m.one),
            m.two ? steps_json(m, *m.two) : "null", m.resampling.inside, m.resampling.wrong,
            m.resampling.copied ? "null" : fmt::format("{:.6g}", 1e6 * m.resampling.million_samples_a_second));
        separator = ",";
    }
    fmt::print("\n]\n");
}

}  // namespace

Expected<void> bench_displays(const BenchDisplayOptions& options) {
    MeshOptions mesh_options;
    mesh_options.path = options.mesh;
    const Expected<MeshInput> input = read_solid(mesh_options);
    if (!input) return tl::unexpected(input.error());
    std::vector<std::string> names = options.displays;
    if (names.empty()) {
        for (const Preset& preset : presets()) names.emplace_back(preset.name);
    }
    std::vector<Measured> all;
    for (const std::string& name : names) {
        const auto measured = measure(name, input->mesh, options);
        if (!measured) return tl::unexpected(measured.error());
        all.push_back(*measured);
    }
    (options.json ? print_json : print_text)(all);
    return {};
}

}  // namespace xorvox::tools
