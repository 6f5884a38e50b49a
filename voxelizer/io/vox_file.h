// What a MagicaVoxel file holds, chunk by chunk, and how its scene places the models;
// https://github.com/ephtracy/voxel-model. Private to voxelizer/io.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "voxelizer/error.h"
#include "voxelizer/sampled_volume.h"

namespace xorvox::io {

struct VoxModel {
    glm::uvec3 size{0};
    std::string_view voxels;  ///< x, y, z and colour, four bytes a voxel; all within the size.
};

/// A turn by quarters, and a translation, in voxels.
struct VoxPlace {
    std::array<glm::ivec3, 3> rows{glm::ivec3(1, 0, 0), glm::ivec3(0, 1, 0), glm::ivec3(0, 0, 1)};
    glm::ivec3 translation{0};
};

/// A node of the scene: a transform of one child, a group of children, or a shape of models that follow each other.
struct VoxNode {
    VoxPlace place;
    bool hidden = false;
    std::vector<std::uint32_t> children;  ///< Nodes.
    std::vector<std::uint32_t> models;
};

struct VoxFile {
    std::vector<VoxModel> models;
    std::vector<Rgba> palette;  ///< 256 entries; 0 is nothing.
    std::map<std::uint32_t, VoxNode> nodes;
    std::size_t bytes = 0;
};

/// The parts of the file, which must outlive them.
Expected<VoxFile> read_vox_chunks(std::string_view bytes, std::string_view source);

/// The node of a chunk nTRN, nGRP or nSHP, put into `file`. `first_byte` is where `chunk` begins.
Expected<void> read_vox_node(std::string_view id, std::string_view chunk, std::string_view source,
                             std::size_t first_byte, VoxFile& file);

/// The models as volumes: put together, or one after the other.
Expected<VolumeSequence> place_vox_models(const VoxFile& file, std::string_view source);

}  // namespace xorvox::io
