// Display files by name: the presets, and files on disk.
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>

#include <fmt/format.h>

#include "driver/display/toml.h"
#include "driver/display/toml_file.h"
#include "driver/display/toml_tree.h"

namespace xorvox {
namespace display {

Expected<std::string> read_file(const std::string& path, std::string_view what) {
    constexpr std::size_t kMaxFileBytes = std::size_t{1} << 20;
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) {
        return fail(fmt::format("{}: is a directory; a {} (.toml) was expected", path, what));
    }
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
    if (file == nullptr) {
        return fail(fmt::format("{}: cannot open the {}: {}", path, what, std::generic_category().message(errno)));
    }
    std::string text(kMaxFileBytes + 1, '\0');
    text.resize(std::fread(text.data(), 1, text.size(), file.get()));
    if (std::ferror(file.get()) != 0) {
        return fail(fmt::format("{}: cannot read the {}: {}", path, what, std::generic_category().message(errno)));
    }
    if (text.size() > kMaxFileBytes) {
        return fail(fmt::format("{}: longer than {} bytes, which no {} is", path, kMaxFileBytes, what));
    }
    return text;
}

}  // namespace display

Expected<DisplaySource> find_display(const std::string& name_or_path) {
    if (name_or_path.find('/') != std::string::npos || name_or_path.ends_with(".toml")) {
        auto text = display::read_file(name_or_path, "display file");
        if (!text) return tl::unexpected<Error>(std::move(text.error()));
        return DisplaySource{name_or_path, std::move(*text)};
    }
    std::string names;
    for (const Preset& preset : presets()) {
        if (preset.name == name_or_path) return DisplaySource{name_or_path, std::string(preset.text)};
        names += fmt::format("{}{}", names.empty() ? "" : ", ", preset.name);
    }
    return fail(fmt::format("unknown display {}; presets: {}; or give the path of a display file, ending in .toml",
                            display::in_quotes(name_or_path), names));
}

Expected<DisplayFile> load_display(const std::string& name_or_path) {
    const auto source = find_display(name_or_path);
    if (!source) return tl::unexpected<Error>(source.error());
    return parse_display(source->text, source->name);
}

}  // namespace xorvox
