// Volume files written by hand, in memory.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include <zlib.h>

namespace xorvox::test {

/// `number` as a file has it.
template <class T>
std::string raw(T number, bool big = false) {
    std::string bytes(sizeof(T), '\0');
    std::memcpy(bytes.data(), &number, sizeof(T));
    if (big) std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

template <class T>
std::string raw_all(const std::vector<T>& numbers, bool big = false) {
    std::string bytes;
    for (const T number : numbers) bytes += raw(number, big);
    return bytes;
}

inline std::string gzip(std::string bytes) {
    z_stream stream{};
    if (::deflateInit2(&stream, 6, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY) != Z_OK) return {};
    std::string packed(::deflateBound(&stream, bytes.size()) + 32, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(bytes.data());
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    (void)::deflate(&stream, Z_FINISH);
    packed.resize(stream.total_out);
    ::deflateEnd(&stream);
    return packed;
}

/// A NRRD header of 2 × 3 × 2 voxels; `more` has further lines.
inline std::string nrrd(std::string_view type, std::string_view encoding, std::string_view more = "") {
    return "NRRD0004\ntype: " + std::string(type) + "\ndimension: 3\nsizes: 2 3 2\nencoding: " + std::string(encoding) +
           "\n" + std::string(more) + "\n";
}

inline std::string chunk(std::string_view id, const std::string& content, const std::string& children = "") {
    return std::string(id) + raw<std::uint32_t>(static_cast<std::uint32_t>(content.size())) +
           raw<std::uint32_t>(static_cast<std::uint32_t>(children.size())) + content + children;
}

inline std::string vox(const std::string& chunks, std::uint32_t version = 150) {
    return "VOX " + raw(version) + chunk("MAIN", "", chunks);
}

/// SIZE and XYZI; `voxels` are x, y, z and colour.
inline std::string vox_model(std::uint32_t x, std::uint32_t y, std::uint32_t z, const std::string& voxels) {
    return chunk("SIZE", raw(x) + raw(y) + raw(z)) +
           chunk("XYZI", raw(static_cast<std::uint32_t>(voxels.size() / 4)) + voxels);
}

/// A string of a dictionary; and a dictionary of pairs.
inline std::string vox_text(const std::string& text) {
    return raw(static_cast<std::uint32_t>(text.size())) + text;
}
inline std::string vox_dictionary(const std::vector<std::string>& keys_and_values) {
    std::string bytes = raw(static_cast<std::uint32_t>(keys_and_values.size() / 2));
    for (const std::string& text : keys_and_values) bytes += vox_text(text);
    return bytes;
}
inline std::string vox_transform(std::uint32_t node, std::uint32_t child, const std::vector<std::string>& frame) {
    return chunk("nTRN", raw(node) + vox_dictionary({}) + raw(child) + raw<std::int32_t>(-1) + raw<std::int32_t>(-1) +
                             raw<std::uint32_t>(1) + vox_dictionary(frame));
}
inline std::string vox_group(std::uint32_t node, const std::vector<std::uint32_t>& children) {
    return chunk("nGRP",
                 raw(node) + vox_dictionary({}) + raw(static_cast<std::uint32_t>(children.size())) + raw_all(children));
}
inline std::string vox_shape(std::uint32_t node, const std::vector<std::uint32_t>& models) {
    std::string bytes = raw(node) + vox_dictionary({}) + raw(static_cast<std::uint32_t>(models.size()));
    for (const std::uint32_t model : models) bytes += raw(model) + vox_dictionary({});
    return chunk("nSHP", bytes);
}

/// A NIfTI-1 header of 2 × 3 × 2 voxels and the four bytes after it.
class Nifti1 {
public:
    explicit Nifti1(std::int16_t datatype, bool big = false) : big_(big) {
        put<std::int32_t>(0, 348);
        const std::int16_t dim[] = {3, 2, 3, 2, 1, 1, 1, 1};
        for (std::size_t n = 0; n < 8; ++n) put(40 + 2 * n, dim[n]);
        put(70, datatype);
        for (std::size_t n = 0; n < 8; ++n) put(76 + 4 * n, 1.0f);
        put(108, 352.0f);
        bytes_.replace(344, 4, std::string("n+1\0", 4));
    }
    template <class T>
    Nifti1& put(std::size_t at, T number) {
        bytes_.replace(at, sizeof(T), raw(number, big_));
        return *this;
    }
    const std::string& bytes() const { return bytes_; }

private:
    bool big_;
    std::string bytes_ = std::string(352, '\0');
};

}  // namespace xorvox::test
