#include "voxelizer/io/import_stream.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "voxelizer/io/load.h"

namespace xorvox::io {
namespace {

constexpr std::string_view kModel = "XORVOXI1";
constexpr std::string_view kError = "XORVOXE1";
static_assert(std::endian::native == std::endian::little);

class Writer {
public:
    template <class T>
    void put(const T& value) {
        bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
    }
    template <class T>
    void put_all(const std::vector<T>& values) {
        bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    }
    void put_text(std::string_view text) {
        put(static_cast<std::uint32_t>(text.size()));
        bytes.append(text);
    }

    std::string bytes;
};

class Reader {
public:
    explicit Reader(std::string_view bytes) : left_(bytes) {}

    /// False, and nothing is taken, when the bytes are not there.
    template <class T>
    bool take(T& value) {
        if (left_.size() < sizeof(T)) return false;
        value = load<T>(left_.data());
        left_.remove_prefix(sizeof(T));
        return true;
    }
    template <class T>
    bool take_all(std::vector<T>& values, std::size_t count) {
        if (count > left_.size() / sizeof(T)) return false;
        values.resize(count);
        if (count > 0) std::memcpy(static_cast<void*>(values.data()), left_.data(), count * sizeof(T));
        left_.remove_prefix(count * sizeof(T));
        return true;
    }
    bool take_text(std::string& text) {
        std::uint32_t length = 0;
        if (!take(length) || length > left_.size()) return false;
        text = left_.substr(0, length);
        left_.remove_prefix(length);
        return true;
    }
    std::size_t left() const { return left_.size(); }

private:
    std::string_view left_;
};

bool is_finite(const glm::dvec3& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

bool is_color(const glm::vec3& c) {
    const auto is_part = [](float part) { return part >= 0.0f && part <= 1.0f; };
    return is_part(c.r) && is_part(c.g) && is_part(c.b);
}

// Null, or what is wrong with the values.
const char* find_nonsense(const ImportedModel& model) {
    const auto all = [](const auto& values, auto holds) { return std::all_of(values.begin(), values.end(), holds); };
    if (!all(model.positions, is_finite)) return "a vertex is not finite";
    if (!all(model.indices, [&](std::uint32_t i) { return i < model.positions.size(); })) {
        return "a corner has a vertex that is not there";
    }
    std::uint64_t corners = 0;
    for (const std::uint32_t size : model.face_sizes) {
        if (size < 3) return "a face has less than three corners";
        corners += size;
    }
    if (corners != model.indices.size()) return "its faces do not have its corners";
    if (!all(model.face_materials, [&](std::uint32_t m) { return m < model.materials.size(); })) {
        return "a face has a material that is not there";
    }
    for (const SurfaceMaterial& material : model.materials) {
        if (material.image != SurfaceMaterial::kNoImage && material.image >= model.images.size()) {
            return "a material has an image that is not there";
        }
    }
    return nullptr;
}

bool take_wrap(Reader& reader, TextureWrap& wrap) {
    std::uint32_t number = 0;
    if (!reader.take(number) || number > static_cast<std::uint32_t>(TextureWrap::Clamp)) return false;
    wrap = static_cast<TextureWrap>(number);
    return true;
}

bool take_model(Reader& reader, ImportedModel& model) {
    std::array<std::uint32_t, 8> counts{};
    if (!reader.take(counts)) return false;
    const auto [vertices, corners, faces, materials, images, notes, has_colors, has_texcoords] = counts;
    if (!reader.take_all(model.positions, vertices) || !reader.take_all(model.indices, corners) ||
        !reader.take_all(model.face_sizes, faces) || !reader.take_all(model.face_materials, faces) ||
        !reader.take_all(model.corner_colors, has_colors != 0 ? corners : 0) ||
        !reader.take_all(model.corner_texcoords, has_texcoords != 0 ? corners : 0)) {
        return false;
    }
    // Grown one by one: each takes bytes of the stream, so that no count is believed.
    for (std::uint32_t m = 0; m < materials; ++m) {
        SurfaceMaterial& material = model.materials.emplace_back();
        if (!reader.take(material.factor) || !reader.take(material.image) || !take_wrap(reader, material.wrap_u) ||
            !take_wrap(reader, material.wrap_v)) {
            return false;
        }
    }
    for (std::uint32_t i = 0; i < images; ++i) {
        ImportedImage& image = model.images.emplace_back();
        std::uint32_t is_name = 0;
        if (!reader.take(is_name) || !reader.take_text(image.bytes)) return false;
        image.is_name = is_name != 0;
    }
    for (std::uint32_t n = 0; n < notes; ++n) {
        if (!reader.take_text(model.notes.emplace_back())) return false;
    }
    return reader.left() == 0;
}

}  // namespace

std::string encode_import(const ImportedModel& model) {
    const auto count = [](const auto& values) { return static_cast<std::uint32_t>(values.size()); };
    Writer out;
    out.bytes = kModel;
    out.put(std::array<std::uint32_t, 8>{count(model.positions), count(model.indices), count(model.face_sizes),
                                         count(model.materials), count(model.images), count(model.notes),
                                         model.corner_colors.empty() ? 0u : 1u,
                                         model.corner_texcoords.empty() ? 0u : 1u});
    out.put_all(model.positions);
    out.put_all(model.indices);
    out.put_all(model.face_sizes);
    out.put_all(model.face_materials);
    out.put_all(model.corner_colors);
    out.put_all(model.corner_texcoords);
    for (const SurfaceMaterial& material : model.materials) {
        out.put(material.factor);
        out.put(material.image);
        out.put(static_cast<std::uint32_t>(material.wrap_u));
        out.put(static_cast<std::uint32_t>(material.wrap_v));
    }
    for (const ImportedImage& image : model.images) {
        out.put(image.is_name ? 1u : 0u);
        out.put_text(image.bytes);
    }
    for (const std::string& note : model.notes) out.put_text(note);
    return std::move(out.bytes);
}

std::string encode_import_error(std::string_view why) {
    return std::string(kError) + std::string(why);
}

Expected<ImportedModel> parse_import(std::string_view bytes, bool& refused) {
    refused = bytes.starts_with(kError);
    if (refused) return fail(std::string(bytes.substr(kError.size())));
    if (!bytes.starts_with(kModel)) return fail(fmt::format("{} bytes that are no model", bytes.size()));
    Reader reader(bytes.substr(kModel.size()));
    ImportedModel model;
    if (!take_model(reader, model)) return fail(fmt::format("{} bytes whose counts cannot be", bytes.size()));
    if (const char* nonsense = find_nonsense(model)) return fail(nonsense);
    return model;
}

const char* color_fault(const ImportedModel& model) {
    const auto is_finite_pair = [](const glm::vec2& t) { return std::isfinite(t.x) && std::isfinite(t.y); };
    if (!std::all_of(model.corner_colors.begin(), model.corner_colors.end(), is_color)) {
        return "a vertex has a colour that is not in 0 … 1";
    }
    if (!std::all_of(model.corner_texcoords.begin(), model.corner_texcoords.end(), is_finite_pair)) {
        return "texture coordinates are not finite";
    }
    for (const SurfaceMaterial& material : model.materials) {
        if (!is_color(material.factor)) return "a material has a colour that is not in 0 … 1";
    }
    return nullptr;
}

}  // namespace xorvox::io
