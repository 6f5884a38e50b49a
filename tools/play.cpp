// play: what moves, as a stream of frames at the display's own rate.
#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "driver/display/lattice.h"
#include "driver/host/timeline.h"
#include "tools/commands.h"
#include "tools/console.h"
#include "tools/stage.h"
#include "tools/stream.h"
#include "voxelizer/io/file_name.h"

namespace xorvox::tools {
namespace {

Expected<host::Timeline> read_timeline(const std::string& path) {
    const std::string name = io::printable_name(path);
    std::ifstream file(path, std::ios::binary);
    if (!file) return fail(fmt::format("--timeline: {}: it cannot be opened", name));
    std::string text(std::size_t{1} << 21, '\0');
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (file.bad() || (file.fail() && !file.eof())) return fail(fmt::format("--timeline: {}: it cannot be read", name));
    text.resize(static_cast<std::size_t>(file.gcount()));
    return host::parse_timeline(text, name);
}

/// What moves, from a file or as typed.
Expected<host::Timeline> choose_timeline(const PlayOptions& options) {
    host::Timeline timeline;
    if (!options.timeline.empty()) {
        Expected<host::Timeline> read = read_timeline(options.timeline);
        if (!read) return read;
        timeline = std::move(*read);
    }
    const auto read_track = [](const std::string& name, const std::string& text, host::TrackKind kind,
                               std::vector<host::Keyframe>& track) -> Expected<void> {
        if (text.empty()) return {};
        auto read = host::parse_track(text, kind);
        if (!read) return fail(name + ": " + read.error().message);
        track = std::move(*read);
        return {};
    };
    if (auto read = read_track("--motion", options.motion, host::TrackKind::Motion, timeline.motion); !read) {
        return tl::unexpected(read.error());
    }
    if (auto read = read_track("--camera", options.camera, host::TrackKind::Camera, timeline.camera); !read) {
        return tl::unexpected(read.error());
    }
    timeline.loop = timeline.loop || options.loop;
    return timeline;
}

/// How the model turns: by spinning, and by the keyframes of its motion. A camera shows what it will.
Turning turning_of(const PlayOptions& options, const host::Timeline& timeline) {
    Turning turning = options.spin_rpm ? Turning::Upright : Turning::Not;
    for (const host::Keyframe& key : timeline.motion) {
        if (key.turn_deg.x != 0.0 || key.turn_deg.y != 0.0) return Turning::Anyhow;
        if (key.turn_deg.z != 0.0) turning = Turning::Upright;
    }
    return turning;
}

/// How long to play: as told; else as long as everything lasts; 0: until interrupted.
Expected<double> choose_seconds(const PlayOptions& options, const host::Timeline& timeline, const Stage& stage) {
    if (options.seconds) return *options.seconds;
    if (options.frames > 0) return 0.0;
    const double content = stage.content->duration_seconds();
    const double keys = timeline.moves() ? timeline.duration_seconds() : 0.0;
    const bool forever = timeline.loop || (options.spin_rpm && content == 0.0 && keys == 0.0);
    if (!forever) {
        if (content == 0.0 && keys == 0.0) {
            return fail(
                "nothing moves; give --spin, --motion, --camera or --timeline, several files, or a file with an "
                "animation (or xorvox show for a still one)");
        }
        return std::max(content, keys);
    }
    if (stage.address.kind == transport::AddressKind::Tcp) return 0.0;
    return fail(fmt::format("{} never ends; say how long with --seconds", timeline.loop ? "a loop" : "spinning"));
}

}  // namespace

Expected<void> play(const PlayOptions& options) {
    const Expected<host::Timeline> timeline = choose_timeline(options);
    if (!timeline) return tl::unexpected(timeline.error());
    const auto set = set_stage(options.stage, turning_of(options, *timeline));
    if (!set) return tl::unexpected(set.error());
    Stage& stage = **set;
    const Expected<double> seconds = choose_seconds(options, *timeline, stage);
    if (!seconds) return tl::unexpected(seconds.error());

    const DisplayExtent room = extent(stage.display);
    const glm::dvec3 middle = (room.lower + room.upper) / 2.0;
    std::optional<Error> broken;
    const FrameSource source = [&](const FrameMoment& moment, std::span<std::byte> frame) {
        if (options.frames > 0 && moment.number >= options.frames) return false;
        // What is recorded does not depend on when the display could show it.
        const double at_s =
            options.frames > 0 ? static_cast<double>(moment.number) / stage.display.cycles_per_second : moment.seconds;
        glm::dmat4 pose = host::pose_at(*timeline, at_s, middle);
        if (options.spin_rpm) {
            const double angle = glm::radians(at_s * *options.spin_rpm * 6.0);
            const glm::dmat4 one(1.0);
            pose *=
                glm::translate(one, middle) * glm::rotate(one, angle, {0.0, 0.0, 1.0}) * glm::translate(one, -middle);
        }
        Expected<void> made = stage.maker->draw(at_s, pose);
        if (made) made = stage.maker->paint(frame, static_cast<std::uint32_t>(moment.number));
        if (!made) broken = made.error();
        return made.has_value();
    };
    const DeliveryOptions& to = options.stage.delivery;
    const Expected<StreamDelivery> delivery =
        deliver_stream(to, stage.address, stage.display, source, *seconds, stage.picture(), stage.recorder());
    if (broken) return tl::unexpected(*broken);
    if (!delivery) return tl::unexpected(delivery.error());
    const std::size_t voxels = stage.maker->volume().count();
    if (to.json) {
        fmt::print("{{{}, \"two_way\": {}, {}, {}}}\n", stage_json(options.stage, stage, voxels),
                   stage.address.kind != transport::AddressKind::File, stream_json(*delivery),
                   picture_json(to, delivery->light));
    } else {
        fmt::print("{}: {} of {} samples were inside at the end\n", stage.display.name.view(), thousands(voxels),
                   thousands(frame_pixels(stage.display)));
        print_stream(*delivery);
        print_light(options.stage, stage, delivery->light);
    }
    if (const auto kept = finish_recording(to, stage.recorder()); !kept) return kept;
    return delivery->broken ? Expected<void>(tl::unexpected(*delivery->broken)) : Expected<void>();
}

}  // namespace xorvox::tools
