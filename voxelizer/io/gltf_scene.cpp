// From a glTF scene to one mesh: every primitive of every node, in the space of the part that it belongs to.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <glm/matrix.hpp>

#include "voxelizer/io/corner_colors.h"
#include "voxelizer/io/formats.h"
#include "voxelizer/io/gltf_materials.h"
#include "voxelizer/io/gltf_model.h"
#include "voxelizer/io/gltf_nodes.h"
#include "voxelizer/io/parsed_model.h"

namespace xorvox::io {
namespace {

using Corners = std::array<std::uint32_t, 3>;

class SceneReader {
public:
    SceneReader(const tinygltf::Model& model, std::string_view source, Wanted wanted, const SideFiles& side_files)
        : model_(model),
          data_(model, source),
          source_(source),
          side_files_(side_files),
          wants_colors_(wanted == Wanted::ShapeAndColors) {}

    Expected<ParsedModel> read() {
        auto tree = read_gltf_tree(model_, data_);
        if (!tree) return tl::unexpected(std::move(tree.error()));
        auto motion = read_gltf_motion(model_, *tree, data_, parsed_.notes);
        if (!motion) return tl::unexpected(std::move(motion.error()));
        parsed_.motion = std::move(*motion);
        if (wants_colors_) {
            auto materials = read_gltf_materials(model_, data_);
            materials ? void(materials_ = std::move(*materials)) : lose_colors(materials.error());
        }
        if (auto ok = read_nodes(*tree); !ok) return tl::unexpected(std::move(ok.error()));
        if (parsed_.mesh.indices.empty()) {
            return fail(fmt::format("{}: its scene has no triangles{}; a mesh needs faces", source_,
                                    skipped_ > 0 ? ", but points or lines" : ""));
        }
        finish_colors();
        add_notes();
        return std::move(parsed_);
    }

private:
    // From each node to its part, and the number of the part.
    Expected<void> read_nodes(const GltfTree& tree) {
        std::vector<glm::dmat4> to_part(tree.nodes.size());
        std::vector<std::uint32_t> part_of(tree.nodes.size());
        std::uint32_t parts = 0;
        for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
            const MotionNode& node = tree.nodes[n];
            const bool moves =
                parsed_.motion && parts < parsed_.motion->part_nodes.size() && parsed_.motion->part_nodes[parts] == n;
            if (moves) {
                part_of[n] = ++parts;
                to_part[n] = glm::dmat4(1.0);
            } else {
                to_part[n] = node.matrix ? *node.matrix : node.rest.matrix();
                if (node.parent != MotionNode::kNoParent) {
                    part_of[n] = part_of[node.parent];
                    to_part[n] = to_part[node.parent] * to_part[n];
                }
            }
            const tinygltf::Node& from = model_.nodes[tree.model_nodes[n]];
            if (from.mesh < 0) continue;
            if (static_cast<std::size_t>(from.mesh) >= model_.meshes.size()) {
                return data_.refuse(fmt::format("node {}: mesh {} of a file with {}", tree.model_nodes[n], from.mesh,
                                                model_.meshes.size()));
            }
            if (from.skin >= 0) ++skins_;
            if (auto ok = read_mesh(static_cast<std::size_t>(from.mesh), to_part[n], part_of[n]); !ok) return ok;
        }
        return {};
    }

    Expected<void> read_mesh(std::size_t number, const glm::dmat4& to_part, std::uint32_t part) {
        const tinygltf::Mesh& mesh = model_.meshes[number];
        for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
            const tinygltf::Primitive& primitive = mesh.primitives[p];
            const std::string where = fmt::format("mesh {} primitive {}", number, p);
            if (primitive.mode < TINYGLTF_MODE_POINTS || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN) {
                return data_.refuse(fmt::format("{}: mode {}, which glTF does not have", where, primitive.mode));
            }
            if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
                ++skipped_;
                continue;
            }
            if (!primitive.targets.empty()) has_morphs_ = true;
            if (auto ok = read_primitive(primitive, where, to_part, part); !ok) return ok;
        }
        return {};
    }

    Expected<void> read_primitive(const tinygltf::Primitive& primitive, const std::string& where,
                                  const glm::dmat4& to_part, std::uint32_t part) {
        const auto position = primitive.attributes.find("POSITION");
        if (position == primitive.attributes.end()) {
            return data_.refuse(fmt::format("{}: without POSITION", where));
        }
        std::vector<glm::dvec3>& positions = parsed_.mesh.positions;
        const auto first = static_cast<std::uint32_t>(positions.size());
        const auto numbers = data_.numbers(position->second, {3}, "POSITION", kMostGltfVertices - positions.size());
        if (!numbers) return tl::unexpected(numbers.error());
        const std::size_t count = numbers->count();
        for (std::size_t v = 0; v < count; ++v) {
            const double* p = &numbers->values[3 * v];
            positions.emplace_back(to_part * glm::dvec4(p[0], p[1], p[2], 1.0));
            const glm::dvec3& moved = positions.back();
            if (!std::isfinite(moved.x) || !std::isfinite(moved.y) || !std::isfinite(moved.z)) {
                return data_.refuse(fmt::format("{}: vertex {} is beyond the range of a double", where, v));
            }
        }
        if (parsed_.motion) parsed_.parts.resize(positions.size(), part);

        const std::size_t first_corner = parsed_.mesh.indices.size();
        auto corners = read_corners(primitive, count);
        if (!corners) return tl::unexpected(std::move(corners.error()));
        if (auto ok =
                add_triangles(primitive.mode, *corners, first, glm::determinant(glm::dmat3(to_part)) < 0.0, where);
            !ok) {
            return ok;
        }
        if (wants_colors_) {
            if (auto ok = read_colors(primitive, first, count, first_corner); !ok) lose_colors(ok.error());
        }
        return {};
    }

    Expected<std::vector<std::uint32_t>> read_corners(const tinygltf::Primitive& primitive, std::size_t count) {
        if (primitive.indices >= 0) return data_.indices(primitive.indices, count, 3 * kMostGltfTriangles);
        std::vector<std::uint32_t> corners(count);
        for (std::size_t v = 0; v < count; ++v) corners[v] = static_cast<std::uint32_t>(v);
        return corners;
    }

    Expected<void> add_triangles(int mode, const std::vector<std::uint32_t>& corners, std::uint32_t first,
                                 bool mirrored, const std::string& where) {
        const bool is_list = mode == TINYGLTF_MODE_TRIANGLES;
        if (is_list && corners.size() % 3 != 0) {
            return data_.refuse(fmt::format("{}: {} corners, which are no whole triangles", where, corners.size()));
        }
        const std::size_t triangles = is_list ? corners.size() / 3 : std::max<std::size_t>(corners.size(), 2) - 2;
        std::vector<std::uint32_t>& indices = parsed_.mesh.indices;
        if (triangles > kMostGltfTriangles - indices.size() / 3) {
            return fail(fmt::format("{}: more than {} triangles, the most that are read; simplify the model", source_,
                                    kMostGltfTriangles));
        }
        for (std::size_t t = 0; t < triangles; ++t) {
            Corners c{};
            if (is_list) {
                c = {corners[3 * t], corners[3 * t + 1], corners[3 * t + 2]};
            } else if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
                c = {corners[t + 1], corners[t + 2], corners[0]};
            } else {
                c = {corners[t], corners[t + 1 + t % 2], corners[t + 2 - t % 2]};
            }
            // Mirroring turns a surface inside out.
            if (mirrored) std::swap(c[1], c[2]);
            for (const std::uint32_t corner : c) indices.push_back(first + corner);
        }
        return {};
    }

    // The corners from `first_corner` on are of vertices from `first` on, `count` of them.
    Expected<void> read_colors(const tinygltf::Primitive& primitive, std::uint32_t first, std::size_t count,
                               std::size_t first_corner) {
        const std::vector<std::uint32_t>& indices = parsed_.mesh.indices;
        if (primitive.material >= 0 && static_cast<std::size_t>(primitive.material) >= model_.materials.size()) {
            return data_.refuse(
                fmt::format("material {} of a file with {}", primitive.material, model_.materials.size()));
        }
        const std::size_t material =
            primitive.material < 0 ? materials_.size() - 1 : static_cast<std::size_t>(primitive.material);
        const std::uint32_t number = number_of(material);
        for (std::size_t face = first_corner / 3; face < indices.size() / 3; ++face) colors_.set_material(face, number);

        const auto attribute =
            [&](const std::string& name,
                std::initializer_list<int> components) -> Expected<std::optional<GltfData::Numbers>> {
            const auto found = primitive.attributes.find(name);
            if (found == primitive.attributes.end()) return std::nullopt;
            auto numbers = data_.numbers(found->second, components, name, count);
            if (!numbers) return tl::unexpected(std::move(numbers.error()));
            if (numbers->count() != count) {
                return data_.refuse(fmt::format("{} of {} vertices for {}", name, numbers->count(), count));
            }
            return std::move(*numbers);
        };
        const auto tints = attribute("COLOR_0", {3, 4});
        if (!tints) return tl::unexpected(tints.error());
        if (*tints) {
            const auto width = static_cast<std::size_t>((*tints)->components);
            for (std::size_t c = first_corner; c < indices.size(); ++c) {
                const double* rgb = &(*tints)->values[(indices[c] - first) * width];
                for (int channel = 0; channel < 3; ++channel) {
                    if (!(rgb[channel] >= 0.0 && rgb[channel] <= 1.0)) {
                        return data_.refuse(fmt::format("COLOR_0 has {}, which is not in 0 … 1", rgb[channel]));
                    }
                }
                colors_.set_color(c, glm::vec3(rgb[0], rgb[1], rgb[2]));
            }
        }
        if (materials_[material].surface.image == SurfaceMaterial::kNoImage) return {};
        const auto places = attribute(fmt::format("TEXCOORD_{}", materials_[material].texcoord_set), {2});
        if (!places) return tl::unexpected(places.error());
        if (!*places)
            return data_.refuse(fmt::format("material {} has an image, but no texture coordinates", material));
        for (std::size_t c = first_corner; c < indices.size(); ++c) {
            const double* uv = &(*places)->values[(indices[c] - first) * 2];
            const glm::vec2 place = materials_[material].transformed({uv[0], uv[1]});
            if (!std::isfinite(place.x) || !std::isfinite(place.y)) {
                return data_.refuse(fmt::format("material {} moves texture coordinates beyond all range", material));
            }
            colors_.set_texcoord(c, place);
        }
        return {};
    }

    // The number among the materials that are used.
    std::uint32_t number_of(std::size_t material) {
        used_.resize(materials_.size(), SurfaceMaterial::kNoImage);
        if (used_[material] == SurfaceMaterial::kNoImage) {
            used_[material] = static_cast<std::uint32_t>(colors_.colors.materials.size());
            colors_.colors.materials.push_back(materials_[material].surface);
        }
        return used_[material];
    }

    void finish_colors() {
        if (wants_colors_) {
            auto images = read_gltf_images(model_, data_, source_, side_files_, colors_.colors.materials);
            images ? void(colors_.colors.images = std::move(*images)) : lose_colors(images.error());
        }
        if (!wants_colors_) return;
        parsed_.colors = std::move(colors_).finish(parsed_.mesh.indices.size(), parsed_.mesh.indices.size() / 3);
        drop_white(parsed_.colors);
    }

    void lose_colors(const Error& error) {
        wants_colors_ = false;
        parsed_.colors_fault = error.message;
    }

    void add_notes() {
        if (skins_ > 0)
            parsed_.notes.push_back(fmt::format("meshes with a skin, shown in their rest pose: {}", skins_));
        if (has_morphs_) parsed_.notes.push_back("morph targets, which are not shown");
        if (skipped_ > 0)
            parsed_.notes.push_back(fmt::format("primitives of points or lines, which are not shown: {}", skipped_));
    }

    const tinygltf::Model& model_;
    GltfData data_;
    std::string_view source_;
    const SideFiles& side_files_;
    bool wants_colors_;
    ParsedModel parsed_;
    std::vector<GltfMaterial> materials_;
    CornerColors colors_;
    std::vector<std::uint32_t> used_;
    std::size_t skins_ = 0;
    std::size_t skipped_ = 0;
    bool has_morphs_ = false;
};

}  // namespace

Expected<ParsedModel> parse_gltf(std::string_view bytes, std::string_view source, Wanted wanted,
                                 const SideFiles& side_files) {
    if (auto ok = check_size(bytes, source); !ok) return tl::unexpected(std::move(ok.error()));
    const auto model = load_gltf(bytes, source, side_files);
    if (!model) return tl::unexpected(model.error());
    return SceneReader(*model, source, wanted, side_files).read();
}

}  // namespace xorvox::io
