#include <cmath>
#include <cstdio>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "tools/commands.h"
#include "tools/console.h"
#include "tools/mesh_input.h"
#include "tools/volume_info.h"
#include "voxelizer/io/file_name.h"
#include "voxelizer/io/scene.h"
#include "voxelizer/io/volume_reader.h"

namespace xorvox::tools {
namespace {

/// JSON has no infinities.
std::string json_number(double number) {
    return std::isfinite(number) ? fmt::format("{}", number) : "null";
}

std::span<const io::SceneAnimation> animations_of(const io::Scene& scene) {
    return scene.motion ? scene.motion->animations() : std::span<const io::SceneAnimation>();
}

/// The part of the JSON object that is not about the mesh.
std::string json_of_scene(const io::Scene& scene) {
    std::string animations;
    for (const io::SceneAnimation& animation : animations_of(scene)) {
        animations += fmt::format("{}{{\"name\": {}, \"seconds\": {}}}", animations.empty() ? "" : ", ",
                                  json_string(animation.name), json_number(animation.duration_seconds));
    }
    std::string notes;
    for (const std::string& note : scene.notes) notes += (notes.empty() ? "" : ", ") + json_string(note);
    return fmt::format(
        "\"colors\": {{\"materials\": {}, \"images\": {}, \"corner_colors\": {}, \"fault\": {}}}, \"animations\": "
        "[{}], "
        "\"notes\": [{}]",
        scene.colors.materials.size(), scene.colors.images.size(), !scene.colors.corner_colors.empty(),
        scene.colors_fault.empty() ? "null" : json_string(scene.colors_fault), animations, notes);
}

/// "3 materials, 1 image, a colour at each corner"
std::string text_of_colors(const io::Scene& scene) {
    if (!scene.colors_fault.empty()) return "none can be shown: " + scene.colors_fault;
    const SurfaceColors& colors = scene.colors;
    std::string text;
    const auto add = [&text](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
    const auto count = [](std::size_t n, const char* noun) {
        return fmt::format("{} {}{}", n, noun, n == 1 ? "" : "s");
    };
    if (!colors.materials.empty()) add(count(colors.materials.size(), "material"));
    if (!colors.images.empty()) add(count(colors.images.size(), "image"));
    if (!colors.corner_colors.empty()) add("colours at the vertices");
    return text.empty() ? "none" : text;
}

void print_scene(const io::Scene& scene) {
    fmt::print("  {:<20}{}\n", "colours", text_of_colors(scene));
    for (const io::SceneAnimation& animation : animations_of(scene)) {
        fmt::print("  {:<20}{}{:.6g} s\n", "animation",
                   animation.name.empty() ? "" : io::printable_name(animation.name) + ", ", animation.duration_seconds);
    }
    for (const std::string& note : scene.notes) fmt::print("  {:<20}{}\n", "note", note);
}

void print_json(const std::string& path, const io::MeshReport& r, const io::Scene& scene) {
    fmt::print(
        "{{\"mesh\": {}, \"vertices\": {}, \"faces\": {}, \"triangles\": {}, \"min\": [{}, {}, {}], \"max\": [{}, {}, "
        "{}], "
        "\"closed\": {}, \"open_edges\": {}, \"non_manifold_edges\": {}, \"inconsistent_edges\": {}, "
        "\"degenerate_faces\": {}, \"duplicate_faces\": {}, \"components\": {}, \"orientation\": \"{}\", \"volume\": "
        "{}, {}}}\n",
        json_string(path), r.vertices, r.faces, r.triangles, r.min.x, r.min.y, r.min.z, r.max.x, r.max.y, r.max.z,
        r.closed_mod2, r.open_edges, r.non_manifold_edges, r.inconsistent_edges, r.degenerate_faces, r.duplicate_faces,
        r.components, io::to_string(r.orientation), json_number(r.signed_volume), json_of_scene(scene));
}

void print_text(const std::string& path, const io::MeshReport& r, const io::Scene& scene) {
    const glm::dvec3 size = r.max - r.min;
    fmt::print("{}\n", io::printable_name(path));
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
    print_scene(scene);
}

}  // namespace

Expected<void> info(const InfoOptions& options) {
    const bool is_volume = io::is_volume_path(options.mesh.path);
    const bool of_mesh = !options.mesh.unit.empty() || !options.mesh.up.empty();
    const bool of_volume = options.volume.threshold || options.volume.frame;
    if (is_volume ? of_mesh : of_volume) {
        return fail(fmt::format("{} for {}, and {} is a {}; leave them out",
                                is_volume ? "--unit and --up are" : "--threshold and --volume are",
                                is_volume ? "meshes" : "volumes", io::printable_name(options.mesh.path),
                                is_volume ? "volume" : "mesh"));
    }
    if (is_volume) return volume_info(options.mesh.path, options.volume, options.json);
    const Expected<SceneInput> input = read_scene_input(options.mesh);
    if (!input) return tl::unexpected(input.error());
    (options.json ? print_json : print_text)(options.mesh.path, input->report, input->scene);
    return {};
}

}  // namespace xorvox::tools
