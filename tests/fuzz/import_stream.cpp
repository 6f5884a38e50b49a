// Arbitrary bytes from the importer of the rarer formats: a sound model or a message.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "voxelizer/io/import_stream.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    bool refused = false;
    const auto model = xorvox::io::parse_import({reinterpret_cast<const char*>(data), size}, refused);
    if (!model) return 0;
    std::size_t corners = 0;
    for (const std::uint32_t face : model->face_sizes) corners += face;
    bool sound = corners == model->indices.size() && model->face_materials.size() == model->face_sizes.size();
    for (const std::uint32_t index : model->indices) sound = sound && index < model->positions.size();
    for (const glm::dvec3& p : model->positions) sound = sound && std::isfinite(p.x + p.y + p.z);
    for (const std::uint32_t material : model->face_materials) sound = sound && material < model->materials.size();
    if (!sound) std::abort();
    // What is read is written as it was.
    if (!xorvox::io::color_fault(*model) && xorvox::io::encode_import(*model).size() != size) std::abort();
    return 0;
}
