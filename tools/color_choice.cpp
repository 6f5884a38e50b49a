#include "tools/color_choice.h"

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/vec3.hpp>

#include "driver/host/color_list.h"
#include "driver/host/color_space.h"
#include "driver/host/label_color.h"
#include "driver/host/spherical_image_color.h"
#include "driver/host/texture_color.h"
#include "driver/host/volume_placement.h"
#include "voxelizer/io/file_name.h"
#include "voxelizer/io/image_file.h"
#include "voxelizer/io/volume_reader.h"

namespace xorvox::tools {
namespace {

using Volume = std::shared_ptr<const SampledVolume>;

/// "FILE,COLOR,COLOR…".
struct FileAndColors {
    std::string file;
    std::vector<glm::dvec3> colors;  ///< None, or at least as many as are needed.
};

Expected<FileAndColors> parse_file(std::string_view kind, std::string_view arguments, std::size_t least_colors) {
    const std::size_t comma = arguments.find(',');
    FileAndColors result{std::string(arguments.substr(0, comma)), {}};
    if (result.file.empty())
        return fail(fmt::format("{0}: the name of a volume file is missing, as in {0}:FILE", kind));
    if (comma == arguments.npos) return result;
    auto colors = host::parse_colors(arguments.substr(comma + 1), least_colors,
                                     fmt::format("{}:{}", kind, io::printable_name(arguments)));
    if (!colors) return tl::unexpected<Error>(colors.error());
    result.colors = std::move(*colors);
    return result;
}

Expected<Volume> read_volume(const std::string& path) {
    auto volumes = io::read_volumes(path);
    if (!volumes) return tl::unexpected<Error>(volumes.error());
    return std::make_shared<const SampledVolume>(std::move(volumes->frames.front()));
}

Expected<ColorChoice> choose_texture(std::string_view arguments) {
    const auto chosen = parse_file("texture", arguments, 2);
    if (!chosen) return tl::unexpected<Error>(chosen.error());
    const auto volume = read_volume(chosen->file);
    if (!volume) return tl::unexpected<Error>(volume.error());
    if ((*volume)->kind == VolumeKind::Colors && !chosen->colors.empty()) {
        return fail(fmt::format("texture: {} has colours of its own; leave out those behind its name",
                                io::printable_name(chosen->file)));
    }
    const auto rising = host::rising_colors();
    return std::make_unique<host::TextureColor>(
        *volume, host::stretched(**volume),
        chosen->colors.empty() ? std::span<const glm::dvec3>(rising) : chosen->colors);
}

Expected<ColorChoice> choose_labels(std::string_view arguments) {
    const auto chosen = parse_file("labels", arguments, 1);
    if (!chosen) return tl::unexpected<Error>(chosen.error());
    const auto volume = read_volume(chosen->file);
    if (!volume) return tl::unexpected<Error>(volume.error());
    if (!host::has_labels(**volume)) {
        return fail(
            fmt::format("labels: {} has no labels, which are whole numbers from 0 to 16777216; texture:{} shows "
                        "colours and other numbers",
                        io::printable_name(chosen->file), io::printable_name(chosen->file)));
    }
    return std::make_unique<host::LabelColor>(*volume, host::stretched(**volume), chosen->colors);
}

Expected<ColorChoice> choose_spherical_image(std::string_view path) {
    auto image = io::read_image(std::string(path));
    if (!image) return tl::unexpected<Error>(image.error());
    return std::make_unique<host::SphericalImageColor>(std::make_shared<const Image>(std::move(*image)));
}

}  // namespace

std::string color_kinds() {
    return fmt::format(
        "{}, texture:FILE, texture:FILE,COLOR,COLOR, labels:FILE, labels:FILE,COLOR, spherical:FILE.png, own",
        host::kColorKinds);
}

Expected<ColorChoice> choose_color(std::string_view spec) {
    if (spec == "own") return ColorChoice();
    const std::size_t colon = spec.find(':');
    const std::string_view kind = spec.substr(0, colon);
    const std::string_view arguments = colon == spec.npos ? std::string_view() : spec.substr(colon + 1);
    if (colon != spec.npos) {
        if (kind == "texture") return choose_texture(arguments);
        if (kind == "labels") return choose_labels(arguments);
        if (kind == "spherical" && io::is_image_path(arguments)) return choose_spherical_image(arguments);
        for (const char* known : {"constant", "gradient", "radial", "spherical", "noise", "simplex", "expr"}) {
            if (kind == known) return host::parse_color(spec);
        }
    } else if (kind == "gradient" || kind == "noise" || kind == "simplex") {
        return host::parse_color(spec);
    }
    if (host::parse_color_name(spec)) return fail(fmt::format("{0} is a colour, not a kind; write constant:{0}", spec));
    return fail(fmt::format("colour \"{}\" is not understood; allowed: {}", io::printable_name(spec), color_kinds()));
}

}  // namespace xorvox::tools
