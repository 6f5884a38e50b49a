#include "voxelizer/io/file_name.h"

#include <fmt/format.h>

namespace xorvox::io {

std::string extension_of(std::string_view path) {
    const std::size_t dot = path.find_last_of("./");
    if (dot == std::string_view::npos || path[dot] == '/') return {};
    std::string extension(path.substr(dot));
    for (char& c : extension) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + ('a' - 'A'));
    }
    return extension;
}

std::string volume_extension_of(std::string_view path) {
    std::string extension = extension_of(path);
    if (extension == ".gz" && extension_of(path.substr(0, path.size() - extension.size())) == ".nii") return ".nii.gz";
    return extension;
}

std::string printable_name(std::string_view name) {
    std::string text;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const auto byte = static_cast<unsigned char>(name[i]);
        const auto next = static_cast<unsigned char>(i + 1 < name.size() ? name[i + 1] : 0);
        if (byte < 0x20 || byte == 0x7f) {
            text += fmt::format("\\x{:02x}", byte);
        } else if (byte == 0xc2 && next >= 0x80 && next < 0xa0) {
            text += fmt::format("\\x{:02x}", next);
            ++i;
        } else {
            text += name[i];
        }
    }
    return text;
}

}  // namespace xorvox::io
