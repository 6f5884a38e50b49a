// Input: meshes and lists of numbers for benchmarks.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "voxelizer/error.h"
#include "voxelizer/lattice.h"
#include "voxelizer/mesh.h"

namespace xorvox::tools {

/// "a,b" into "a" and "b"; as many parts as commas and one.
std::vector<std::string> split(std::string_view text);

/// "64,128" into numbers from 1 to `most`, each once, in the order given; the message of a failure begins with
/// `option`.
Expected<std::vector<std::uint32_t>> parse_numbers(std::string_view option, std::string_view text, std::uint32_t most);

/// A mesh under the name that results have.
struct Model {
    /// The file's name, without its folder and extension; after its folder, or as its path, where that is of several.
    std::string name;
    std::string path;
    Mesh mesh;
    std::size_t triangles = 0;
    Box box;  ///< Every fit_cube() of it succeeds.
};

/// Reads meshes, a path that is given twice once; open edges are a warning on standard error.
Expected<std::vector<Model>> read_models(const std::vector<std::string>& paths);

}  // namespace xorvox::tools
