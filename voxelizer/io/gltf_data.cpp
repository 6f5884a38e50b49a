// Accessors: the glTF 2.0 specification, section 3.6.2.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "voxelizer/io/gltf_model.h"
#include "voxelizer/io/load.h"

namespace xorvox::io {
namespace {

// Bytes of a component; 0: a type that glTF does not have.
std::size_t component_bytes(int type) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return 1;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        case TINYGLTF_COMPONENT_TYPE_FLOAT: return 4;
        default: return 0;
    }
}

// Columns of matrices of small components would be padded; nothing that is read here has such.
int components_of(const tinygltf::Accessor& accessor) {
    switch (accessor.type) {
        case TINYGLTF_TYPE_SCALAR: return 1;
        case TINYGLTF_TYPE_VEC2: return 2;
        case TINYGLTF_TYPE_VEC3: return 3;
        case TINYGLTF_TYPE_VEC4: return 4;
        default: return 0;
    }
}

std::uint32_t load_unsigned(const char* at, int type) {
    if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) return load<std::uint8_t>(at);
    if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) return load<std::uint16_t>(at);
    return load<std::uint32_t>(at);
}

double load_number(const char* at, int type, bool normalized) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_FLOAT: return static_cast<double>(load<float>(at));
        case TINYGLTF_COMPONENT_TYPE_BYTE: {
            const double value = load<std::int8_t>(at);
            return normalized ? std::max(value / 127.0, -1.0) : value;
        }
        case TINYGLTF_COMPONENT_TYPE_SHORT: {
            const double value = load<std::int16_t>(at);
            return normalized ? std::max(value / 32767.0, -1.0) : value;
        }
        default: {
            const double value = load_unsigned(at, type);
            const double most = type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE    ? 255.0
                                : type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ? 65535.0
                                                                                 : 4294967295.0;
            return normalized ? value / most : value;
        }
    }
}

bool is_unsigned(int type) {
    return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
           type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

template <class Container>
bool has(const Container& container, int number) {
    return number >= 0 && static_cast<std::size_t>(number) < container.size();
}

}  // namespace

tl::unexpected<Error> GltfData::refuse(std::string_view what) const {
    return fail(fmt::format("{}: {}; repair or export the model again", source_, what));
}

Expected<std::string_view> GltfData::view(int number) const {
    if (!has(model_.bufferViews, number)) {
        return refuse(fmt::format("buffer view {} of a file with {}", number, model_.bufferViews.size()));
    }
    const tinygltf::BufferView& view = model_.bufferViews[static_cast<std::size_t>(number)];
    if (!has(model_.buffers, view.buffer)) {
        return refuse(
            fmt::format("buffer view {}: buffer {} of a file with {}", number, view.buffer, model_.buffers.size()));
    }
    const auto& data = model_.buffers[static_cast<std::size_t>(view.buffer)].data;
    if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset) {
        return refuse(fmt::format("buffer view {}: {} bytes from byte {} of a buffer of {}", number, view.byteLength,
                                  view.byteOffset, data.size()));
    }
    return std::string_view(reinterpret_cast<const char*>(data.data()) + view.byteOffset, view.byteLength);
}

Expected<const tinygltf::Accessor*> GltfData::accessor(int number, std::size_t most_elements) const {
    if (!has(model_.accessors, number)) {
        return refuse(fmt::format("accessor {} of a file with {}", number, model_.accessors.size()));
    }
    const tinygltf::Accessor& accessor = model_.accessors[static_cast<std::size_t>(number)];
    if (accessor.count > most_elements) {
        return fail(
            fmt::format("{}: accessor {} has {} elements, and at most {} more are read; split or simplify the "
                        "model",
                        source_, number, accessor.count, most_elements));
    }
    return &accessor;
}

Expected<std::size_t> GltfData::count(int number) const {
    if (!has(model_.accessors, number)) {
        return refuse(fmt::format("accessor {} of a file with {}", number, model_.accessors.size()));
    }
    return model_.accessors[static_cast<std::size_t>(number)].count;
}

Expected<GltfData::Elements> GltfData::elements(int number, std::size_t offset, std::size_t count, std::size_t size,
                                                std::string_view where) const {
    const auto bytes = view(number);
    if (!bytes) return tl::unexpected(bytes.error());
    const std::size_t given = model_.bufferViews[static_cast<std::size_t>(number)].byteStride;
    const std::size_t stride = given == 0 ? size : given;
    if (stride < size) return refuse(fmt::format("{}: a stride of {} bytes for elements of {}", where, stride, size));
    if (count > 0 && (offset > bytes->size() || size > bytes->size() - offset ||
                      count - 1 > (bytes->size() - offset - size) / stride)) {
        return refuse(fmt::format("{}: {} elements of {} bytes from byte {} of a buffer view of {}", where, count, size,
                                  offset, bytes->size()));
    }
    return Elements{bytes->data() + (count > 0 ? offset : 0), stride};
}

Expected<GltfData::Numbers> GltfData::numbers(int number, std::initializer_list<int> components, std::string_view what,
                                              std::size_t most_elements) {
    const auto found = accessor(number, most_elements);
    if (!found) return tl::unexpected(found.error());
    const tinygltf::Accessor& accessor = **found;
    const std::string where = fmt::format("accessor {} ({})", number, what);
    Numbers numbers{components_of(accessor), {}};
    const std::size_t bytes = component_bytes(accessor.componentType);
    if (std::find(components.begin(), components.end(), numbers.components) == components.end() || bytes == 0) {
        return refuse(fmt::format("{}: type {} of component type {} is not what it may have", where, accessor.type,
                                  accessor.componentType));
    }
    const auto width = static_cast<std::size_t>(numbers.components);
    if (accessor.bufferView < 0) {
        blanks_ += accessor.count;
        if (blanks_ > kMostGltfBlanks) {
            return refuse(fmt::format("{}: {} elements without a buffer view, more than {} in all", where,
                                      accessor.count, kMostGltfBlanks));
        }
        numbers.values.resize(accessor.count * width);
    } else {
        const auto from = elements(accessor.bufferView, accessor.byteOffset, accessor.count, width * bytes, where);
        if (!from) return tl::unexpected(from.error());
        numbers.values.reserve(accessor.count * width);
        for (std::size_t e = 0; e < accessor.count; ++e) {
            for (std::size_t c = 0; c < width; ++c) {
                numbers.values.push_back(load_number(from->first + e * from->stride + c * bytes, accessor.componentType,
                                                     accessor.normalized));
            }
        }
    }
    if (accessor.sparse.isSparse) {
        if (auto ok = read_sparse(number, accessor, width, numbers.values); !ok) {
            return tl::unexpected(std::move(ok.error()));
        }
    }
    for (std::size_t i = 0; i < numbers.values.size(); ++i) {
        if (!std::isfinite(numbers.values[i])) {
            return refuse(fmt::format("{}: element {} has the value {}", where, i / width, numbers.values[i]));
        }
    }
    return numbers;
}

Expected<void> GltfData::read_sparse(int number, const tinygltf::Accessor& accessor, std::size_t width,
                                     std::vector<double>& values) const {
    const auto& sparse = accessor.sparse;
    const std::string where = fmt::format("accessor {} (sparse)", number);
    if (sparse.count < 0 || static_cast<std::size_t>(sparse.count) > accessor.count || sparse.indices.byteOffset < 0 ||
        sparse.values.byteOffset < 0 || !is_unsigned(sparse.indices.componentType)) {
        return refuse(fmt::format("{}: its count, offsets or type of indices cannot be", where));
    }
    const auto count = static_cast<std::size_t>(sparse.count);
    const std::size_t bytes = component_bytes(accessor.componentType);
    const auto indices = elements(sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset), count,
                                  component_bytes(sparse.indices.componentType), where);
    if (!indices) return tl::unexpected(indices.error());
    const auto from = elements(sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset), count,
                               width * bytes, where);
    if (!from) return tl::unexpected(from.error());
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t element = load_unsigned(indices->first + i * indices->stride, sparse.indices.componentType);
        if (element >= accessor.count)
            return refuse(fmt::format("{}: element {} of {}", where, element, accessor.count));
        for (std::size_t c = 0; c < width; ++c) {
            values[element * width + c] =
                load_number(from->first + i * from->stride + c * bytes, accessor.componentType, accessor.normalized);
        }
    }
    return {};
}

Expected<std::vector<std::uint32_t>> GltfData::indices(int number, std::size_t end, std::size_t most_elements) {
    const auto found = accessor(number, most_elements);
    if (!found) return tl::unexpected(found.error());
    const tinygltf::Accessor& accessor = **found;
    const std::string where = fmt::format("accessor {} (indices)", number);
    if (components_of(accessor) != 1 || !is_unsigned(accessor.componentType) || accessor.sparse.isSparse) {
        return refuse(fmt::format("{}: not plain scalars of an unsigned type", where));
    }
    const auto from = elements(accessor.bufferView, accessor.byteOffset, accessor.count,
                               component_bytes(accessor.componentType), where);
    if (!from) return tl::unexpected(from.error());
    std::vector<std::uint32_t> indices(accessor.count);
    for (std::size_t i = 0; i < accessor.count; ++i) {
        indices[i] = load_unsigned(from->first + i * from->stride, accessor.componentType);
        if (indices[i] >= end) {
            return refuse(fmt::format("{}: element {} is vertex {} of {}", where, i, indices[i], end));
        }
    }
    return indices;
}

}  // namespace xorvox::io
