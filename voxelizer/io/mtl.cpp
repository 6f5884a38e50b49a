// Wavefront MTL, the material files of OBJ.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "voxelizer/io/obj_colors.h"
#include "voxelizer/io/text_scanner.h"

namespace xorvox::io {
namespace {

// Options of map_Kd and the most arguments that each has.
struct MapOption {
    std::string_view name;
    int arguments;
};
constexpr std::array<MapOption, 11> kMapOptions = {{{"-blendu", 1},
                                                    {"-blendv", 1},
                                                    {"-bm", 1},
                                                    {"-boost", 1},
                                                    {"-cc", 1},
                                                    {"-clamp", 1},
                                                    {"-imfchan", 1},
                                                    {"-mm", 2},
                                                    {"-o", 3},
                                                    {"-s", 3},
                                                    {"-t", 3}}};

bool is_number(std::string_view word) {
    double ignored = 0;
    return read_number(word, ignored) == nullptr;
}

// The first word of `text`, which it loses.
std::string_view next_word(std::string_view& text) {
    const std::size_t begin = std::min(text.find_first_not_of(" \t"), text.size());
    const std::size_t end = std::min(text.find_first_of(" \t", begin), text.size());
    const std::string_view word = text.substr(begin, end - begin);
    text.remove_prefix(std::min(text.find_first_not_of(" \t", end), text.size()));
    return word;
}

// "-clamp on -s 1 1 1 name with blanks.png"
void read_map(std::string_view text, MtlMaterial& material) {
    while (text.starts_with('-')) {
        std::string_view rest = text;
        const std::string_view name = next_word(rest);
        const auto option = std::find_if(kMapOptions.begin(), kMapOptions.end(),
                                         [name](const MapOption& known) { return known.name == name; });
        if (option == kMapOptions.end()) break;  // A name that begins so.
        if (option->arguments == 1) {
            const std::string_view value = next_word(rest);
            if (name == "-clamp") material.clamped = value == "on";
        } else {
            for (int i = 0; i < option->arguments; ++i) {
                std::string_view after = rest;
                if (!is_number(next_word(after))) break;
                rest = after;
            }
        }
        text = rest;
    }
    material.image = text;
}

}  // namespace

Expected<void> parse_mtl(std::string_view text, std::string_view source,
                         std::map<std::string, MtlMaterial, std::less<>>& materials) {
    TextScanner scanner(text, TextScanner::Dialect::Obj);
    MtlMaterial* material = nullptr;
    while (scanner.next_line()) {
        const std::string_view keyword = scanner.word();
        if (keyword == "newmtl") {
            material = &materials[std::string(scanner.rest_of_line())];
            *material = {};
        } else if (keyword == "Kd" && material) {
            const std::string_view first = scanner.word();
            if (first == "spectral" || first == "xyz") {
                scanner.skip_line();
                continue;
            }
            glm::dvec3 color;
            const std::string_view words[] = {first, scanner.word(), scanner.word()};
            for (int channel = 0; channel < 3; ++channel) {
                // One number stands for all three.
                const std::string_view word = words[words[1].empty() ? 0 : channel];
                if (read_number(word, color[channel]) != nullptr || color[channel] < 0.0 || color[channel] > 1.0) {
                    return fail(fmt::format("{}: line {}: the colour {} is no number in 0 … 1; repair the file", source,
                                            scanner.line(), quoted(word)));
                }
            }
            material->factor = linear_color(color);
            scanner.skip_line();
        } else if (keyword == "map_Kd" && material) {
            read_map(scanner.rest_of_line(), *material);
        } else {
            scanner.skip_line();
        }
    }
    return {};
}

}  // namespace xorvox::io
