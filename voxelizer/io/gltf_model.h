// A glTF file as tinygltf gives it, and checked access to what it points into. Private to voxelizer/io.
//
// tinygltf parses JSON, base64 and GLB, and checks hardly anything: every number of a Model may be wrong. What all
// functions here return is checked; what they refuse, they refuse with an error that begins with the file's name.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include <tiny_gltf.h>

#include "voxelizer/error.h"
#include "voxelizer/io/side_files.h"

namespace xorvox::io {

// What a glTF file may come to, however small it is: instances of a mesh cost its file nothing.
inline constexpr std::size_t kMostGltfTriangles = std::size_t{1} << 24;
inline constexpr std::size_t kMostGltfVertices = std::size_t{1} << 25;
inline constexpr std::size_t kMostGltfKeys = std::size_t{1} << 24;
/// Elements of accessors without a buffer view, which are zeros that no byte stands for.
inline constexpr std::size_t kMostGltfBlanks = std::size_t{1} << 18;
/// Each buffer of a GLB may be a copy of its binary chunk.
inline constexpr std::size_t kMostGlbBuffers = 16;

/// Parses `bytes`, JSON or GLB, and reads the buffers beside the file. Images are not decoded: Image::image has the
/// bytes of a data URI, else it is empty.
Expected<tinygltf::Model> load_gltf(std::string_view bytes, std::string_view source, const SideFiles& side_files);

/// Reads accessors and buffer views of a model that it borrows.
class GltfData {
public:
    GltfData(const tinygltf::Model& model, std::string_view source) : model_(model), source_(source) {}

    /// The elements of accessor number `accessor`, one after the other: `components` numbers each, all finite,
    /// normalized ones in 0 … 1 or -1 … 1. `what` stands in errors: "POSITION".
    struct Numbers {
        int components = 0;
        std::vector<double> values;

        std::size_t count() const { return values.size() / static_cast<std::size_t>(components); }
    };
    Expected<Numbers> numbers(int accessor, std::initializer_list<int> components, std::string_view what,
                              std::size_t most_elements);

    /// Those of an accessor of unsigned integers, all below `end`.
    Expected<std::vector<std::uint32_t>> indices(int accessor, std::size_t end, std::size_t most_elements);

    /// The elements that accessor number `accessor` announces.
    Expected<std::size_t> count(int accessor) const;

    /// The bytes of buffer view number `view`, borrowed from the model.
    Expected<std::string_view> view(int view) const;

    tl::unexpected<Error> refuse(std::string_view what) const;

private:
    struct Elements {
        const char* first = nullptr;
        std::size_t stride = 0;
    };
    Expected<const tinygltf::Accessor*> accessor(int number, std::size_t most_elements) const;
    Expected<Elements> elements(int view, std::size_t offset, std::size_t count, std::size_t size,
                                std::string_view where) const;
    Expected<void> read_sparse(int number, const tinygltf::Accessor& accessor, std::size_t components,
                               std::vector<double>& values) const;

    const tinygltf::Model& model_;
    std::string source_;
    std::size_t blanks_ = 0;
};

}  // namespace xorvox::io
