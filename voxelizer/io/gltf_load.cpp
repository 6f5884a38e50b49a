// From bytes to tinygltf's Model, within bounds.
#include <exception>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "voxelizer/io/file_name.h"
#include "voxelizer/io/formats.h"
#include "voxelizer/io/gltf_model.h"
#include "voxelizer/io/json_limits.h"
#include "voxelizer/io/load.h"
#include "voxelizer/io/mesh_file.h"
#include "voxelizer/io/text_scanner.h"

namespace xorvox::io {
namespace {

constexpr std::size_t kGlbHeader = 12;
constexpr std::size_t kChunkHeader = 8;
constexpr std::uint32_t kJsonChunk = 0x4e4f534a;
constexpr FileKind kBufferFile{"a buffer", kMaxMeshFileBytes, "split the model"};

// What the callbacks of tinygltf work on.
struct Sides {
    const SideFiles& files;
    std::string_view source;
    std::set<std::string> read;
    std::size_t bytes = 0;
    std::string error;

    bool refuse(std::string what) {
        if (error.empty()) error = std::move(what);
        return false;
    }
};

// Images are read later, when their colours are wanted.
bool is_image_name(const std::string& name) {
    const std::string ending = extension_of(name);
    return ending == ".png" || ending == ".jpg" || ending == ".jpeg" || ending == ".webp" || ending == ".ktx2" ||
           ending == ".basis" || ending == ".dds" || ending == ".bmp" || ending == ".gif" || ending == ".tga";
}

bool exists(const std::string&, void*) {
    return true;
}

std::string unchanged(const std::string& name, void*) {
    return name;
}

bool read_buffer(std::vector<unsigned char>* out, std::string*, const std::string& name, void* user) {
    auto& sides = *static_cast<Sides*>(user);
    if (is_image_name(name) || name.starts_with("data:")) return false;
    if (!sides.read.insert(name).second) {
        return sides.refuse(
            fmt::format("{}: names the buffer {} twice; export the model again", sides.source, quoted(name)));
    }
    const auto bytes = sides.files.read(name, sides.source, kBufferFile);
    if (!bytes) return sides.refuse(bytes.error().message);
    sides.bytes += bytes->size();
    if (sides.bytes > kMaxMeshFileBytes) {
        return sides.refuse(fmt::format("{}: names buffers of more than {} bytes together; split the model",
                                        sides.source, kMaxMeshFileBytes));
    }
    out->assign(bytes->begin(), bytes->end());
    return true;
}

bool write_nothing(std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
    return false;
}

// The bytes of a data URI; those of a buffer view are unchecked here, and looked up later.
bool keep_image(tinygltf::Image* image, int, std::string*, std::string*, int, int, const unsigned char* bytes, int size,
                void*) {
    if (image->bufferView < 0 && size > 0) image->image.assign(bytes, bytes + size);
    return true;
}

// The JSON text of a GLB.
Expected<std::string_view> glb_json(std::string_view bytes, std::string_view source) {
    const auto refuse = [source](std::string_view what) { return fail(fmt::format("{}: {}", source, what)); };
    if (bytes.size() < kGlbHeader + kChunkHeader)
        return refuse("byte 0: the file ends in its header; it was cut short");
    const auto version = load<std::uint32_t>(bytes.data() + 4);
    if (version != 2)
        return refuse(fmt::format("byte 4: glTF version {}; only 2 is read: export as glTF 2.0", version));
    const auto length = load<std::uint32_t>(bytes.data() + 8);
    if (length != bytes.size()) {
        return refuse(
            fmt::format("byte 8: {} bytes announced, but the file has {}; it was cut short or has something "
                        "after its end",
                        length, bytes.size()));
    }
    const auto json_bytes = load<std::uint32_t>(bytes.data() + kGlbHeader);
    if (load<std::uint32_t>(bytes.data() + kGlbHeader + 4) != kJsonChunk) {
        return refuse("byte 16: the first chunk is not JSON; this is no GLB file");
    }
    if (json_bytes > bytes.size() - kGlbHeader - kChunkHeader) {
        return refuse(fmt::format("byte 12: a chunk of {} bytes is beyond the end of the file", json_bytes));
    }
    return bytes.substr(kGlbHeader + kChunkHeader, json_bytes);
}

// Required extensions that change nothing which is read here, or that are read.
bool is_known_extension(std::string_view name) {
    return name == "KHR_mesh_quantization" || name == "KHR_texture_transform" || name == "KHR_lights_punctual" ||
           name.starts_with("KHR_materials_");
}

// tinygltf's message, which may have lines and pieces of the file in it.
std::string in_one_line(const std::string& text) {
    constexpr std::size_t kLongest = 200;
    std::string line;
    for (const char c : text.substr(0, kLongest)) line += c == '\n' ? ' ' : (c >= ' ' && c <= '~' ? c : '?');
    while (line.ends_with(' ')) line.pop_back();
    return line;
}

}  // namespace

bool begins_like_glb(std::string_view bytes) {
    return bytes.starts_with("glTF");
}

Expected<tinygltf::Model> load_gltf(std::string_view bytes, std::string_view source, const SideFiles& side_files) {
    const bool is_glb = begins_like_glb(bytes);
    const auto json = is_glb ? glb_json(bytes, source) : Expected<std::string_view>(bytes);
    if (!json) return tl::unexpected(json.error());
    const JsonCounts counts = count_json(*json, "buffers");
    if (auto ok = check_json(counts, source); !ok) return tl::unexpected(std::move(ok.error()));
    if (is_glb && counts.objects_under_key > kMostGlbBuffers) {
        return fail(fmt::format("{}: {} buffers in a GLB, and at most {} are read; export the model again", source,
                                counts.objects_under_key, kMostGlbBuffers));
    }

    Sides sides{side_files, source, {}, 0, {}};
    tinygltf::TinyGLTF parser;
    parser.SetImageLoader(keep_image, nullptr);
    parser.SetFsCallbacks({exists, unchanged, read_buffer, write_nothing, &sides});
    tinygltf::Model model;
    std::string wrong;
    std::string warning;
    const auto size = static_cast<unsigned>(bytes.size());
    bool ok = false;
    try {
        ok = is_glb ? parser.LoadBinaryFromMemory(&model, &wrong, &warning,
                                                  reinterpret_cast<const unsigned char*>(bytes.data()), size)
                    : parser.LoadASCIIFromString(&model, &wrong, &warning, bytes.data(), size, "");
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& exception) {
        wrong = exception.what();
    }
    // tinygltf has them even when it fails for their sake.
    for (const std::string& extension : model.extensionsRequired) {
        if (is_known_extension(extension)) continue;
        return fail(fmt::format("{}: needs the glTF extension {}, which is not read; export the model without it",
                                source, quoted(extension)));
    }
    if (!sides.error.empty()) return fail(std::move(sides.error));
    if (!ok) {
        return fail(fmt::format("{}: is no sound glTF 2.0: {}; export the model again", source,
                                wrong.empty() ? "its JSON text is not understood" : in_one_line(wrong)));
    }
    if (!model.asset.version.starts_with("2.")) {
        return fail(fmt::format("{}: glTF version {}; only 2 is read: export as glTF 2.0", source,
                                quoted(model.asset.version)));
    }
    return model;
}

}  // namespace xorvox::io
