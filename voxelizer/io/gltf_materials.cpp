#include "voxelizer/io/gltf_materials.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "voxelizer/elementary.h"
#include "voxelizer/io/formats.h"
#include "voxelizer/io/image_file.h"
#include "voxelizer/io/model_images.h"

namespace xorvox::io {
namespace {

Expected<TextureWrap> wrap_of(int mode, const GltfData& data) {
    if (mode == TINYGLTF_TEXTURE_WRAP_REPEAT) return TextureWrap::Repeat;
    if (mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) return TextureWrap::Mirror;
    if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return TextureWrap::Clamp;
    return data.refuse(fmt::format("a sampler wraps by mode {}, which glTF does not have", mode));
}

Expected<void> read_texture(const tinygltf::Model& model, const GltfData& data, int number, SurfaceMaterial& surface) {
    const auto in = [](int n, std::size_t count) { return n >= 0 && static_cast<std::size_t>(n) < count; };
    if (!in(number, model.textures.size())) {
        return data.refuse(fmt::format("texture {} of a file with {}", number, model.textures.size()));
    }
    const tinygltf::Texture& texture = model.textures[static_cast<std::size_t>(number)];
    if (!in(texture.source, model.images.size())) {
        return data.refuse(fmt::format("texture {}: its image is none of PNG and JPEG, or missing", number));
    }
    surface.image = static_cast<std::uint32_t>(texture.source);
    if (texture.sampler < 0) return {};
    if (!in(texture.sampler, model.samplers.size())) {
        return data.refuse(
            fmt::format("texture {}: sampler {} of a file with {}", number, texture.sampler, model.samplers.size()));
    }
    const tinygltf::Sampler& sampler = model.samplers[static_cast<std::size_t>(texture.sampler)];
    const auto u = wrap_of(sampler.wrapS, data);
    const auto v = wrap_of(sampler.wrapT, data);
    if (!u || !v) return tl::unexpected(u ? v.error() : u.error());
    surface.wrap_u = *u;
    surface.wrap_v = *v;
    return {};
}

Expected<void> read_transform(const tinygltf::Value& extension, const GltfData& data, GltfMaterial& material) {
    const auto pair = [&extension](const char* name, glm::dvec2& value) {
        if (!extension.Has(name)) return true;
        const tinygltf::Value& array = extension.Get(name);
        if (!array.IsArray() || array.ArrayLen() != 2 || !array.Get(0).IsNumber() || !array.Get(1).IsNumber()) {
            return false;
        }
        value = {array.Get(0).GetNumberAsDouble(), array.Get(1).GetNumberAsDouble()};
        return std::isfinite(value.x) && std::isfinite(value.y);
    };
    const auto number = [&extension](const char* name, double& value) {
        if (!extension.Has(name)) return true;
        if (!extension.Get(name).IsNumber()) return false;
        value = extension.Get(name).GetNumberAsDouble();
        return std::isfinite(value);
    };
    double set = material.texcoord_set;
    if (!extension.IsObject() || !pair("scale", material.scale) || !pair("offset", material.offset) ||
        !number("rotation", material.rotation) || !number("texCoord", set) || set < 0.0 || set > 255.0) {
        return data.refuse("a KHR_texture_transform whose numbers cannot be");
    }
    material.texcoord_set = static_cast<int>(set);
    return {};
}

Expected<GltfMaterial> read_material(const tinygltf::Model& model, const GltfData& data, std::size_t number) {
    const tinygltf::PbrMetallicRoughness& pbr = model.materials[number].pbrMetallicRoughness;
    GltfMaterial material;
    if (pbr.baseColorFactor.size() < 3) {
        return data.refuse(
            fmt::format("material {}: a baseColorFactor of {} numbers", number, pbr.baseColorFactor.size()));
    }
    for (int channel = 0; channel < 3; ++channel) {
        const double value = pbr.baseColorFactor[static_cast<std::size_t>(channel)];
        if (!(value >= 0.0 && value <= 1.0)) {
            return data.refuse(
                fmt::format("material {}: baseColorFactor has {}, which is not in 0 … 1", number, value));
        }
        material.surface.factor[channel] = static_cast<float>(value);
    }
    const tinygltf::TextureInfo& texture = pbr.baseColorTexture;
    if (texture.index < 0) return material;
    material.texcoord_set = texture.texCoord;
    if (auto ok = read_texture(model, data, texture.index, material.surface); !ok) {
        return tl::unexpected(std::move(ok.error()));
    }
    const auto transform = texture.extensions.find("KHR_texture_transform");
    if (transform != texture.extensions.end()) {
        if (auto ok = read_transform(transform->second, data, material); !ok) {
            return tl::unexpected(std::move(ok.error()));
        }
    }
    return material;
}

Expected<Image> read_image_of(const tinygltf::Model& model, const GltfData& data, std::size_t number,
                              std::string_view source, const SideFiles& side_files) {
    const tinygltf::Image& image = model.images[number];
    const std::string name = fmt::format("{}: image {}", source, number);
    if (image.bufferView >= 0) {
        const auto bytes = data.view(image.bufferView);
        if (!bytes) return tl::unexpected(bytes.error());
        return decode_image(*bytes, name);
    }
    if (!image.image.empty()) {
        return decode_image({reinterpret_cast<const char*>(image.image.data()), image.image.size()}, name);
    }
    const auto bytes = side_files.read(percent_decoded(image.uri), source, kImageFile);
    if (!bytes) return tl::unexpected(bytes.error());
    return decode_image(*bytes, name);
}

}  // namespace

glm::vec2 GltfMaterial::transformed(const glm::dvec2& texcoord) const {
    const glm::dvec2 scaled = texcoord * scale;
    // Counterclockwise as an image is seen, whose v runs downward.
    const double c = elementary::cos(rotation);
    const double s = elementary::sin(rotation);
    return glm::vec2(glm::dvec2(c * scaled.x + s * scaled.y, c * scaled.y - s * scaled.x) + offset);
}

Expected<std::vector<GltfMaterial>> read_gltf_materials(const tinygltf::Model& model, const GltfData& data) {
    std::vector<GltfMaterial> materials;
    for (std::size_t m = 0; m < model.materials.size(); ++m) {
        auto material = read_material(model, data, m);
        if (!material) return tl::unexpected(std::move(material.error()));
        materials.push_back(*material);
    }
    materials.emplace_back();
    return materials;
}

Expected<std::vector<Image>> read_gltf_images(const tinygltf::Model& model, const GltfData& data,
                                              std::string_view source, const SideFiles& side_files,
                                              std::vector<SurfaceMaterial>& used) {
    ModelImages images(source);
    std::vector<std::uint32_t> new_number(model.images.size(), SurfaceMaterial::kNoImage);
    for (SurfaceMaterial& material : used) {
        if (material.image == SurfaceMaterial::kNoImage) continue;
        std::uint32_t& number = new_number[material.image];
        if (number == SurfaceMaterial::kNoImage) {
            const auto added = images.add(read_image_of(model, data, material.image, source, side_files));
            if (!added) return tl::unexpected(added.error());
            number = *added;
        }
        material.image = number;
    }
    return std::move(images).take();
}

}  // namespace xorvox::io
