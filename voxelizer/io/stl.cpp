// STL, binary:  80 bytes of anything | u32 n | n × (normal 3 f32, corners 3 × 3 f32, u16 attribute)
//      text:    solid NAME { facet normal i j k  outer loop  { vertex x y z } × 3  endloop  endfacet } endsolid NAME
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include <fmt/format.h>

#include "voxelizer/io/formats.h"
#include "voxelizer/io/load.h"
#include "voxelizer/io/mesh_builder.h"
#include "voxelizer/io/mesh_file.h"
#include "voxelizer/io/text_scanner.h"

namespace xorvox::io {
namespace {

constexpr std::size_t kCountOffset = 80;
constexpr std::size_t kHeaderBytes = 84;
constexpr std::size_t kNormalBytes = 12;
constexpr std::size_t kTriangleBytes = 50;

Expected<Mesh> parse_binary(std::string_view bytes, std::string_view source) {
    const std::size_t count = (bytes.size() - kHeaderBytes) / kTriangleBytes;
    MeshBuilder builder;
    builder.reserve_vertices(3 * count);
    builder.reserve_triangles(count);
    for (std::size_t triangle = 0; triangle < count; ++triangle) {
        std::size_t offset = kHeaderBytes + triangle * kTriangleBytes + kNormalBytes;
        for (int corner = 0; corner < 3; ++corner) {
            glm::dvec3 position;
            for (int axis = 0; axis < 3; ++axis, offset += sizeof(float)) {
                const float value = load<float>(bytes.data() + offset);
                if (!std::isfinite(value)) {
                    return fail(
                        fmt::format("{}: byte {}: a coordinate of triangle {} is {}; repair or export the mesh again",
                                    source, offset, triangle, value));
                }
                position[axis] = static_cast<double>(value);
            }
            builder.add_corner(static_cast<std::uint32_t>(builder.vertex_count()));
            builder.add_vertex(position);
        }
        builder.end_face();
    }
    return std::move(builder).finish(source);
}

bool same_keyword(std::string_view word, std::string_view keyword) {
    return std::equal(word.begin(), word.end(), keyword.begin(), keyword.end(),
                      [](char a, char b) { return a == b || (a >= 'A' && a <= 'Z' && a + ('a' - 'A') == b); });
}

class TextParser {
public:
    TextParser(std::string_view text, std::string_view source) : scanner_(text), source_(source) {}

    Expected<Mesh> parse() && {
        bool ok = expect("solid");
        while (ok) {
            scanner_.skip_line();  // The name.
            ok = parse_solid();
            if (!ok || !scanner_.next_line()) break;
            ok = expect("solid");
        }
        if (!ok) return fail(std::move(error_));
        return std::move(builder_).finish(source_);
    }

private:
    bool parse_solid() {
        for (;;) {
            const std::string_view word = next_word();
            if (same_keyword(word, "endsolid")) {
                scanner_.skip_line();
                return true;
            }
            if (!same_keyword(word, "facet")) return unexpected(word, "'facet' or 'endsolid'");
            if (!parse_facet()) return false;
        }
    }

    bool parse_facet() {
        if (!expect("normal")) return false;
        for (int axis = 0; axis < 3; ++axis) {
            const std::string_view word = next_word();
            if (word.empty() || same_keyword(word, "outer")) return unexpected(word, "a normal of three numbers");
        }
        if (!expect("outer") || !expect("loop")) return false;
        for (int corner = 0; corner < 3; ++corner) {
            if (!expect("vertex") || !parse_vertex()) return false;
        }
        builder_.end_face();
        return expect("endloop") && expect("endfacet");
    }

    bool parse_vertex() {
        glm::dvec3 position;
        for (int axis = 0; axis < 3; ++axis) {
            const std::string_view word = next_word();
            if (word.empty()) return unexpected(word, "a coordinate");
            if (const char* wrong = read_number(word, position[axis])) {
                return failed(
                    fmt::format("the coordinate {} {}; repair or export the mesh again", quoted(word), wrong));
            }
        }
        builder_.add_corner(static_cast<std::uint32_t>(builder_.vertex_count()));
        builder_.add_vertex(position);
        return true;
    }

    std::string_view next_word() {
        std::string_view word = scanner_.word();
        if (word.empty() && scanner_.next_line()) word = scanner_.word();
        return word;
    }

    bool expect(std::string_view keyword) {
        const std::string_view word = next_word();
        return same_keyword(word, keyword) || unexpected(word, fmt::format("'{}'", keyword));
    }

    bool unexpected(std::string_view word, std::string_view wanted) {
        if (word.empty()) return failed(fmt::format("the file ends where {} is due; it was cut short", wanted));
        return failed(fmt::format("expected {}, found {}; export the mesh again", wanted, quoted(word)));
    }

    bool failed(std::string_view what) {
        error_ = fmt::format("{}: line {}: {}", source_, scanner_.line(), what);
        return false;
    }

    TextScanner scanner_;
    std::string_view source_;
    MeshBuilder builder_;
    std::string error_;
};

}  // namespace

bool has_size_of_binary_stl(std::string_view bytes) {
    return bytes.size() >= kHeaderBytes &&
           bytes.size() ==
               kHeaderBytes + kTriangleBytes * std::uint64_t{load<std::uint32_t>(bytes.data() + kCountOffset)};
}

bool begins_like_text_stl(std::string_view bytes) {
    TextScanner scanner(bytes);
    return scanner.next_line() && same_keyword(scanner.word(), "solid");
}

Expected<Mesh> parse_stl(std::string_view bytes, std::string_view source) {
    if (auto ok = check_size(bytes, source); !ok) return tl::unexpected(std::move(ok.error()));
    if (has_size_of_binary_stl(bytes)) return parse_binary(bytes, source);
    if (begins_like_text_stl(bytes)) return TextParser(bytes, source).parse();
    if (bytes.size() < kHeaderBytes) {
        return fail(
            fmt::format("{}: byte {}: the file ends, but a binary STL has at least {} bytes and a text one begins with "
                        "'solid'; it was cut short or is no STL",
                        source, bytes.size(), kHeaderBytes));
    }
    const std::uint32_t count = load<std::uint32_t>(bytes.data() + kCountOffset);
    return fail(
        fmt::format("{}: byte {}: {} triangles announced, which makes {} bytes, but the file has {}; it was cut short, "
                    "has something after its end, or is no STL",
                    source, kCountOffset, count, kHeaderBytes + kTriangleBytes * std::uint64_t{count}, bytes.size()));
}

}  // namespace xorvox::io
