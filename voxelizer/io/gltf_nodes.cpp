#include "voxelizer/io/gltf_nodes.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>

#include "voxelizer/io/file_name.h"
#include "voxelizer/io/text_scanner.h"

namespace xorvox::io {
namespace {

constexpr std::uint32_t kNotShown = 0xffff'ffff;

bool in(int number, std::size_t count) {
    return number >= 0 && static_cast<std::size_t>(number) < count;
}

/// Whether `numbers` are none, or `count` finite ones.
bool is_none_or(const std::vector<double>& numbers, std::size_t count) {
    return numbers.empty() || (numbers.size() == count &&
                               std::all_of(numbers.begin(), numbers.end(), [](double n) { return std::isfinite(n); }));
}

Expected<std::vector<int>> roots(const tinygltf::Model& model, const GltfData& data) {
    if (!model.scenes.empty()) {
        const int scene = std::max(model.defaultScene, 0);
        if (!in(scene, model.scenes.size())) {
            return data.refuse(fmt::format("scene {} of a file with {}", scene, model.scenes.size()));
        }
        return model.scenes[static_cast<std::size_t>(scene)].nodes;
    }
    std::vector<char> is_child(model.nodes.size());
    for (const tinygltf::Node& node : model.nodes) {
        for (const int child : node.children) {
            if (in(child, model.nodes.size())) is_child[static_cast<std::size_t>(child)] = 1;
        }
    }
    std::vector<int> found;
    for (std::size_t n = 0; n < model.nodes.size(); ++n) {
        if (!is_child[n]) found.push_back(static_cast<int>(n));
    }
    return found;
}

Expected<MotionNode> read_node(const tinygltf::Node& node, std::size_t number, const GltfData& data) {
    if (!is_none_or(node.translation, 3) || !is_none_or(node.rotation, 4) || !is_none_or(node.scale, 3) ||
        !is_none_or(node.matrix, 16)) {
        return data.refuse(
            fmt::format("node {}: its translation, rotation, scale or matrix has too few, too many or "
                        "no finite numbers",
                        number));
    }
    MotionNode result;
    if (!node.matrix.empty()) {
        result.matrix = glm::make_mat4(node.matrix.data());
        const glm::dmat4& m = *result.matrix;
        if (m[0][3] != 0.0 || m[1][3] != 0.0 || m[2][3] != 0.0 || m[3][3] != 1.0) {
            return data.refuse(fmt::format("node {}: its matrix has a last row other than 0 0 0 1", number));
        }
        return result;
    }
    const auto vector = [](const std::vector<double>& n, glm::dvec3 otherwise) {
        return n.empty() ? otherwise : glm::dvec3(n[0], n[1], n[2]);
    };
    result.rest.translation = vector(node.translation, glm::dvec3(0.0));
    result.rest.scale = vector(node.scale, glm::dvec3(1.0));
    if (!node.rotation.empty()) {
        const glm::dquat q(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
        const double length = glm::length(q);
        if (!(length > 0.0) || !std::isfinite(length)) {
            return data.refuse(fmt::format("node {}: its rotation is no quaternion that can be normalized", number));
        }
        result.rest.rotation = q / length;
    }
    return result;
}

class MotionReader {
public:
    MotionReader(const tinygltf::Model& model, const GltfTree& tree, GltfData& data, std::vector<std::string>& notes)
        : model_(model),
          tree_(tree),
          data_(data),
          notes_(notes),
          shown_(model.nodes.size(), kNotShown),
          carries_mesh_(tree.nodes.size()) {
        for (std::size_t n = 0; n < tree.model_nodes.size(); ++n) {
            shown_[tree.model_nodes[n]] = static_cast<std::uint32_t>(n);
        }
        for (std::size_t n = tree.nodes.size(); n-- > 0;) {
            carries_mesh_[n] |= model.nodes[tree.model_nodes[n]].mesh >= 0;
            const std::uint32_t parent = tree.nodes[n].parent;
            if (parent != MotionNode::kNoParent) carries_mesh_[parent] |= carries_mesh_[n];
        }
    }

    Expected<std::shared_ptr<NodeMotion>> read() {
        auto motion = std::make_shared<NodeMotion>();
        motion->nodes = tree_.nodes;
        std::vector<char> moves(tree_.nodes.size());
        for (std::size_t a = 0; a < model_.animations.size(); ++a) {
            std::vector<MotionChannel> channels;
            if (auto ok = read_animation(a, channels); !ok) return tl::unexpected(std::move(ok.error()));
            if (channels.empty()) {
                notes_.push_back(fmt::format("animation {}, which moves nothing that is shown", a));
                continue;
            }
            double end = 0.0;
            for (const MotionChannel& channel : channels) {
                moves[channel.node] = 1;
                end = std::max(end, channel.times.back());
            }
            motion->about.push_back({printable_name(model_.animations[a].name), end});
            motion->channels.push_back(std::move(channels));
        }
        if (others_ > 0) {
            notes_.push_back(fmt::format("animation channels of other things than poses of nodes: {}", others_));
        }
        if (motion->about.empty()) return std::shared_ptr<NodeMotion>();
        for (std::size_t n = 0; n < moves.size(); ++n) {
            if (moves[n]) motion->part_nodes.push_back(static_cast<std::uint32_t>(n));
        }
        return motion;
    }

private:
    Expected<void> read_animation(std::size_t number, std::vector<MotionChannel>& channels) {
        const tinygltf::Animation& animation = model_.animations[number];
        for (const tinygltf::AnimationChannel& channel : animation.channels) {
            MotionChannel result;
            if (channel.target_path == "rotation") {
                result.target = MotionChannel::Target::Rotation;
            } else if (channel.target_path == "scale") {
                result.target = MotionChannel::Target::Scale;
            } else if (channel.target_path != "translation") {
                ++others_;
                continue;
            }
            const std::string where = fmt::format("animation {}", number);
            if (!in(channel.target_node, shown_.size())) {
                return data_.refuse(
                    fmt::format("{}: moves node {} of a file with {}", where, channel.target_node, shown_.size()));
            }
            result.node = shown_[static_cast<std::size_t>(channel.target_node)];
            if (result.node == kNotShown || !carries_mesh_[result.node]) continue;
            if (tree_.nodes[result.node].matrix) {
                return data_.refuse(fmt::format("{}: moves node {}, which has a matrix", where, channel.target_node));
            }
            if (!in(channel.sampler, animation.samplers.size())) {
                return data_.refuse(
                    fmt::format("{}: sampler {} of {}", where, channel.sampler, animation.samplers.size()));
            }
            const auto& sampler = animation.samplers[static_cast<std::size_t>(channel.sampler)];
            if (auto ok = read_keys(sampler, where, result); !ok) return ok;
            channels.push_back(std::move(result));
        }
        return {};
    }

    Expected<void> read_keys(const tinygltf::AnimationSampler& sampler, const std::string& where,
                             MotionChannel& channel) {
        if (sampler.interpolation == "STEP") {
            channel.interpolation = MotionChannel::Interpolation::Step;
        } else if (sampler.interpolation == "CUBICSPLINE") {
            channel.interpolation = MotionChannel::Interpolation::CubicSpline;
        } else if (sampler.interpolation != "LINEAR") {
            return data_.refuse(
                fmt::format("{}: the interpolation {} is not known", where, quoted(sampler.interpolation)));
        }
        auto times = data_.numbers(sampler.input, {1}, "times", keys_left_);
        if (!times) return tl::unexpected(std::move(times.error()));
        channel.times = std::move(times->values);
        if (channel.times.empty() || channel.times.front() < 0.0 ||
            !std::is_sorted(channel.times.begin(), channel.times.end())) {
            return data_.refuse(fmt::format("{}: its times are none, negative or not in order", where));
        }
        const bool is_rotation = channel.target == MotionChannel::Target::Rotation;
        const auto keys = data_.numbers(sampler.output, {is_rotation ? 4 : 3}, "key frames", keys_left_);
        if (!keys) return tl::unexpected(keys.error());
        const std::size_t each = channel.interpolation == MotionChannel::Interpolation::CubicSpline ? 3 : 1;
        if (keys->count() != each * channel.times.size()) {
            return data_.refuse(fmt::format("{}: {} values for {} times", where, keys->count(), channel.times.size()));
        }
        keys_left_ -= keys->count();
        for (std::size_t k = 0; k < keys->count(); ++k) {
            const double* n = &keys->values[k * static_cast<std::size_t>(keys->components)];
            channel.keys.emplace_back(n[0], n[1], n[2], is_rotation ? n[3] : 0.0);
        }
        return {};
    }

    const tinygltf::Model& model_;
    const GltfTree& tree_;
    GltfData& data_;
    std::vector<std::string>& notes_;
    std::vector<std::uint32_t> shown_;  // The number in the tree of each node of the model.
    std::vector<char> carries_mesh_;    // Whether a node of the tree, or one that hangs on it, has a mesh.
    std::size_t keys_left_ = kMostGltfKeys;
    std::size_t others_ = 0;
};

}  // namespace

Expected<GltfTree> read_gltf_tree(const tinygltf::Model& model, const GltfData& data) {
    const auto top = roots(model, data);
    if (!top) return tl::unexpected(top.error());
    struct Waiting {
        int node;
        std::uint32_t parent;
    };
    std::vector<Waiting> waiting;
    for (auto root = top->rbegin(); root != top->rend(); ++root) waiting.push_back({*root, MotionNode::kNoParent});
    GltfTree tree;
    std::vector<char> seen(model.nodes.size());
    while (!waiting.empty()) {
        const Waiting next = waiting.back();
        waiting.pop_back();
        if (!in(next.node, model.nodes.size())) {
            return data.refuse(fmt::format("node {} of a file with {}", next.node, model.nodes.size()));
        }
        const auto number = static_cast<std::size_t>(next.node);
        if (seen[number]) return data.refuse(fmt::format("node {} hangs on two nodes, or on itself", number));
        seen[number] = 1;
        auto node = read_node(model.nodes[number], number, data);
        if (!node) return tl::unexpected(std::move(node.error()));
        node->parent = next.parent;
        const auto here = static_cast<std::uint32_t>(tree.nodes.size());
        tree.nodes.push_back(*node);
        tree.model_nodes.push_back(static_cast<std::uint32_t>(number));
        const std::vector<int>& children = model.nodes[number].children;
        for (auto child = children.rbegin(); child != children.rend(); ++child) waiting.push_back({*child, here});
    }
    return tree;
}

Expected<std::shared_ptr<NodeMotion>> read_gltf_motion(const tinygltf::Model& model, const GltfTree& tree,
                                                       GltfData& data, std::vector<std::string>& notes) {
    return MotionReader(model, tree, data, notes).read();
}

}  // namespace xorvox::io
