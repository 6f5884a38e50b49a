#include "voxelizer/io/node_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

namespace xorvox::io {
namespace {

glm::dquat quaternion(const glm::dvec4& xyzw) {
    const double length = glm::length(xyzw);
    // Splines may pass through 0, where there is no rotation to be had.
    if (!(length > 0.0) || !std::isfinite(length)) return {1.0, 0.0, 0.0, 0.0};
    return {xyzw.w / length, xyzw.x / length, xyzw.y / length, xyzw.z / length};
}

glm::dvec4 vector(const glm::dquat& q) {
    return {q.x, q.y, q.z, q.w};
}

// Hermite's spline as in appendix C of the glTF 2.0 specification; `span` is the time between both keys.
glm::dvec4 spline(const glm::dvec4* from, const glm::dvec4* to, double span, double t) {
    const double t2 = t * t;
    const double t3 = t2 * t;
    return (2.0 * t3 - 3.0 * t2 + 1.0) * from[1] + span * (t3 - 2.0 * t2 + t) * from[2] +
           (3.0 * t2 - 2.0 * t3) * to[1] + span * (t3 - t2) * to[0];
}

bool is_finite(const glm::dvec3& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

void apply(const MotionChannel& channel, double seconds, NodePose& pose) {
    const glm::dvec4 value = value_at(channel, seconds);
    switch (channel.target) {
        case MotionChannel::Target::Translation: pose.translation = glm::dvec3(value); break;
        case MotionChannel::Target::Rotation: pose.rotation = quaternion(value); break;
        case MotionChannel::Target::Scale: pose.scale = glm::dvec3(value); break;
    }
}

}  // namespace

glm::dmat4 NodePose::matrix() const {
    const glm::dmat3 turn = glm::mat3_cast(rotation);
    return {glm::dvec4(turn[0] * scale.x, 0.0), glm::dvec4(turn[1] * scale.y, 0.0), glm::dvec4(turn[2] * scale.z, 0.0),
            glm::dvec4(translation, 1.0)};
}

glm::dvec4 value_at(const MotionChannel& channel, double seconds) {
    using Interpolation = MotionChannel::Interpolation;
    const std::vector<double>& times = channel.times;
    const bool is_spline = channel.interpolation == Interpolation::CubicSpline;
    const auto key = [&](std::size_t k) { return is_spline ? channel.keys[3 * k + 1] : channel.keys[k]; };
    const auto next = static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), seconds) - times.begin());
    if (next == 0) return key(0);
    if (next == times.size() || channel.interpolation == Interpolation::Step) return key(next - 1);
    const double span = times[next] - times[next - 1];
    const double t = (seconds - times[next - 1]) / span;
    if (is_spline) return spline(&channel.keys[3 * (next - 1)], &channel.keys[3 * next], span, t);
    if (channel.target == MotionChannel::Target::Rotation) {
        return vector(glm::slerp(quaternion(key(next - 1)), quaternion(key(next)), t));
    }
    return key(next - 1) * (1.0 - t) + key(next) * t;
}

void NodeMotion::attach(std::vector<glm::dvec3> local, std::vector<std::uint32_t> parts, const glm::dmat4& placement) {
    local_ = std::move(local);
    parts_ = std::move(parts);
    placement_ = placement;
}

std::vector<glm::dmat4> NodeMotion::matrices_of(std::span<const NodePose> poses) const {
    std::vector<glm::dmat4> matrices(nodes.size());
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        matrices[n] = nodes[n].matrix ? *nodes[n].matrix : poses[n].matrix();
        if (nodes[n].parent != MotionNode::kNoParent) matrices[n] = matrices[nodes[n].parent] * matrices[n];
    }
    return matrices;
}

std::vector<glm::dmat4> NodeMotion::rest_matrices() const {
    std::vector<NodePose> poses(nodes.size());
    for (std::size_t n = 0; n < nodes.size(); ++n) poses[n] = nodes[n].rest;
    return matrices_of(poses);
}

void NodeMotion::place(std::span<const glm::dmat4> matrices, std::span<glm::dvec3> positions) const {
    std::vector<glm::dmat4> of_part{placement_};
    for (const std::uint32_t node : part_nodes) of_part.push_back(placement_ * matrices[node]);
    for (std::size_t v = 0; v < local_.size(); ++v) {
        positions[v] = glm::dvec3(of_part[parts_[v]] * glm::dvec4(local_[v], 1.0));
    }
}

std::vector<glm::dvec3> NodeMotion::rest_positions() const {
    std::vector<glm::dvec3> positions(local_.size());
    place(rest_matrices(), positions);
    return positions;
}

void NodeMotion::positions_at(std::size_t animation, double seconds, std::span<glm::dvec3> positions) const {
    std::vector<NodePose> poses(nodes.size());
    for (std::size_t n = 0; n < nodes.size(); ++n) poses[n] = nodes[n].rest;
    for (const MotionChannel& channel : channels[animation]) apply(channel, seconds, poses[channel.node]);
    place(matrices_of(poses), positions);
    if (std::all_of(positions.begin(), positions.end(), is_finite)) return;
    // Poses that a double cannot hold: the parts that have them stay at rest.
    const std::vector<glm::dvec3> rest = rest_positions();
    for (std::size_t v = 0; v < rest.size(); ++v) {
        if (!is_finite(positions[v])) positions[v] = rest[v];
    }
}

}  // namespace xorvox::io
