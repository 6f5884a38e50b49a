#include "driver/host/timeline.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>

namespace xorvox::host {
namespace {

glm::dmat4 turned(const glm::dvec3& turn_deg) {
    constexpr double kRadians = std::numbers::pi / 180.0;
    glm::dmat4 turn(1.0);
    turn = glm::rotate(turn, turn_deg.z * kRadians, {0.0, 0.0, 1.0});
    turn = glm::rotate(turn, turn_deg.y * kRadians, {0.0, 1.0, 0.0});
    return glm::rotate(turn, turn_deg.x * kRadians, {1.0, 0.0, 0.0});
}

/// The change of a value a second at keyframe `k` of a curve (Catmull and Rom 1974): as between the keyframes beside
/// it, so that short intervals cannot throw it far off.
template <class Value>
auto slope(std::span<const Keyframe> track, std::size_t k, Value value) {
    const Keyframe& before = track[k == 0 ? k : k - 1];
    const Keyframe& after = track[k + 1 == track.size() ? k : k + 1];
    return (value(after) - value(before)) / (after.at_seconds - before.at_seconds);
}

/// What `value` takes of a keyframe, at the part u of the way from keyframe k - 1 to k.
template <class Value>
auto interpolate(std::span<const Keyframe> track, std::size_t k, double u, Value value) {
    const auto from = value(track[k - 1]);
    const auto to = value(track[k]);
    switch (track[k].ease) {
        case Ease::Step: return u < 1.0 ? from : to;
        case Ease::Smooth: u = u * u * (3.0 - 2.0 * u); break;
        case Ease::Curve: {
            // Hermite's cubic.
            const double span = track[k].at_seconds - track[k - 1].at_seconds;
            const double u2 = u * u;
            const double u3 = u2 * u;
            return from * (2.0 * u3 - 3.0 * u2 + 1.0) + to * (3.0 * u2 - 2.0 * u3) +
                   slope(track, k - 1, value) * (span * (u3 - 2.0 * u2 + u)) +
                   slope(track, k, value) * (span * (u3 - u2));
        }
        case Ease::Linear: break;
    }
    return from + (to - from) * u;
}

}  // namespace

double Timeline::duration_seconds() const {
    if (seconds > 0.0) return seconds;
    double last = 0.0;
    if (!motion.empty()) last = motion.back().at_seconds;
    if (!camera.empty()) last = std::max(last, camera.back().at_seconds);
    return last;
}

Keyframe frame_at(std::span<const Keyframe> track, double seconds) {
    if (track.empty()) return {};
    const auto next = std::ranges::upper_bound(track, seconds, {}, &Keyframe::at_seconds);
    if (next == track.begin()) return track.front();
    if (next == track.end()) return track.back();
    const auto k = static_cast<std::size_t>(std::distance(track.begin(), next));
    const double from = track[k - 1].at_seconds;
    const double u = (seconds - from) / (track[k].at_seconds - from);
    Keyframe frame;
    frame.at_seconds = seconds;
    frame.ease = track[k].ease;
    frame.place_mm = interpolate(track, k, u, [](const Keyframe& key) { return key.place_mm; });
    frame.turn_deg = interpolate(track, k, u, [](const Keyframe& key) { return key.turn_deg; });
    // Sizes multiply: half way from 1 to 4 is 2. So a curve cannot swing below zero either.
    frame.size = std::exp(interpolate(track, k, u, [](const Keyframe& key) { return std::log(key.size); }));
    return frame;
}

glm::dmat4 pose_at(const Timeline& timeline, double seconds, const glm::dvec3& middle_mm) {
    const double duration = timeline.duration_seconds();
    if (duration > 0.0) seconds = timeline.loop ? std::fmod(seconds, duration) : std::min(seconds, duration);
    const Keyframe motion = frame_at(timeline.motion, seconds);
    const Keyframe camera = frame_at(timeline.camera, seconds);
    const glm::dmat4 one(1.0);
    const glm::dmat4 moved =
        glm::translate(one, motion.place_mm) * turned(motion.turn_deg) * glm::scale(one, glm::dvec3(motion.size));
    const glm::dmat4 seen = glm::scale(one, glm::dvec3(camera.size)) * glm::transpose(turned(camera.turn_deg)) *
                            glm::translate(one, -camera.place_mm);
    return glm::translate(one, middle_mm) * seen * moved * glm::translate(one, -middle_mm);
}

}  // namespace xorvox::host
