// xorvox-import FILE: reads a model by assimp and writes it to standard output, as voxelizer/io/import_stream.h says.
//
// A program of its own, because assimp may crash, hang or eat all memory on a damaged file. Before it opens the file it
// gives up what it does not need: memory, time, writing files, the network, other programs. tools/import_sandbox.h says
// how.
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <assimp/material.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <unistd.h>
#include <assimp/Importer.hpp>
#include <glm/mat4x4.hpp>

#include "tools/import_sandbox.h"
#include "voxelizer/io/import_stream.h"

namespace {

using xorvox::SurfaceMaterial;
using xorvox::TextureWrap;
using xorvox::io::ImportedModel;

glm::dmat4 matrix(const aiMatrix4x4& m) {
    glm::dmat4 result(1.0);
    for (unsigned row = 0; row < 4; ++row) {
        for (unsigned column = 0; column < 4; ++column) {
            result[static_cast<int>(column)][static_cast<int>(row)] = static_cast<double>(m[row][column]);
        }
    }
    return result;
}

TextureWrap wrap(int mode) {
    if (mode == aiTextureMapMode_Clamp || mode == aiTextureMapMode_Decal) return TextureWrap::Clamp;
    return mode == aiTextureMapMode_Mirror ? TextureWrap::Mirror : TextureWrap::Repeat;
}

class Converter {
public:
    explicit Converter(const aiScene& scene) : scene_(scene) {}

    ImportedModel convert() {
        for (unsigned m = 0; m < scene_.mNumMaterials; ++m) add_material(*scene_.mMaterials[m]);
        if (model_.materials.empty()) model_.materials.emplace_back();
        struct Waiting {
            const aiNode* node;
            glm::dmat4 to_scene;
        };
        std::vector<Waiting> waiting;
        if (scene_.mRootNode) waiting.push_back({scene_.mRootNode, glm::dmat4(1.0)});
        while (!waiting.empty()) {
            const Waiting next = waiting.back();
            waiting.pop_back();
            const glm::dmat4 to_scene = next.to_scene * matrix(next.node->mTransformation);
            for (unsigned m = 0; m < next.node->mNumMeshes; ++m) {
                if (next.node->mMeshes[m] >= scene_.mNumMeshes) throw std::runtime_error("a node has no such mesh");
                add_mesh(*scene_.mMeshes[next.node->mMeshes[m]], to_scene);
            }
            for (unsigned c = next.node->mNumChildren; c-- > 0;) waiting.push_back({next.node->mChildren[c], to_scene});
        }
        if (!model_.corner_colors.empty()) model_.corner_colors.resize(model_.indices.size(), glm::vec3(1.0f));
        if (!model_.corner_texcoords.empty()) model_.corner_texcoords.resize(model_.indices.size(), glm::vec2(0.0f));
        add_notes();
        return std::move(model_);
    }

private:
    void add_material(const aiMaterial& from) {
        SurfaceMaterial& material = model_.materials.emplace_back();
        aiColor3D color(1.0f, 1.0f, 1.0f);
        from.Get(AI_MATKEY_COLOR_DIFFUSE, color);
        material.factor = {color.r, color.g, color.b};
        int& uv_set = uv_sets_.emplace_back(0);
        for (const aiTextureType type : {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE}) {
            aiString name;
            if (from.GetTexture(type, 0, &name) != aiReturn_SUCCESS || name.length == 0) continue;
            int mode = 0;
            if (from.Get(AI_MATKEY_MAPPINGMODE_U(type, 0), mode) == aiReturn_SUCCESS) material.wrap_u = wrap(mode);
            if (from.Get(AI_MATKEY_MAPPINGMODE_V(type, 0), mode) == aiReturn_SUCCESS) material.wrap_v = wrap(mode);
            from.Get(AI_MATKEY_UVWSRC(type, 0), uv_set);
            add_image(name, material);
            return;
        }
    }

    void add_image(const aiString& name, SurfaceMaterial& material) {
        const aiTexture* embedded = scene_.GetEmbeddedTexture(name.C_Str());
        if (embedded && embedded->mHeight != 0) {
            ++raw_images_;
            return;
        }
        material.image = static_cast<std::uint32_t>(model_.images.size());
        if (embedded) {
            model_.images.push_back({false, {reinterpret_cast<const char*>(embedded->pcData), embedded->mWidth}});
        } else {
            model_.images.push_back({true, {name.data, name.length}});
        }
    }

    void add_mesh(const aiMesh& mesh, const glm::dmat4& to_scene) {
        if (mesh.mNumBones > 0) ++skins_;
        if (!mesh.HasPositions()) return;
        const std::size_t first = model_.positions.size();
        if (first + mesh.mNumVertices > 0xffff'ffffu) throw std::runtime_error("it has too many vertices");
        for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
            const aiVector3D& p = mesh.mVertices[v];
            model_.positions.emplace_back(to_scene * glm::dvec4(static_cast<double>(p.x), static_cast<double>(p.y),
                                                                static_cast<double>(p.z), 1.0));
        }
        const unsigned material = mesh.mMaterialIndex < model_.materials.size() ? mesh.mMaterialIndex : 0;
        const auto uv_set = static_cast<unsigned>(material < uv_sets_.size() ? uv_sets_[material] : 0);
        const bool has_texcoords = uv_set < AI_MAX_NUMBER_OF_TEXTURECOORDS && mesh.HasTextureCoords(uv_set);
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            if (face.mNumIndices < 3) {
                ++flat_faces_;
                continue;
            }
            for (unsigned c = 0; c < face.mNumIndices; ++c) {
                const unsigned vertex = face.mIndices[c];
                if (vertex >= mesh.mNumVertices) throw std::runtime_error("a face has a vertex that is not there");
                if (mesh.HasVertexColors(0)) {
                    const aiColor4D& color = mesh.mColors[0][vertex];
                    model_.corner_colors.resize(model_.indices.size(), glm::vec3(1.0f));
                    model_.corner_colors.emplace_back(color.r, color.g, color.b);
                }
                if (has_texcoords) {
                    const aiVector3D& uv = mesh.mTextureCoords[uv_set][vertex];
                    model_.corner_texcoords.resize(model_.indices.size(), glm::vec2(0.0f));
                    model_.corner_texcoords.emplace_back(uv.x, 1.0f - uv.y);
                }
                model_.indices.push_back(static_cast<std::uint32_t>(first + vertex));
            }
            model_.face_sizes.push_back(face.mNumIndices);
            model_.face_materials.push_back(material);
        }
    }

    void add_notes() {
        const auto note = [this](std::size_t count, std::string_view what) {
            if (count > 0) model_.notes.push_back(fmt::format("{}: {}", what, count));
        };
        note(scene_.mNumAnimations, "animations, which are not read from this format");
        note(skins_, "meshes with a skin, shown in their rest pose");
        note(flat_faces_, "points or lines, which are not shown");
        note(raw_images_, "images of plain pixels, shown white");
    }

    const aiScene& scene_;
    ImportedModel model_;
    std::vector<int> uv_sets_;
    std::size_t skins_ = 0;
    std::size_t flat_faces_ = 0;
    std::size_t raw_images_ = 0;
};

std::string import(const char* path) {
    try {
        xorvox::tools::give_up_what_is_not_needed();
        Assimp::Importer importer;
        importer.SetIOHandler(new xorvox::tools::ModelFiles(path));  // Which it owns.
        const aiScene* scene = importer.ReadFile(path, 0);
        if (!scene) return xorvox::io::encode_import_error(importer.GetErrorString());
        return encode_import(Converter(*scene).convert());
    } catch (const std::bad_alloc&) {
        return xorvox::io::encode_import_error("it needs more than 4 GiB of memory");
    } catch (const std::exception& exception) {
        return xorvox::io::encode_import_error(exception.what());
    }
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 2 || isatty(STDOUT_FILENO) != 0) {
        std::fputs("xorvox-import FILE: used by xorvox to read the rarer mesh formats; not for people\n", stderr);
        return 2;
    }
    const std::string bytes = import(arguments[1]);
    const bool written = std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size() && std::fflush(stdout) == 0;
    // assimp's destructors have nothing to do that matters, and may crash.
    std::_Exit(written ? 0 : 2);
}
