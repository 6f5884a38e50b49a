// The extension that a file's format is chosen by. Private to voxelizer/io.
#pragma once

#include <string>
#include <string_view>

namespace xorvox::io {

/// From the last dot of the last part of `path`, in lower case: ".ply". Empty when there is no dot.
inline std::string extension_of(std::string_view path) {
    const std::size_t dot = path.find_last_of("./");
    if (dot == std::string_view::npos || path[dot] == '/') return {};
    std::string extension(path.substr(dot));
    for (char& c : extension) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + ('a' - 'A'));
    }
    return extension;
}

}  // namespace xorvox::io
