// NodeMotion: parts of a model that hang on a tree of nodes, whose poses follow key frames. Private to voxelizer/io.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "voxelizer/io/scene.h"

namespace xorvox::io {

/// Where a node is in its parent's space: scaled, then rotated, then translated.
struct NodePose {
    glm::dvec3 translation{0.0};
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  ///< A unit.
    glm::dvec3 scale{1.0};

    glm::dmat4 matrix() const;
};

struct MotionNode {
    static constexpr std::uint32_t kNoParent = 0xffff'ffff;

    std::uint32_t parent = kNoParent;  ///< Below the node's own number.
    NodePose rest;
    std::optional<glm::dmat4> matrix;  ///< Instead of `rest`; such a node has no channel.
};

/// A value of one node over time. `keys` has an entry a time; with CubicSpline three: the tangent that comes in, the
/// value, and the tangent that goes out. Rotations are x, y, z, w.
struct MotionChannel {
    enum class Target : std::uint8_t { Translation, Rotation, Scale };
    enum class Interpolation : std::uint8_t { Linear, Step, CubicSpline };

    std::uint32_t node = 0;
    Target target = Target::Translation;
    Interpolation interpolation = Interpolation::Linear;
    std::vector<double> times;  ///< Seconds, increasing; at least one.
    std::vector<glm::dvec4> keys;
};

/// The value of `channel` at `seconds`: that of the first key before it, that of the last key after it.
glm::dvec4 value_at(const MotionChannel& channel, double seconds);

/// Part 0 does not move; part p > 0 hangs on node part_nodes[p - 1].
class NodeMotion final : public SceneMotion {
public:
    std::vector<MotionNode> nodes;  ///< Parents before their children.
    std::vector<std::uint32_t> part_nodes;
    std::vector<SceneAnimation> about;                 ///< One an animation.
    std::vector<std::vector<MotionChannel>> channels;  ///< The same.

    /// Attaches the vertices, to be called once: where each is in the space of its part, its part, and what is done to
    /// all positions in the end.
    void attach(std::vector<glm::dvec3> local, std::vector<std::uint32_t> parts, const glm::dmat4& placement);

    /// Where the vertices are when nothing moves. What a double cannot hold becomes infinite.
    std::vector<glm::dvec3> rest_positions() const;
    /// From a node's space to the space of the scene, at rest.
    std::vector<glm::dmat4> rest_matrices() const;

    std::span<const SceneAnimation> animations() const override { return about; }
    void positions_at(std::size_t animation, double seconds, std::span<glm::dvec3> positions) const override;

private:
    std::vector<glm::dmat4> matrices_of(std::span<const NodePose> poses) const;
    void place(std::span<const glm::dmat4> matrices, std::span<glm::dvec3> positions) const;

    std::vector<glm::dvec3> local_;
    std::vector<std::uint32_t> parts_;
    glm::dmat4 placement_{1.0};
};

}  // namespace xorvox::io
