#include "voxelizer/io/volume_reader.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <new>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "voxelizer/io/file_name.h"
#include "voxelizer/io/read_file.h"
#include "voxelizer/io/side_files.h"
#include "voxelizer/io/text_scanner.h"

namespace xorvox::io {
namespace {

constexpr std::array<std::string_view, 7> kExtensions{".binvox", ".nrrd", ".nhdr", ".vox", ".png", ".nii", ".nii.gz"};

bool is_folder(const std::string& path) {
    std::error_code ignored;
    return std::filesystem::is_directory(path, ignored);
}

constexpr FileKind kVolumeFile{"a volume file", kMaxVolumeFileBytes, "cut or reduce the volume"};
constexpr FileKind kDataFile{"a data file", kMaxVolumeFileBytes, "cut or reduce the volume"};

Expected<VolumeSequence> read(const std::string& path, const std::string& name) {
    const std::string extension = volume_extension_of(path);
    if (is_folder(path) || extension == ".png") return read_png_stack(path);
    if (std::ranges::find(kExtensions, extension) == kExtensions.end()) {
        return fail(
            fmt::format("{}: its extension {} is of no known volume format; xorvox reads .binvox, .nrrd, "
                        ".nhdr, .vox, .nii, .nii.gz and stacks of .png (xorvox voxelize makes a volume of a mesh)",
                        name, io::quoted(extension)));
    }
    const auto bytes = read_file(path, name, kVolumeFile);
    if (!bytes) return tl::unexpected(bytes.error());
    if (extension == ".binvox") return parse_binvox(*bytes, name);
    if (extension == ".vox") return parse_vox(*bytes, name);
    if (extension == ".nii" || extension == ".nii.gz") return parse_nifti(*bytes, name);
    return parse_nrrd(*bytes, name,
                      [&](const std::string& file) { return SideFiles(path).read(file, name, kDataFile); });
}

}  // namespace

bool is_volume_path(const std::string& path) {
    return is_folder(path) || std::ranges::find(kExtensions, volume_extension_of(path)) != kExtensions.end();
}

Expected<VolumeSequence> read_volumes(const std::string& path) {
    const std::string name = printable_name(path);
    try {
        return read(path, name);
    } catch (const std::bad_alloc&) {
        return fail(fmt::format("{}: not enough memory to read it; write fewer voxels", name));
    }
}

}  // namespace xorvox::io
