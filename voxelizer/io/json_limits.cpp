#include "voxelizer/io/json_limits.h"

#include <algorithm>

#include <fmt/format.h>

namespace xorvox::io {

JsonCounts count_json(std::string_view text, std::string_view key) {
    JsonCounts counts;
    std::size_t depth = 0;
    bool under_key = false;
    std::string_view last_string;
    for (std::size_t i = 0; i < text.size(); ++i) {
        switch (text[i]) {
            case '"': {
                const std::size_t begin = i + 1;
                for (++i; i < text.size() && text[i] != '"'; ++i) {
                    if (text[i] == '\\') ++i;
                }
                last_string = text.substr(begin, std::min(i, text.size()) - begin);
                break;
            }
            case ':':
                if (depth == 1) under_key = last_string == key || last_string.find('\\') != std::string_view::npos;
                break;
            case ',': ++counts.values; break;
            case '{':
                ++counts.objects;
                if (depth == 2 && under_key) ++counts.objects_under_key;
                [[fallthrough]];
            case '[':
                ++counts.values;
                counts.depth = std::max(counts.depth, ++depth);
                break;
            case '}':
            case ']': depth -= depth > 0 ? 1 : 0; break;
            default: break;
        }
    }
    return counts;
}

Expected<void> check_json(const JsonCounts& counts, std::string_view source) {
    const auto beyond = [source](std::string_view what, std::size_t found, std::size_t most) {
        return fail(fmt::format("{}: {} {} in its JSON text, and at most {} are read; split the model", source, found,
                                what, most));
    };
    if (counts.depth > kMostJsonDepth) return beyond("nested levels", counts.depth, kMostJsonDepth);
    if (counts.values > kMostJsonValues) return beyond("values", counts.values, kMostJsonValues);
    if (counts.objects > kMostJsonObjects) return beyond("objects", counts.objects, kMostJsonObjects);
    return {};
}

}  // namespace xorvox::io
