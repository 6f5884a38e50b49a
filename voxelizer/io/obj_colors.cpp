#include "voxelizer/io/obj_colors.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "voxelizer/io/formats.h"
#include "voxelizer/io/image_file.h"
#include "voxelizer/io/model_images.h"
#include "voxelizer/io/text_scanner.h"

namespace xorvox::io {
namespace {

constexpr FileKind kMaterialFile{"a material file", std::size_t{64} << 20, "remove what no face uses"};

bool is_color(const glm::dvec3& c) {
    return c.r >= 0.0 && c.r <= 1.0 && c.g >= 0.0 && c.g <= 1.0 && c.b >= 0.0 && c.b <= 1.0;
}

}  // namespace

void ObjColors::set_vertex_color(std::size_t vertex, const glm::dvec3& srgb) {
    if (!is_color(srgb)) {
        if (fault_.empty()) fault_ = fmt::format("vertex {} has a colour that is not in 0 … 1", vertex + 1);
        return;
    }
    vertex_colors_.resize(vertex, glm::vec3(1.0f));
    vertex_colors_.push_back(linear_color(srgb));
}

void ObjColors::add_texcoord(const glm::dvec2& texcoord, bool sound, std::size_t line) {
    // The first row of an image is at the top, v = 1 in the file.
    const glm::vec2 narrow(static_cast<float>(texcoord.x), static_cast<float>(1.0 - texcoord.y));
    constexpr float kMost = 1e9f;  // Beyond it, floats have no place within an image.
    sound = sound && std::abs(narrow.x) < kMost && std::abs(narrow.y) < kMost;
    if (!sound && fault_.empty()) fault_ = fmt::format("line {}: these are no texture coordinates", line);
    texcoords_.push_back(sound ? narrow : glm::vec2(0.0f));
}

void ObjColors::use_material(std::string_view name) {
    const auto number = static_cast<std::uint32_t>(materials_.size());
    material_ = materials_.try_emplace(std::string(name), number).first->second;
}

void ObjColors::add_corner(std::int64_t texcoord) {
    if (texcoord != 0) {
        const auto count = static_cast<std::int64_t>(texcoords_.size());
        const std::int64_t number = texcoord > 0 ? texcoord : count + texcoord + 1;
        if (number > 0 && number <= std::int64_t{UINT32_MAX}) {
            corner_texcoords_.resize(corner_count_);
            corner_texcoords_.push_back(static_cast<std::uint32_t>(number));
        } else if (fault_.empty()) {
            fault_ = fmt::format("a corner has texture coordinates {} of {}", texcoord, count);
        }
    }
    ++corner_count_;
}

void ObjColors::end_face() {
    corners_.set_material(face_count_++, material_);
}

Expected<SurfaceColors> ObjColors::resolve(const MeshView& mesh, std::string_view source,
                                           const SideFiles& side_files) && {
    if (!fault_.empty()) return fail(fmt::format("{}: {}; repair or export the mesh again", source, fault_));
    if (!vertex_colors_.empty()) {
        vertex_colors_.resize(mesh.positions.size(), glm::vec3(1.0f));
        for (std::size_t c = 0; c < mesh.indices.size(); ++c) corners_.set_color(c, vertex_colors_[mesh.indices[c]]);
    }
    if (materials_.size() > 1) {
        if (auto ok = read_materials(source, side_files, corners_.colors); !ok) {
            return tl::unexpected(std::move(ok.error()));
        }
    }
    if (!corners_.colors.images.empty()) {
        for (std::size_t c = 0; c < corner_texcoords_.size(); ++c) {
            const std::uint32_t number = corner_texcoords_[c];
            if (number > texcoords_.size()) {
                return fail(
                    fmt::format("{}: a corner has texture coordinates {} of {}; repair or export the mesh again",
                                source, number, texcoords_.size()));
            }
            if (number > 0) corners_.set_texcoord(c, texcoords_[number - 1]);
        }
    }
    SurfaceColors colors = std::move(corners_).finish(mesh.indices.size(), mesh.face_count());
    drop_white(colors);
    return colors;
}

Expected<void> ObjColors::read_materials(std::string_view source, const SideFiles& side_files,
                                         SurfaceColors& colors) const {
    std::map<std::string, MtlMaterial, std::less<>> known;
    for (const std::string& library : libraries_) {
        const auto text = side_files.read_by_name(library, source, kMaterialFile);
        if (!text) return tl::unexpected(text.error());
        if (auto ok = parse_mtl(*text, fmt::format("{}: {}", source, quoted(library)), known); !ok) return ok;
    }
    colors.materials.resize(materials_.size());
    ModelImages images(source);
    std::map<std::string, std::uint32_t, std::less<>> numbers;
    for (const auto& [name, number] : materials_) {
        if (number == 0) continue;
        const auto found = known.find(name);
        if (found == known.end()) {
            return fail(fmt::format("{}: uses the material {}, which none of its {} material files has", source,
                                    quoted(name), libraries_.size()));
        }
        const MtlMaterial& from = found->second;
        SurfaceMaterial& material = colors.materials[number];
        material.factor = from.factor;
        material.wrap_u = material.wrap_v = from.clamped ? TextureWrap::Clamp : TextureWrap::Repeat;
        if (from.image.empty()) continue;
        const auto [image_number, is_new] = numbers.try_emplace(from.image, 0);
        if (is_new) {
            const auto bytes = side_files.read_by_name(from.image, source, kImageFile);
            if (!bytes) return tl::unexpected(bytes.error());
            const auto added = images.add(decode_image(*bytes, fmt::format("{}: {}", source, quoted(from.image))));
            if (!added) return tl::unexpected(added.error());
            image_number->second = *added;
        }
        material.image = image_number->second;
    }
    colors.images = std::move(images).take();
    return {};
}

}  // namespace xorvox::io
