// Real models, which stand beside the project in ../shared/models and are not part of it.
#pragma once

#include <array>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "voxelizer/io/mesh_file.h"

namespace xorvox::test {

inline std::filesystem::path models_folder() {
    return std::filesystem::path(XORVOX_SOURCE_DIR) / ".." / "shared" / "models";
}

inline bool has_models() {
    return std::filesystem::exists(models_folder());
}

/// The model NAME.ply.zst; throws std::runtime_error when it cannot be read.
inline Mesh read_model(const std::string& name) {
    const std::string command = "zstd -q -d -c '" + (models_folder() / (name + ".ply.zst")).string() + "'";
    std::FILE* const pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) throw std::runtime_error("zstd cannot be started");
    std::string bytes;
    std::array<char, 65536> part;
    while (const std::size_t n = std::fread(part.data(), 1, part.size(), pipe)) bytes.append(part.data(), n);
    if (pclose(pipe) != 0) throw std::runtime_error(command + " failed");
    auto mesh = io::parse_ply(bytes, name);
    if (!mesh) throw std::runtime_error(mesh.error().message);
    return std::move(*mesh);
}

}  // namespace xorvox::test
