// Whatever bytes a timeline is: it is read or refused, and what is read gives a pose at every moment.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "driver/host/timeline.h"

using namespace xorvox::host;

namespace {

void require_poses(const Timeline& timeline) {
    for (const double seconds : {0.0, 0.5, 1.0, timeline.duration_seconds(), 1e6}) {
        const glm::dmat4 pose = pose_at(timeline, seconds, {1.0, 2.0, 3.0});
        for (int column = 0; column < 4; ++column) {
            for (int row = 0; row < 4; ++row) {
                if (!std::isfinite(pose[column][row])) std::abort();
            }
        }
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    if (const auto timeline = parse_timeline(text, "fuzz")) require_poses(*timeline);
    for (const TrackKind kind : {TrackKind::Motion, TrackKind::Camera}) {
        const auto track = parse_track(text, kind);
        if (!track) continue;
        Timeline timeline;
        (kind == TrackKind::Motion ? timeline.motion : timeline.camera) = *track;
        require_poses(timeline);
    }
    return 0;
}
