// The nodes of a glTF scene, and how they move. Private to voxelizer/io.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "voxelizer/io/gltf_model.h"
#include "voxelizer/io/node_motion.h"

namespace xorvox::io {

/// The nodes of the scene that is shown: the file's default one, else its first one, else all nodes.
struct GltfTree {
    std::vector<MotionNode> nodes;           ///< Parents before their children.
    std::vector<std::uint32_t> model_nodes;  ///< The number in the model of each.
};

/// Each node hangs on one other at most, and none on itself.
Expected<GltfTree> read_gltf_tree(const tinygltf::Model& model, const GltfData& data);

/// The animations that move nodes of `tree`; null when there are none. What is not read of them is added to `notes`.
/// The parts are the nodes with a channel.
Expected<std::shared_ptr<NodeMotion>> read_gltf_motion(const tinygltf::Model& model, const GltfTree& tree,
                                                       GltfData& data, std::vector<std::string>& notes);

}  // namespace xorvox::io
