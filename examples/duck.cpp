#include "examples/duck.h"

#include <cstring>

#include <fmt/format.h>

#include "examples/duck_shape.h"
#include "examples/surface_nets.h"

namespace xorvox::examples {
namespace {

constexpr double kStepMm = 1.0;

template <class T>
void append(std::string& bytes, T value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes.append(raw, sizeof(T));
}

}  // namespace

std::string duck_ply() {
    const Mesh mesh = surface_nets(duck, kDuckMin, kDuckMax, kStepMm);
    std::string ply = fmt::format(
        "ply\nformat binary_little_endian 1.0\ncomment a rubber duck in millimetres, z up, made by xorvox's make_duck\n"
        "element vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
        "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        mesh.positions.size(), mesh.indices.size() / 3);
    for (const glm::dvec3& p : mesh.positions) {
        for (int axis = 0; axis < 3; ++axis) append(ply, static_cast<float>(p[axis]));
    }
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        if (i % 3 == 0) append(ply, std::uint8_t{3});
        append(ply, mesh.indices[i]);
    }
    return ply;
}

}  // namespace xorvox::examples
