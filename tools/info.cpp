#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#include "tools/commands.h"
#include "tools/console.h"
#include "tools/mesh_input.h"
#include "tools/volume_info.h"
#include "voxelizer/io/volume_reader.h"

namespace xorvox::tools {
namespace {

/// JSON has no infinities.
std::string json_number(double number) {
    return std::isfinite(number) ? fmt::format("{}", number) : "null";
}

void print_json(const std::string& path, const io::MeshReport& r) {
    fmt::print(
        "{{\"mesh\": {}, \"vertices\": {}, \"faces\": {}, \"triangles\": {}, \"min\": [{}, {}, {}], \"max\": [{}, {}, "
        "{}], "
        "\"closed\": {}, \"open_edges\": {}, \"non_manifold_edges\": {}, \"inconsistent_edges\": {}, "
        "\"degenerate_faces\": {}, \"duplicate_faces\": {}, \"components\": {}, \"orientation\": \"{}\", \"volume\": "
        "{}}}\n",
        json_string(path), r.vertices, r.faces, r.triangles, r.min.x, r.min.y, r.min.z, r.max.x, r.max.y, r.max.z,
        r.closed_mod2, r.open_edges, r.non_manifold_edges, r.inconsistent_edges, r.degenerate_faces, r.duplicate_faces,
        r.components, io::to_string(r.orientation), json_number(r.signed_volume));
}

void print_text(const std::string& path, const io::MeshReport& r) {
    const glm::dvec3 size = r.max - r.min;
    fmt::print("{}\n", path);
    fmt::print("  {:<20}{}\n", "vertices", thousands(r.vertices));
    fmt::print("  {:<20}{}", "faces", thousands(r.faces));
    fmt::print("{}\n",
               r.triangles == r.faces ? ", all triangles" : fmt::format(" ({} triangles)", thousands(r.triangles)));
    fmt::print("  {:<20}{:.6g} × {:.6g} × {:.6g}\n", "size", size.x, size.y, size.z);
    fmt::print("  {:<20}{:.6g}, {:.6g}, {:.6g} to {:.6g}, {:.6g}, {:.6g}\n", "box", r.min.x, r.min.y, r.min.z, r.max.x,
               r.max.y, r.max.z);
    fmt::print("  {:<20}{}\n", "closed",
               r.closed_mod2 ? "yes" : fmt::format("no, {} open edges", thousands(r.open_edges)));
    fmt::print("  {:<20}{}\n", "non-manifold edges", thousands(r.non_manifold_edges));
    fmt::print("  {:<20}{}\n", "inconsistent edges", thousands(r.inconsistent_edges));
    fmt::print("  {:<20}{}\n", "degenerate faces", thousands(r.degenerate_faces));
    fmt::print("  {:<20}{}\n", "duplicate faces", thousands(r.duplicate_faces));
    fmt::print("  {:<20}{}\n", "components", thousands(r.components));
    fmt::print("  {:<20}{}\n", "orientation", io::to_string(r.orientation));
    fmt::print("  {:<20}{:.6g}{}\n", "volume", r.signed_volume,
               r.closed_mod2 ? "" : " (of an open mesh: a rough figure)");
}

}  // namespace

Expected<void> info(const InfoOptions& options) {
    if (io::is_volume_path(options.mesh.path)) return volume_info(options.mesh.path, options.volume, options.json);
    const Expected<MeshInput> input = read_input(options.mesh);
    if (!input) return tl::unexpected(input.error());
    (options.json ? print_json : print_text)(options.mesh.path, input->report);
    return {};
}

}  // namespace xorvox::tools
