// Timeline: how a model moves in front of the display, and how the display moves through the scene.
//
// Two tracks of keyframes, each a place, a turn and a size that change with time. p is a point of the fitted model in
// the display's millimetres, m the middle of the display's box:
//
//   motion   the model is scaled and turned about m, then moved:        q = m + move + turn · (scale · (p − m))
//   camera   the display stands at `center` in the scene, turned, and shows what is there, magnified:
//                                                     what is shown  = m + turn⁻¹ · (zoom · (q − m − center))
//
// A turn is three angles, about x first, then y, then z, the axes standing still. Angles are numbers like any other:
// from 0 to 720 is two turns. docs/play.md shows both ways to write a timeline.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "voxelizer/error.h"

namespace xorvox::host {

/// How a keyframe is reached from the one before.
enum class Ease : std::uint8_t {
    Linear,  ///< Evenly.
    Smooth,  ///< From rest to rest.
    Curve,   ///< On a smooth curve through the keyframes beside it, without a stop.
    Step     ///< At once, when its time has come.
};

/// What a track says for a moment.
struct Keyframe {
    static constexpr double kMostSeconds = 1e6;
    static constexpr double kMostPlace_mm = 1e6;
    static constexpr double kMostTurn_deg = 1e6;
    static constexpr double kLeastSize = 1e-3;
    static constexpr double kMostSize = 100.0;

    double at_seconds = 0.0;   ///< 0 … kMostSeconds.
    glm::dvec3 place_mm{0.0};  ///< move, or center; within ±kMostPlace_mm.
    glm::dvec3 turn_deg{0.0};  ///< Within ±kMostTurn_deg.
    double size = 1.0;         ///< scale, or zoom; kLeastSize … kMostSize.
    Ease ease = Ease::Linear;
};

/// What a timeline holds; parse_timeline() and parse_track() keep the ranges.
struct Timeline {
    static constexpr std::size_t kMostKeys = 4096;

    std::vector<Keyframe> motion;  ///< Times increase; empty: the model stands still.
    std::vector<Keyframe> camera;  ///< The same; empty: the display stands still.
    double seconds = 0.0;          ///< How long it lasts; 0: until the last keyframe.
    bool loop = false;             ///< Whether it begins anew then; else it stays as it is at its end.

    /// `seconds`, or the time of the last keyframe.
    double duration_seconds() const;
    /// Whether anything moves.
    bool moves() const { return motion.size() > 1 || camera.size() > 1; }
};

/// The track's keyframe for the time `seconds`, between those that it has: before the first one that, after the last
/// one that. An empty track: Keyframe{}.
Keyframe frame_at(std::span<const Keyframe> track, double seconds);

/// What moves a point of the fitted model to where it is shown, `seconds` after the beginning. `middle_mm`: m of the
/// drawing.
glm::dmat4 pose_at(const Timeline& timeline, double seconds, const glm::dvec3& middle_mm);

/// Reads a timeline file, TOML; docs/play.md has its keys. Errors name `source`, the line, what was found and what is
/// allowed. At most 1 MiB.
Expected<Timeline> parse_timeline(std::string_view toml, std::string_view source);

enum class TrackKind : std::uint8_t { Motion, Camera };

/// Reads a track as it is typed on a command line: keyframes with a semicolon between them, in each `name=value` with
/// blanks between them. at=SECONDS, turn=X,Y,Z, ease=linear|smooth|curve|step, and of a motion move=X,Y,Z, scale=S, of
/// a camera center=X,Y,Z, zoom=S. What a keyframe does not name is as in the one before.
///
///     at=0; at=4 turn=0,0,360 move=0,0,10 ease=smooth
Expected<std::vector<Keyframe>> parse_track(std::string_view text, TrackKind kind);

}  // namespace xorvox::host
