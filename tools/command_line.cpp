#include "tools/command_line.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include <fmt/format.h>

namespace xorvox::tools {

std::uint32_t parse_count(const std::string& option, const std::string& text, std::uint32_t most) {
    std::uint32_t number = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (stop != text.data() + text.size() || error == std::errc::invalid_argument) {
        throw CLI::ValidationError(option, fmt::format("'{}' is not a whole number", text));
    }
    if (error != std::errc() || number > most) {
        throw CLI::ValidationError(option,
                                   fmt::format("'{}' is too large; it takes whole numbers up to {}", text, most));
    }
    return number;
}

double parse_positive(const std::string& option, const std::string& text) {
    const std::vector<double> numbers = parse_numbers(text);
    if (numbers.size() != 1 || !(numbers[0] > 0.0) || !std::isfinite(numbers[0])) {
        throw CLI::ValidationError(option, fmt::format("'{}' is not a number above zero", text));
    }
    return numbers[0];
}

std::vector<double> parse_numbers(const std::string& text) {
    std::vector<double> numbers;
    std::size_t at = 0;
    while (at <= text.size()) {
        const std::size_t comma = std::min(text.find(',', at), text.size());
        double number = 0.0;
        const char* end = text.data() + comma;
        const auto [stop, error] = std::from_chars(text.data() + at, end, number);
        if (error != std::errc() || stop != end) return {};
        numbers.push_back(number);
        at = comma + 1;
    }
    return numbers;
}

glm::dvec3 parse_vector(const std::string& option, const std::string& text, bool one_for_all) {
    const std::vector<double> numbers = parse_numbers(text);
    if (numbers.size() == 1 && one_for_all) return glm::dvec3(numbers[0]);
    if (numbers.size() != 3) {
        throw CLI::ValidationError(
            option, fmt::format("'{}' is not {}three numbers with commas between them, as in 1,2,3", text,
                                one_for_all ? "one number or " : ""));
    }
    return {numbers[0], numbers[1], numbers[2]};
}

void examples(CLI::App& app, const std::string& text) {
    app.footer("Examples:\n" + text);
}

void add_mesh(CLI::App& app, MeshOptions& mesh) {
    app.add_option("mesh", mesh.path,
                   "The mesh: a .ply, .stl, .obj, .gltf or .glb file, or a rarer one, as .fbx or .dae")
        ->required()
        ->type_name("MESH");
    add_reading(app, mesh);
}

void add_reading(CLI::App& app, MeshOptions& mesh) {
    app.add_option("--unit", mesh.unit, "The unit of the file's numbers, which then become millimetres")
        ->type_name("mm|cm|m|in|ft");
    app.add_option("--up", mesh.up,
                   "The axis that points up in the file; the mesh is turned so that it is z (default: what the format "
                   "defines, y for glTF; z where it defines nothing, as PLY, STL and OBJ)")
        ->type_name("x|y|z");
}

void add_strict(CLI::App& app, MeshOptions& mesh) {
    app.add_flag("--strict", mesh.strict, "Refuse a mesh with open edges, instead of a warning");
}

}  // namespace xorvox::tools
