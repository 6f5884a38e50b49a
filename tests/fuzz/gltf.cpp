// Arbitrary bytes as a glTF file: a sound mesh with colours of its corners and faces, and positions at any time.
#include <vector>

#include "tests/fuzz/io_mesh.h"
#include "voxelizer/io/parsed_model.h"

using namespace xorvox;

namespace {

void check_colors(const io::ParsedModel& parsed) {
    const SurfaceColors& colors = parsed.colors;
    const std::size_t corners = parsed.mesh.indices.size();
    const std::size_t faces = parsed.mesh.view().face_count();
    require(colors.corner_colors.empty() || colors.corner_colors.size() == corners);
    require(colors.corner_texcoords.empty() || colors.corner_texcoords.size() == corners);
    require(colors.face_materials.empty() || colors.face_materials.size() == faces);
    for (const std::uint32_t material : colors.face_materials) require(material < colors.materials.size());
    for (const SurfaceMaterial& material : colors.materials) {
        require(material.image == SurfaceMaterial::kNoImage || material.image < colors.images.size());
    }
    for (const glm::vec2& t : colors.corner_texcoords) require(std::isfinite(t.x) && std::isfinite(t.y));
}

void check_motion(io::ParsedModel& parsed) {
    io::NodeMotion& motion = *parsed.motion;
    require(parsed.parts.size() == parsed.mesh.positions.size());
    motion.attach(parsed.mesh.positions, parsed.parts, glm::dmat4(1.0));
    for (const glm::dvec3& p : motion.rest_positions()) {
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return;
    }
    std::vector<glm::dvec3> positions(parsed.mesh.positions.size());
    for (std::size_t a = 0; a < motion.animations().size(); ++a) {
        for (const double seconds : {-1.0, 0.0, 0.3, 1.0, 1e30}) {
            motion.positions_at(a, seconds, positions);
            for (const glm::dvec3& p : positions) {
                require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
            }
        }
    }
}

Expected<Mesh> parse(std::string_view bytes, std::string_view source) {
    auto parsed = io::parse_gltf(bytes, source, io::Wanted::ShapeAndColors, io::SideFiles());
    if (!parsed) return tl::unexpected(parsed.error());
    check_colors(*parsed);
    if (parsed->motion) check_motion(*parsed);
    return std::move(parsed->mesh);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return check_parser(parse, data, size);
}
