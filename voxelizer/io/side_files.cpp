#include "voxelizer/io/side_files.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include <fmt/format.h>
#include <sys/stat.h>

#include "voxelizer/io/file_name.h"
#include "voxelizer/io/text_scanner.h"

namespace xorvox::io {
namespace {

// Null, or why `name` may not be read.
const char* forbidden(std::string_view name) {
    if (name.empty()) return "is no name";
    if (name.find('\0') != std::string_view::npos) return "is no name of a file";
    if (name.find("://") != std::string_view::npos || name.starts_with("data:")) return "is no file";
    if (name.front() == '/' || name.front() == '\\' || (name.size() > 1 && name[1] == ':'))
        return "is an absolute path";
    for (std::size_t begin = 0; begin <= name.size();) {
        const std::size_t end = std::min(name.find_first_of("/\\", begin), name.size());
        if (name.substr(begin, end - begin) == "..") return "leads out of the folder";
        begin = end + 1;
    }
    return nullptr;
}

}  // namespace

SideFiles::SideFiles(const std::string& model_path) : any_(true) {
    const std::size_t slash = model_path.rfind('/');
    if (slash != std::string::npos) folder_ = model_path.substr(0, slash + 1);
}

Expected<std::string> SideFiles::read(std::string_view mention, std::string_view source, const FileKind& kind) const {
    const char* wrong = any_ ? forbidden(mention) : "is another file";
    if (wrong) {
        return fail(
            fmt::format("{}: names {}, which {}; only files beside it are read", source, quoted(mention), wrong));
    }
    const std::string path = folder_ + std::string(mention);
    struct stat info {};
    if (::stat(path.c_str(), &info) == 0 && !S_ISREG(info.st_mode)) {
        return fail(fmt::format("{}: names {}, which is no regular file", source, quoted(mention)));
    }
    auto bytes = read_file(path, printable_name(path), kind);
    if (!bytes) return fail(fmt::format("{}: names a file that it needs: {}", source, bytes.error().message));
    return bytes;
}

Expected<std::string> SideFiles::read_by_name(std::string_view mention, std::string_view source,
                                              const FileKind& kind) const {
    auto bytes = read(mention, source, kind);
    const std::size_t slash = mention.find_last_of("/\\");
    if (bytes || slash == std::string_view::npos) return bytes;
    auto other = read(mention.substr(slash + 1), source, kind);
    return other ? std::move(other) : std::move(bytes);
}

std::string percent_decoded(std::string_view uri) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        unsigned byte = 0;
        if (uri[i] == '%' && uri.size() - i > 2 &&
            std::from_chars(uri.data() + i + 1, uri.data() + i + 3, byte, 16).ptr == uri.data() + i + 3) {
            text += static_cast<char>(byte);
            i += 2;
        } else {
            text += uri[i];
        }
    }
    return text;
}

}  // namespace xorvox::io
