#include "voxelizer/io/ply_header.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "voxelizer/io/formats.h"
#include "voxelizer/io/text_scanner.h"

namespace xorvox::io {
namespace {

std::optional<PlyType> type_called(std::string_view name) {
    if (name == "char" || name == "int8") return PlyType::Int8;
    if (name == "uchar" || name == "uint8") return PlyType::Uint8;
    if (name == "short" || name == "int16") return PlyType::Int16;
    if (name == "ushort" || name == "uint16") return PlyType::Uint16;
    if (name == "int" || name == "int32") return PlyType::Int32;
    if (name == "uint" || name == "uint32") return PlyType::Uint32;
    if (name == "float" || name == "float32") return PlyType::Float32;
    if (name == "double" || name == "float64") return PlyType::Float64;
    return std::nullopt;
}

PlyRole role_of(std::string_view element, std::string_view property) {
    if (element == "vertex") {
        if (property == "x") return PlyRole::X;
        if (property == "y") return PlyRole::Y;
        if (property == "z") return PlyRole::Z;
        if (property == "red") return PlyRole::Red;
        if (property == "green") return PlyRole::Green;
        if (property == "blue") return PlyRole::Blue;
    } else if (element == "face" && (property == "vertex_indices" || property == "vertex_index")) {
        return PlyRole::Corners;
    }
    return PlyRole::Skipped;
}

bool is_color(PlyRole role) {
    return role == PlyRole::Red || role == PlyRole::Green || role == PlyRole::Blue;
}

bool has_role(const PlyElement& element, PlyRole role) {
    return std::any_of(element.properties.begin(), element.properties.end(),
                       [role](const PlyProperty& property) { return property.role == role; });
}

class HeaderParser {
public:
    HeaderParser(std::string_view bytes, std::string_view source) : bytes_(bytes), source_(source) {}

    Expected<PlyHeader> parse() && {
        if (!parse_lines() || !check_elements()) return fail(std::move(error_));
        header_.data_offset = next_;
        header_.data_line = line_ + 1;
        return std::move(header_);
    }

private:
    bool parse_lines() {
        if (!next_line()) return false;
        if (!end_of_line()) return false;
        if (!next_line()) return false;
        while (keyword_ == "comment" || keyword_ == "obj_info") {
            if (!next_line()) return false;
        }
        if (!parse_format()) return false;
        while (next_line()) {
            if (keyword_ == "end_header") return end_of_line();
            if (keyword_ == "element") {
                if (!parse_element()) return false;
            } else if (keyword_ == "property") {
                if (!parse_property()) return false;
            } else if (keyword_ != "comment" && keyword_ != "obj_info") {
                return failed(fmt::format("expected 'element', 'property', 'comment' or 'end_header', found {}",
                                          quoted(keyword_)));
            }
        }
        return false;
    }

    bool parse_format() {
        if (keyword_ != "format") return failed(fmt::format("expected 'format', found {}", quoted(keyword_)));
        const std::string_view name = words_.word();
        if (name == "ascii") {
            header_.encoding = PlyEncoding::Ascii;
        } else if (name == "binary_little_endian") {
            header_.encoding = PlyEncoding::BinaryLittleEndian;
        } else if (name == "binary_big_endian") {
            header_.encoding = PlyEncoding::BinaryBigEndian;
        } else {
            return failed(fmt::format(
                "the format {} is not known; use ascii, binary_little_endian or binary_big_endian", quoted(name)));
        }
        const std::string_view version = words_.word();
        if (version != "1.0") return failed(fmt::format("the version {} is not known; use 1.0", quoted(version)));
        return end_of_line();
    }

    bool parse_element() {
        const std::string_view name = words_.word();
        const std::string_view count = words_.word();
        std::int64_t number = 0;
        const char* wrong = read_number(count, number);
        if (wrong || number < 0) {
            return failed(fmt::format("the count {} of element {} {}", quoted(count), quoted(name),
                                      wrong ? wrong : "is negative"));
        }
        const bool is_read = name == "vertex" || name == "face";
        if (is_read && find(name)) return failed(fmt::format("a second element {}; expected one", quoted(name)));
        header_.elements.push_back({name, static_cast<std::uint64_t>(number), {}});
        return end_of_line();
    }

    // property TYPE NAME | property list COUNT_TYPE TYPE NAME
    bool parse_property() {
        if (header_.elements.empty()) return failed("a property before the first element");
        PlyProperty property;
        std::string_view type = words_.word();
        if (type == "list") {
            property.is_list = true;
            const std::string_view count_type = words_.word();
            if (!set_type(property.count_type, count_type)) return false;
            if (!is_integer(property.count_type)) {
                return failed(fmt::format("the length of a list is {}; expected an integer type", quoted(count_type)));
            }
            type = words_.word();
        }
        if (!set_type(property.type, type)) return false;
        const std::string_view name = words_.word();
        if (name.empty()) return failed("a property without a name");
        PlyElement& element = header_.elements.back();
        property.role = role_of(element.name, name);
        // A colour that is no plain one is as good as none.
        if (is_color(property.role) && (property.is_list || has_role(element, property.role))) {
            property.role = PlyRole::Skipped;
        }
        if (property.role != PlyRole::Skipped) {
            if (has_role(element, property.role))
                return failed(fmt::format("a second property {}; expected one", quoted(name)));
            const bool is_corners = property.role == PlyRole::Corners;
            if (property.is_list != is_corners || (is_corners && !is_integer(property.type))) {
                return failed(fmt::format("the property {} must be {}", quoted(name),
                                          is_corners ? "a list of integers" : "a single number"));
            }
        }
        element.properties.push_back(property);
        return end_of_line();
    }

    bool set_type(PlyType& type, std::string_view name) {
        const auto known = type_called(name);
        if (!known) {
            return failed(
                fmt::format("the type {} is not known; PLY has char, uchar, short, ushort, int, uint, float, double",
                            quoted(name)));
        }
        type = *known;
        return true;
    }

    bool check_elements() {
        const PlyElement* vertex = find("vertex");
        const PlyElement* face = find("face");
        if (!vertex || !has_role(*vertex, PlyRole::X) || !has_role(*vertex, PlyRole::Y) ||
            !has_role(*vertex, PlyRole::Z)) {
            return failed("no element 'vertex' with properties x, y and z; a mesh needs positions");
        }
        if (!face || !has_role(*face, PlyRole::Corners)) {
            return failed(
                "no element 'face' with a list vertex_indices; export the mesh as polygons, not as points or strips");
        }
        header_.vertex_count = vertex->count;
        header_.has_colors =
            has_role(*vertex, PlyRole::Red) && has_role(*vertex, PlyRole::Green) && has_role(*vertex, PlyRole::Blue);
        return true;
    }

    const PlyElement* find(std::string_view name) const {
        const auto found = std::find_if(header_.elements.begin(), header_.elements.end(),
                                        [name](const PlyElement& element) { return element.name == name; });
        return found == header_.elements.end() ? nullptr : &*found;
    }

    // Takes the next line's first word into keyword_; words_ has the rest.
    bool next_line() {
        ++line_;
        const std::size_t end = bytes_.find('\n', next_);
        if (end == std::string_view::npos) return failed("the file ends within the header; it was cut short");
        words_ = TextScanner(bytes_.substr(next_, end - next_));
        next_ = end + 1;
        keyword_ = words_.word();
        return true;
    }

    bool end_of_line() {
        const std::string_view word = words_.word();
        return word.empty() || failed(fmt::format("unexpected {} at the end of the line", quoted(word)));
    }

    bool failed(std::string_view what) {
        error_ = fmt::format("{}: line {}: {}", source_, line_, what);
        return false;
    }

    std::string_view bytes_;
    std::string_view source_;
    std::size_t next_ = 0;
    std::size_t line_ = 0;
    TextScanner words_{std::string_view{}};
    std::string_view keyword_;
    PlyHeader header_;
    std::string error_;
};

}  // namespace

bool begins_like_ply(std::string_view bytes) {
    return bytes.starts_with("ply\n") || bytes.starts_with("ply\r");
}

Expected<PlyHeader> parse_ply_header(std::string_view bytes, std::string_view source) {
    if (!begins_like_ply(bytes)) {
        return fail(fmt::format("{}: line 1: expected 'ply', found {}; this is no PLY file", source,
                                quoted(bytes.substr(0, 8))));
    }
    return HeaderParser(bytes, source).parse();
}

}  // namespace xorvox::io
