// The command line of the benchmark programs: MESH … [--sizes N,N] and, for one that has it, [--json].
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/bench/input.h"
#include "voxelizer/error.h"

namespace xorvox::bench {

struct Arguments {
    std::vector<tools::Model> models;
    std::vector<std::uint32_t> sizes;
    bool json = false;
    bool help = false;  ///< Print the usage and end; models and sizes are empty.
    std::string usage;
};

/// Reads the meshes. `sizes` are those without --sizes.
Expected<Arguments> parse_arguments(int argc, char** argv, const std::string& sizes, bool has_json);

}  // namespace xorvox::bench
