// ObjColors: what a Wavefront OBJ says about colours, and its material files. Private to voxelizer/io.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "voxelizer/error.h"
#include "voxelizer/io/corner_colors.h"
#include "voxelizer/io/side_files.h"
#include "voxelizer/mesh.h"
#include "voxelizer/surface_colors.h"

namespace xorvox::io {

/// Gathers while the file is read, and reads the material files and their images in the end.
class ObjColors {
public:
    void set_vertex_color(std::size_t vertex, const glm::dvec3& srgb);
    /// `sound`: whether they are numbers.
    void add_texcoord(const glm::dvec2& texcoord, bool sound, std::size_t line);
    void add_library(std::string_view name) { libraries_.emplace_back(name); }
    void use_material(std::string_view name);
    /// `texcoord` as in the file: counted from 1, or backward when negative; 0: none.
    void add_corner(std::int64_t texcoord);
    void end_face();

    /// The colours of `mesh`, whose corners and faces were added. An error is a fault of the colours alone.
    Expected<SurfaceColors> resolve(const MeshView& mesh, std::string_view source, const SideFiles& side_files) &&;

private:
    Expected<void> read_materials(std::string_view source, const SideFiles& side_files, SurfaceColors& colors) const;

    CornerColors corners_;
    std::vector<glm::vec3> vertex_colors_;
    std::vector<glm::vec2> texcoords_;
    std::vector<std::uint32_t> corner_texcoords_;  // Numbers from 1; 0: none. Empty while no corner has any.
    std::vector<std::string> libraries_;
    std::map<std::string, std::uint32_t, std::less<>> materials_{{"", 0}};  // Their numbers; 0: none was named.
    std::uint32_t material_ = 0;
    std::size_t corner_count_ = 0;
    std::size_t face_count_ = 0;
    std::string fault_;
};

struct MtlMaterial {
    glm::vec3 factor{1.0f};  ///< Linear light.
    std::string image;       ///< As the file names it; empty: none.
    bool clamped = false;
};

/// Reads the material file `text`, called `source` in errors: Kd, map_Kd and its option -clamp; the rest is passed
/// over. Adds to `materials`.
Expected<void> parse_mtl(std::string_view text, std::string_view source,
                         std::map<std::string, MtlMaterial, std::less<>>& materials);

}  // namespace xorvox::io
