// Arbitrary bytes as a glTF file: a sound mesh with colours of its corners and faces, and positions at any time.
#include <vector>

#include "tests/fuzz/io_colors.h"
#include "tests/fuzz/io_mesh.h"
#include "voxelizer/io/parsed_model.h"

using namespace xorvox;

namespace {

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
