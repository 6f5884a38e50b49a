// Wavefront OBJ: what is read and what is passed over is listed in mesh_file.h.
#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include <fmt/format.h>

#include "voxelizer/io/formats.h"
#include "voxelizer/io/mesh_builder.h"
#include "voxelizer/io/mesh_file.h"
#include "voxelizer/io/obj_colors.h"
#include "voxelizer/io/parsed_model.h"
#include "voxelizer/io/text_scanner.h"

namespace xorvox::io {
namespace {

template <std::size_t N>
constexpr bool is_one_of(std::string_view word, const std::array<std::string_view, N>& keywords) {
    return std::find(keywords.begin(), keywords.end(), word) != keywords.end();
}

// Data that a backslash may continue on the next line.
constexpr std::array<std::string_view, 5> kIgnoredData = {"vt", "vn", "vp", "l", "p"};
// Names and settings: the rest of the line is theirs, and a backslash at its end is the end of a Windows path.
constexpr std::array<std::string_view, 14> kIgnoredLines = {"o",        "g",        "s",          "usemtl",   "mtllib",
                                                            "mg",       "lod",      "usemap",     "maplib",   "bevel",
                                                            "c_interp", "d_interp", "shadow_obj", "trace_obj"};

class Parser {
public:
    Parser(std::string_view text, std::string_view source, Wanted wanted)
        : scanner_(text, TextScanner::Dialect::Obj), source_(source), wants_colors_(wanted == Wanted::ShapeAndColors) {}

    Expected<ParsedModel> parse(const SideFiles& side_files) && {
        while (scanner_.next_line()) {
            if (!parse_line()) return fail(std::move(error_));
        }
        if (highest_.vertex > builder_.vertex_count()) {
            return fail(fmt::format("{}: line {}: vertex {} of a file with {}; the file is damaged or was cut short",
                                    source_, highest_.line, highest_.vertex, builder_.vertex_count()));
        }
        auto mesh = std::move(builder_).finish(source_);
        if (!mesh) return tl::unexpected(std::move(mesh.error()));
        ParsedModel parsed;
        parsed.mesh = std::move(*mesh);
        if (wants_colors_) {
            auto colors = std::move(colors_).resolve(parsed.mesh.view(), source_, side_files);
            if (colors) {
                parsed.colors = std::move(*colors);
            } else {
                parsed.colors_fault = colors.error().message;
            }
        }
        return parsed;
    }

private:
    bool parse_line() {
        const std::string_view keyword = scanner_.word();
        if (keyword == "v") return parse_vertex();
        if (keyword == "f") return parse_face();
        if (wants_colors_) {
            if (keyword == "vt") return parse_texcoord();
            if (keyword == "usemtl") return take_name([this](std::string_view name) { colors_.use_material(name); });
            if (keyword == "mtllib") return take_name([this](std::string_view name) { colors_.add_library(name); });
        }
        if (is_one_of(keyword, kIgnoredData)) {
            while (!scanner_.word().empty()) {
            }
            return true;
        }
        if (is_one_of(keyword, kIgnoredLines)) {
            scanner_.skip_line();
            return true;
        }
        return failed(
            fmt::format("the keyword {} is not read; export the mesh as vertices and polygons", quoted(keyword)));
    }

    bool parse_vertex() {
        std::array<double, 7> numbers{};  // x y z, then nothing, a weight, r g b or r g b a.
        std::size_t count = 0;
        for (std::string_view word = scanner_.word(); !word.empty(); word = scanner_.word()) {
            if (count == numbers.size()) return failed("a vertex of more than 7 numbers; expected x y z");
            if (const char* wrong = read_number(word, numbers[count])) {
                return failed(
                    fmt::format("the coordinate {} {}; repair or export the mesh again", quoted(word), wrong));
            }
            ++count;
        }
        if (count < 3 || count == 5) return failed(fmt::format("a vertex of {} numbers; expected x y z", count));
        builder_.add_vertex({numbers[0], numbers[1], numbers[2]});
        if (wants_colors_ && count >= 6) {
            colors_.set_vertex_color(builder_.vertex_count() - 1, {numbers[3], numbers[4], numbers[5]});
        }
        return true;
    }

    // u, v and perhaps w; what is wrong with them is a fault of the colours, not of the shape.
    bool parse_texcoord() {
        std::array<double, 2> numbers{};
        bool ok = true;
        std::size_t count = 0;
        for (std::string_view word = scanner_.word(); !word.empty(); word = scanner_.word(), ++count) {
            if (count < numbers.size()) ok = ok && read_number(word, numbers[count]) == nullptr;
        }
        colors_.add_texcoord({numbers[0], numbers[1]}, ok && count > 0, scanner_.line());
        return true;
    }

    // The rest of the line; names have blanks in them.
    template <class Take>
    bool take_name(Take take) {
        take(scanner_.rest_of_line());
        return true;
    }

    bool parse_face() {
        std::size_t corners = 0;
        for (std::string_view word = scanner_.word(); !word.empty(); word = scanner_.word()) {
            if (!parse_corner(word)) return false;
            ++corners;
        }
        if (corners < 3) {
            return failed(fmt::format(
                "a face of {} corners; it needs at least three: remove it or export the mesh again", corners));
        }
        builder_.end_face();
        if (wants_colors_) colors_.end_face();
        return true;
    }

    // v, v/vt, v//vn or v/vt/vn.
    bool parse_corner(std::string_view word) {
        const std::size_t slash = word.find('/');
        std::int64_t number = 0;
        if (const char* wrong = read_number(word.substr(0, slash), number)) return bad_corner(word, wrong);
        if (slash != std::string_view::npos && !are_texture_and_normal(word.substr(slash + 1))) {
            return bad_corner(word, "is none of v, v/vt, v//vn and v/vt/vn");
        }
        const auto count = static_cast<std::int64_t>(builder_.vertex_count());
        if (number == 0) return bad_corner(word, "is vertex 0, but the first one is 1");
        if (number < -count) return bad_corner(word, fmt::format("goes back before the first of {} vertices", count));
        if (number > std::int64_t{UINT32_MAX}) return bad_corner(word, "is beyond the last vertex of any file");
        const std::int64_t vertex = number > 0 ? number : count + number + 1;
        if (static_cast<std::uint64_t>(vertex) > highest_.vertex) {
            highest_ = {static_cast<std::uint64_t>(vertex), scanner_.line()};
        }
        builder_.add_corner(static_cast<std::uint32_t>(vertex - 1));
        if (wants_colors_) {
            std::int64_t texcoord = 0;
            if (slash != std::string_view::npos) {
                const std::string_view rest = word.substr(slash + 1);
                read_number(rest.substr(0, rest.find('/')), texcoord);
            }
            colors_.add_corner(texcoord);
        }
        return true;
    }

    // Either may be missing: exporters write v//, too.
    static bool are_texture_and_normal(std::string_view word) {
        const std::size_t slash = word.find('/');
        return is_empty_or_whole(word.substr(0, slash)) &&
               (slash == std::string_view::npos || is_empty_or_whole(word.substr(slash + 1)));
    }

    static bool is_empty_or_whole(std::string_view word) {
        std::int64_t ignored = 0;
        return word.empty() || read_number(word, ignored) == nullptr;
    }

    bool bad_corner(std::string_view word, std::string_view wrong) {
        return failed(fmt::format("the corner {} {}; repair or export the mesh again", quoted(word), wrong));
    }

    bool failed(std::string_view what) {
        error_ = fmt::format("{}: line {}: {}", source_, scanner_.line(), what);
        return false;
    }

    TextScanner scanner_;
    std::string_view source_;
    MeshBuilder builder_;
    bool wants_colors_;
    ObjColors colors_;
    struct {
        std::uint64_t vertex = 0;
        std::size_t line = 0;
    } highest_;  // Checked at the end, because a face may come before its vertices.
    std::string error_;
};

}  // namespace

Expected<ParsedModel> parse_colored_obj(std::string_view bytes, std::string_view source, Wanted wanted,
                                        const SideFiles& side_files) {
    if (auto ok = check_size(bytes, source); !ok) return tl::unexpected(std::move(ok.error()));
    constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
    if (bytes.starts_with(kByteOrderMark)) bytes.remove_prefix(kByteOrderMark.size());
    return Parser(bytes, source, wanted).parse(side_files);
}

Expected<Mesh> parse_obj(std::string_view bytes, std::string_view source) {
    auto parsed = parse_colored_obj(bytes, source, Wanted::Shape, SideFiles());
    if (!parsed) return tl::unexpected(std::move(parsed.error()));
    return std::move(parsed->mesh);
}

}  // namespace xorvox::io
