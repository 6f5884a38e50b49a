// PLY 1.0 (Greg Turk): the header says which elements follow and of what their entries consist; then come the entries.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/vector_relational.hpp>

#include "voxelizer/io/corner_colors.h"
#include "voxelizer/io/formats.h"
#include "voxelizer/io/load.h"
#include "voxelizer/io/mesh_builder.h"
#include "voxelizer/io/mesh_file.h"
#include "voxelizer/io/parsed_model.h"
#include "voxelizer/io/ply_header.h"
#include "voxelizer/io/text_scanner.h"

namespace xorvox::io {
namespace {

constexpr const char* kTooFew = "the line has too few values";
constexpr const char* kCutShort = "the file ends here; it was cut short";

// Values of a list, besides its length, in an entry as short as can be when faces have `corners` corners.
constexpr std::size_t least_items(const PlyProperty& property, std::size_t corners) {
    return property.role == PlyRole::Corners ? corners : 0;
}

// TextValues and BinaryValues: the values of the entries, one after the other. What fails returns false and says why in
// wrong(); where() is the place of the value read last.

class TextValues {
public:
    TextValues(std::string_view bytes, const PlyHeader& header)
        : scanner_(bytes.substr(header.data_offset), TextScanner::Dialect::Plain, header.data_line) {}

    /// The most entries of `element`, with so many corners a face, that can be in what is left: a digit and a separator
    /// for each value.
    std::size_t room_for(const PlyElement& element, std::size_t corners) const {
        std::size_t least = 0;
        for (const PlyProperty& property : element.properties) least += 2 * (1 + least_items(property, corners));
        return (scanner_.bytes_left() + 1) / least;
    }
    bool begin_entry() { return scanner_.next_line() || failed(kCutShort); }
    bool number(PlyType, double& value) { return read(value); }
    bool integer(PlyType, std::int64_t& value) { return read(value); }
    /// What is passed over need not be a number: normals of faces without area are "nan".
    bool skip(PlyType, std::uint64_t count) {
        for (; count > 0; --count) {
            if (scanner_.word().empty()) return failed(kTooFew);
        }
        return true;
    }
    bool end_entry() {
        const std::string_view word = scanner_.word();
        return word.empty() || failed(fmt::format("unexpected {} after the last value of the line", quoted(word)));
    }
    bool at_end() {
        return !scanner_.next_line() ||
               failed(fmt::format("unexpected {} after the last element", quoted(scanner_.word())));
    }

    std::string where() const { return fmt::format("line {}", scanner_.line()); }
    const std::string& wrong() const { return wrong_; }

private:
    template <class Number>
    bool read(Number& value) {
        const std::string_view word = scanner_.word();
        if (word.empty()) return failed(kTooFew);
        const char* wrong = read_number(word, value);
        return !wrong || failed(fmt::format("{} {}", quoted(word), wrong));
    }
    bool failed(std::string wrong) {
        wrong_ = std::move(wrong);
        return false;
    }

    TextScanner scanner_;
    std::string wrong_;
};

class BinaryValues {
public:
    BinaryValues(std::string_view bytes, const PlyHeader& header)
        : bytes_(bytes),
          next_(header.data_offset),
          order_(header.encoding == PlyEncoding::BinaryBigEndian ? std::endian::big : std::endian::little) {}

    std::size_t room_for(const PlyElement& element, std::size_t corners) {
        place_ = next_;
        std::size_t least = 0;
        for (const PlyProperty& property : element.properties) {
            least += property.is_list
                         ? size_of(property.count_type) + least_items(property, corners) * size_of(property.type)
                         : size_of(property.type);
        }
        return left() / least;
    }
    bool begin_entry() { return true; }
    bool number(PlyType type, double& value) {
        if (!take(size_of(type))) return false;
        value = type == PlyType::Float32   ? static_cast<double>(load<float>(at(), order_))
                : type == PlyType::Float64 ? load<double>(at(), order_)
                                           : static_cast<double>(load_integer(type));
        if (!std::isfinite(value)) return failed(fmt::format("the value {} is not a finite number", value));
        return true;
    }
    bool integer(PlyType type, std::int64_t& value) {
        if (!take(size_of(type))) return false;
        value = load_integer(type);
        return true;
    }
    bool skip(PlyType type, std::uint64_t count) {
        place_ = next_;
        if (count > left() / size_of(type)) return failed(kCutShort);
        next_ += static_cast<std::size_t>(count) * size_of(type);
        return true;
    }
    bool end_entry() { return true; }
    bool at_end() {
        place_ = next_;
        return left() == 0 ||
               failed(
                   fmt::format("{} more bytes after the last element; cut them off or export the mesh again", left()));
    }

    std::string where() const { return fmt::format("byte {}", place_); }
    const std::string& wrong() const { return wrong_; }

private:
    std::size_t left() const { return bytes_.size() - next_; }
    const char* at() const { return bytes_.data() + place_; }
    bool take(std::size_t size) {
        place_ = next_;
        if (size > left()) return failed(kCutShort);
        next_ += size;
        return true;
    }
    std::int64_t load_integer(PlyType type) const {
        switch (type) {
            case PlyType::Int8: return load<std::int8_t>(at(), order_);
            case PlyType::Uint8: return load<std::uint8_t>(at(), order_);
            case PlyType::Int16: return load<std::int16_t>(at(), order_);
            case PlyType::Uint16: return load<std::uint16_t>(at(), order_);
            case PlyType::Int32: return load<std::int32_t>(at(), order_);
            case PlyType::Uint32: return load<std::uint32_t>(at(), order_);
            case PlyType::Float32:
            case PlyType::Float64: break;
        }
        return 0;
    }
    bool failed(std::string wrong) {
        wrong_ = std::move(wrong);
        return false;
    }

    std::string_view bytes_;
    std::size_t next_;
    std::endian order_;
    std::size_t place_ = 0;
    std::string wrong_;
};

template <class Values>
class BodyParser {
public:
    BodyParser(std::string_view bytes, const PlyHeader& header, std::string_view source, Wanted wanted)
        : header_(header),
          source_(source),
          values_(bytes, header),
          wants_colors_(header.has_colors && wanted == Wanted::ShapeAndColors) {}

    Expected<ParsedModel> parse() && {
        for (const PlyElement& element : header_.elements) {
            if (!parse_element(element)) return fail(std::move(error_));
        }
        if (!values_.at_end()) return fail(fmt::format("{}: {}: {}", source_, values_.where(), values_.wrong()));
        auto mesh = std::move(builder_).finish(source_);
        if (!mesh) return tl::unexpected(std::move(mesh.error()));
        ParsedModel parsed;
        parsed.mesh = std::move(*mesh);
        parsed.colors_fault = std::move(colors_fault_);
        if (wants_colors_) {
            parsed.colors.corner_colors.reserve(parsed.mesh.indices.size());
            for (const std::uint32_t v : parsed.mesh.indices) parsed.colors.corner_colors.push_back(colors_[v]);
        }
        return parsed;
    }

private:
    bool parse_element(const PlyElement& element) {
        entry_ = 0;
        if (element.properties.empty()) return true;
        // Faces of no corners, so that one of too few is named as such when it is read.
        if (element.count > values_.room_for(element, 0)) {
            error_ = fmt::format(
                "{}: {}: {} entries of element {} announced, but the file is too short for them; it was cut short or "
                "its header is wrong",
                source_, values_.where(), element.count, quoted(element.name));
            return false;
        }
        if (element.name == "vertex") builder_.reserve_vertices(static_cast<std::size_t>(element.count));
        if (element.name == "face") {
            builder_.reserve_triangles(
                static_cast<std::size_t>(std::min<std::uint64_t>(element.count, values_.room_for(element, 3))));
        }
        for (; entry_ < element.count; ++entry_) {
            if (!parse_entry(element)) return failed(element);
        }
        return true;
    }

    bool parse_entry(const PlyElement& element) {
        if (!values_.begin_entry()) return false;
        glm::dvec3 position{0.0};
        glm::dvec3 color{1.0};
        for (const PlyProperty& property : element.properties) {
            if (!parse_value(property, position, color)) return false;
        }
        if (element.name == "vertex") {
            builder_.add_vertex(position);
            if (wants_colors_) add_color(color);
        }
        return values_.end_entry();
    }

    void add_color(const glm::dvec3& color) {
        if (glm::all(glm::greaterThanEqual(color, glm::dvec3(0.0))) &&
            glm::all(glm::lessThanEqual(color, glm::dvec3(1.0)))) {
            colors_.push_back(linear_color(color));
            return;
        }
        wants_colors_ = false;
        colors_ = {};
        colors_fault_ = fmt::format(
            "{}: {}: entry {} of element 'vertex' has a colour beyond the range of its type (0 … 1 for float); export "
            "the mesh again",
            source_, values_.where(), entry_);
    }

    bool parse_value(const PlyProperty& property, glm::dvec3& position, glm::dvec3& color) {
        switch (property.role) {
            case PlyRole::X: return values_.number(property.type, position.x);
            case PlyRole::Y: return values_.number(property.type, position.y);
            case PlyRole::Z: return values_.number(property.type, position.z);
            case PlyRole::Red: return parse_color(property, color.r);
            case PlyRole::Green: return parse_color(property, color.g);
            case PlyRole::Blue: return parse_color(property, color.b);
            case PlyRole::Corners: return parse_face(property);
            case PlyRole::Skipped: break;
        }
        if (!property.is_list) return values_.skip(property.type, 1);
        std::int64_t length = 0;
        if (!values_.integer(property.count_type, length)) return false;
        if (length < 0) return wrong(fmt::format("a list of {} values", length));
        return values_.skip(property.type, static_cast<std::uint64_t>(length));
    }

    bool parse_color(const PlyProperty& property, double& value) {
        if (!wants_colors_) return values_.skip(property.type, 1);
        if (!values_.number(property.type, value)) return false;
        if (is_integer(property.type)) value /= property.type == PlyType::Uint16 ? 65535.0 : 255.0;
        return true;
    }

    bool parse_face(const PlyProperty& property) {
        std::int64_t corners = 0;
        if (!values_.integer(property.count_type, corners)) return false;
        if (corners < 3) return wrong(fmt::format("a polygon of {} corners; it needs at least three", corners));
        for (; corners > 0; --corners) {
            std::int64_t vertex = 0;
            if (!values_.integer(property.type, vertex)) return false;
            if (static_cast<std::uint64_t>(vertex) >= header_.vertex_count) {  // Negative ones become huge.
                return wrong(fmt::format("vertex {} of a file with {}", vertex, header_.vertex_count));
            }
            builder_.add_corner(static_cast<std::uint32_t>(vertex));
        }
        builder_.end_face();
        return true;
    }

    bool wrong(std::string what) {
        wrong_ = std::move(what);
        return false;
    }

    bool failed(const PlyElement& element) {
        error_ = fmt::format("{}: {}: entry {} of element {}: {}; repair or export the mesh again", source_,
                             values_.where(), entry_, quoted(element.name), wrong_.empty() ? values_.wrong() : wrong_);
        return false;
    }

    const PlyHeader& header_;
    std::string_view source_;
    Values values_;
    MeshBuilder builder_;
    bool wants_colors_;
    std::vector<glm::vec3> colors_;  // One a vertex, linear light.
    std::string colors_fault_;
    std::uint64_t entry_ = 0;
    std::string wrong_;
    std::string error_;
};

}  // namespace

Expected<ParsedModel> parse_colored_ply(std::string_view bytes, std::string_view source, Wanted wanted) {
    if (auto ok = check_size(bytes, source); !ok) return tl::unexpected(std::move(ok.error()));
    auto header = parse_ply_header(bytes, source);
    if (!header) return tl::unexpected(std::move(header.error()));
    if (header->encoding == PlyEncoding::Ascii) return BodyParser<TextValues>(bytes, *header, source, wanted).parse();
    return BodyParser<BinaryValues>(bytes, *header, source, wanted).parse();
}

Expected<Mesh> parse_ply(std::string_view bytes, std::string_view source) {
    auto parsed = parse_colored_ply(bytes, source, Wanted::Shape);
    if (!parsed) return tl::unexpected(std::move(parsed.error()));
    return std::move(parsed->mesh);
}

}  // namespace xorvox::io
