#include "tools/stage.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "tools/color_choice.h"
#include "tools/console.h"
#include "tools/mesh_content.h"
#include "tools/mesh_input.h"
#include "tools/volume_content.h"
#include "tools/volume_input.h"
#include "voxelizer/io/file_name.h"
#include "voxelizer/io/volume_reader.h"

namespace xorvox::tools {
namespace {

/// To begin them takes longer than a small frame.
unsigned threads_for(const DisplayDescription& display) {
    constexpr std::size_t kSmall = 500'000;
    constexpr unsigned kMost = 16;
    return frame_pixels(display) < kSmall ? 1 : std::clamp(std::thread::hardware_concurrency(), 1u, kMost);
}

/// All files that are named.
std::vector<std::string> paths(const StageOptions& options) {
    std::vector<std::string> all{options.mesh.path};
    all.insert(all.end(), options.following.begin(), options.following.end());
    return all;
}

/// Whether all files are of one kind, and the options for that kind.
Expected<void> check_kind(const StageOptions& options) {
    const std::string first = io::printable_name(options.mesh.path);
    const bool volumes = io::is_volume_path(options.mesh.path);
    for (const std::string& path : options.following) {
        if (io::is_volume_path(path) == volumes) continue;
        return fail(fmt::format("{} is a {} and {} is a {}; a sequence has one kind", first,
                                volumes ? "volume" : "mesh", io::printable_name(path), volumes ? "mesh" : "volume"));
    }
    const MeshOptions& mesh = options.mesh;
    if (volumes && (!mesh.unit.empty() || !mesh.up.empty() || mesh.strict || !options.animation.empty())) {
        return fail(
            fmt::format("--unit, --up, --strict and --animation are for meshes, and {} is a volume; leave them "
                        "away",
                        first));
    }
    if (!volumes && (options.volume.threshold || options.volume.frame || options.volume.transfer)) {
        return fail(
            fmt::format("--threshold, --transfer and --volume are for volumes, and {} is a mesh; leave them "
                        "away",
                        first));
    }
    if (!options.animation.empty() && !options.following.empty()) {
        return fail("--animation is for one file alone; of several each is shown as it stands");
    }
    return {};
}

Expected<std::unique_ptr<Content>> read_volumes(const StageOptions& options, const DisplayDescription& display,
                                                Turning turning) {
    Expected<VolumeInput> input = read_volume_input(paths(options), options.volume);
    if (!input) return tl::unexpected(input.error());
    if (input->threshold_found) warn(io::printable_name(options.mesh.path) + ": " + describe_threshold(*input));
    return VolumeContent::make(std::move(*input), options.mesh.path, display, turning, 1.0 / options.files_per_second,
                               threads_for(display));
}

/// The animation that is meant, by its name or number, counted from 0; the first one without either.
Expected<std::size_t> choose_animation(const io::Scene& scene, const std::string& name, const std::string& path) {
    if (name.empty()) return std::size_t{0};
    const std::span<const io::SceneAnimation> animations =
        scene.motion ? scene.motion->animations() : std::span<const io::SceneAnimation>();
    std::string known;
    for (std::size_t i = 0; i < animations.size(); ++i) {
        if (name == animations[i].name || name == std::to_string(i)) return i;
        known += fmt::format("{}{} {}", known.empty() ? "" : ", ", i, io::printable_name(animations[i].name));
    }
    return fail(fmt::format("--animation: {} has no \"{}\"; it has {}", io::printable_name(path),
                            io::printable_name(name), known.empty() ? "none" : known));
}

Expected<std::unique_ptr<Content>> read_meshes(const StageOptions& options, const DisplayDescription& display,
                                               Turning turning) {
    std::vector<NamedScene> scenes;
    MeshOptions mesh = options.mesh;
    for (const std::string& path : paths(options)) {
        mesh.path = path;
        Expected<SceneInput> input = read_solid_scene(mesh);
        if (!input) return tl::unexpected(input.error());
        if (!input->scene.colors_fault.empty() && options.color == "own")
            return fail("--color: own: " + input->scene.colors_fault);
        if (!input->scene.colors_fault.empty() && options.color.empty())
            warn(input->scene.colors_fault + "; it is shown in a gradient");
        scenes.push_back({std::move(input->scene), path});
    }
    const auto animation = choose_animation(scenes.front().scene, options.animation, options.mesh.path);
    if (!animation) return tl::unexpected(animation.error());
    auto content = MeshContent::make(std::move(scenes), *animation, display, turning, 1.0 / options.files_per_second,
                                     threads_for(display));
    if (!content) return tl::unexpected(content.error());
    return std::move(*content);
}

Expected<std::unique_ptr<Content>> read_content(const StageOptions& options, const DisplayDescription& display,
                                                Turning turning) {
    return io::is_volume_path(options.mesh.path) ? read_volumes(options, display, turning)
                                                 : read_meshes(options, display, turning);
}

}  // namespace

Expected<std::unique_ptr<Stage>> set_stage(const StageOptions& options, Turning turning) {
    auto stage = std::make_unique<Stage>();
    const DeliveryOptions& to = options.delivery;
    Expected<transport::Address> address = transport::parse_address(to.to);
    if (!address) return fail("--to: " + address.error().message);
    stage->address = std::move(*address);
    if (const auto possible = check_delivery(to, stage->address, options.mesh.path); !possible) {
        return tl::unexpected(possible.error());
    }
    if (const auto one = check_kind(options); !one) return tl::unexpected(one.error());
    Expected<DisplayFile> display = load_display(options.display);
    if (!display) return tl::unexpected(display.error());
    stage->display = std::move(*display);
    const Expected<ChosenLight> light = choose_light(options.light, stage->display);
    if (!light) return tl::unexpected(light.error());
    auto color = choose_color(options.color.empty() ? "own" : options.color);
    if (!color) return fail("--color: " + color.error().message);
    stage->color = std::move(*color);
    if (const auto fits = check_display_fits(stage->display); !fits) return tl::unexpected(fits.error());
    if (!to.png.empty()) {
        Expected<io::AtomicFile> file = io::AtomicFile::create(to.png);
        if (!file) return tl::unexpected(file.error());
        stage->png = std::move(*file);
    }
    auto recording = make_recording(to, stage->display);
    if (!recording) return tl::unexpected(recording.error());
    stage->recording = std::move(*recording);
    auto content = read_content(options, stage->display, turning);
    if (!content) return tl::unexpected(content.error());
    stage->content = std::move(*content);
    if (stage->color == nullptr && !stage->content->has_own_color()) {
        if (!options.color.empty()) {
            return fail(fmt::format(
                "--color: own: {} has no colours of its own",
                options.following.empty() ? io::printable_name(options.mesh.path) : std::string("one of the files")));
        }
        stage->color = std::move(*host::parse_color("gradient"));
    }
    auto maker = FrameMaker::make(stage->display, *stage->content, stage->color.get(),
                                  {.light = light->settings,
                                   .resampled = options.sampling == "cartesian",
                                   .threads = threads_for(stage->display)});
    if (!maker) return tl::unexpected(maker.error());
    stage->maker = std::move(*maker);
    return stage;
}

void print_light(const StageOptions& options, const Stage& stage, const std::optional<LightSeen>& light) {
    if (stage.maker->dimmed_to() != 1.0f) {
        fmt::print("light: dimmed to {:.0f} %, so that it draws no more than the {:g} mA of the display's supply\n",
                   100.0f * stage.maker->dimmed_to(), stage.display.power.limit_ma);
    }
    if (!light) return;
    const sim::Statistics& seen = light->statistics;
    fmt::print("lit: {} pixels at {} places, {} outside the display\n", thousands(seen.pixels_lit),
               thousands(seen.voxels_lit), thousands(seen.light_outside));
    // In uniform light most samples near an axis are left out, and those that are lit stand for more than their own
    // space.
    if (seen.voxels_lit > 0 && options.light.mode == "bright") {
        fmt::print("brightness: the densest light is {:.3g} times the thinnest\n", seen.brightness_ratio);
    }
    if (options.light.mode == "uniform") {
        fmt::print("brightness: even; of the samples inside, each voxel has one lit for each panel that passes it\n");
    }
    if (options.light.mode == "even") {
        fmt::print("brightness: even; each sample is as bright as the space it stands for is large\n");
    }
    print_in_time(options.delivery.simulation, light->in_time);
    if (!options.delivery.png.empty()) {
        fmt::print("picture: {}, {:.0f} % of it is the object\n", options.delivery.png, 100.0 * light->picture_covered);
    }
}

std::string stage_json(const StageOptions& options, const Stage& stage, std::size_t inside) {
    return fmt::format(
        "\"mesh\": {}, \"display\": {}, \"to\": {}, \"samples\": {}, \"inside\": {}, \"light_settings\": {}, "
        "\"dimmed_to\": {:.4f}",
        json_string(options.mesh.path), json_string(stage.display.name.view()), json_string(options.delivery.to),
        frame_pixels(stage.display), inside, light_settings_json(options.light), stage.maker->dimmed_to());
}

}  // namespace xorvox::tools
