#include "voxelizer/io/png_stack.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "voxelizer/io/file_name.h"
#include "voxelizer/io/image_file.h"
#include "voxelizer/io/load.h"
#include "voxelizer/io/memory.h"
#include "voxelizer/io/png_picture.h"
#include "voxelizer/io/read_file.h"
#include "voxelizer/io/volume_reader.h"
#include "voxelizer/io/voxel_numbers.h"

namespace xorvox::io {
namespace {

constexpr std::size_t kMostDigits = 9;

// The pictures in `folder`, row by row, each by its numbers.
using Rows = std::map<std::string, std::map<std::uint32_t, std::vector<std::string>>>;

Expected<Rows> rows_in(const std::string& folder) {
    Rows rows;
    std::error_code error;
    std::filesystem::directory_iterator at(folder, error);
    for (; !error && at != std::filesystem::directory_iterator(); at.increment(error)) {
        const std::string path = at->path().string();
        if (extension_of(path) != ".png") continue;
        const NumberedName name = numbered_name(path);
        if (name.digits.empty() || name.digits.size() > kMostDigits) continue;
        rows[name.before][static_cast<std::uint32_t>(std::stoul(name.digits))].push_back(path);
    }
    if (error) return fail(fmt::format("{}: cannot be listed: {}", printable_name(folder), error.message()));
    return rows;
}

// The volume that grows by a picture.
class Stack {
public:
    explicit Stack(std::string name) : name_(std::move(name)) {}

    Expected<void> add(PngPicture picture, const std::string& source, std::size_t count) {
        if (volume_.nx == 0) {
            if (auto ok = check_sides(picture.width, picture.height, count, name_, "stack"); !ok) return ok;
            const std::uint64_t pixels = std::uint64_t{picture.width} * picture.height;
            if (auto ok = check_memory(sizeof(float) * pixels * count, name_); !ok) return ok;
            volume_.nx = picture.width;
            volume_.ny = picture.height;
            bits_ = picture.bits;
        }
        if (picture.width != volume_.nx || picture.height != volume_.ny) {
            return fail(fmt::format("{}: the picture has {} × {} pixels, and those before it {} × {}", source,
                                    picture.width, picture.height, volume_.nx, volume_.ny));
        }
        if (picture.channels == 1 && volume_.kind != VolumeKind::Colors && picture.bits != bits_) {
            return fail(fmt::format("{}: the picture has {} bits a pixel, and those before it {}", source, picture.bits,
                                    bits_));
        }
        if (picture.channels == 4 && volume_.kind != VolumeKind::Colors) become_colors();
        // The lower row first: y is up.
        for (std::uint32_t y = 0; y < volume_.ny; ++y) add_row(picture, volume_.ny - 1 - y);
        ++volume_.nz;
        return {};
    }

    SampledVolume finish() {
        if (volume_.kind != VolumeKind::Colors && bits_ == 1) volume_.kind = VolumeKind::Binary;
        return std::move(volume_);
    }

private:
    static Rgba grey(float value, unsigned bits) {
        const float most = bits == 16 ? 65535.0f : bits == 1 ? 1.0f : 255.0f;
        const auto code = static_cast<std::uint8_t>(value * 255.0f / most + 0.5f);
        return {code, code, code, 255};
    }

    static float number(const PngPicture& picture, std::size_t pixel) {
        if (picture.bits != 16) return picture.bytes[pixel];
        return load<std::uint16_t>(reinterpret_cast<const char*>(picture.bytes.data() + 2 * pixel), std::endian::big);
    }

    void become_colors() {
        volume_.kind = VolumeKind::Colors;
        volume_.colors.reserve(volume_.values.size());
        for (const float value : volume_.values) volume_.colors.push_back(grey(value, bits_));
        volume_.values = {};
    }

    void add_row(const PngPicture& picture, std::uint32_t row) {
        for (std::uint32_t x = 0; x < picture.width; ++x) {
            const std::size_t pixel = std::size_t{row} * picture.width + x;
            if (volume_.kind != VolumeKind::Colors) {
                volume_.values.push_back(number(picture, pixel));
            } else if (picture.channels == 1) {
                volume_.colors.push_back(grey(number(picture, pixel), picture.bits));
            } else {
                const std::uint8_t* const p = picture.bytes.data() + 4 * pixel;
                volume_.colors.push_back({p[0], p[1], p[2], p[3]});
            }
        }
    }

    std::string name_;
    unsigned bits_ = 8;  // Of grey pictures.
    SampledVolume volume_{.kind = VolumeKind::Scalar};
};

}  // namespace

NumberedName numbered_name(const std::string& path) {
    const std::filesystem::path whole(path);
    NumberedName name;
    name.folder = whole.parent_path().empty() ? "." : whole.parent_path().string();
    const std::string stem = whole.stem().string();
    const std::size_t letter = stem.find_last_not_of("0123456789");
    const std::size_t first = letter == std::string::npos ? 0 : letter + 1;
    name.before = stem.substr(0, first);
    name.digits = stem.substr(first);
    return name;
}

Expected<std::vector<std::string>> stack_paths(const std::string& path) {
    const std::string shown = printable_name(path);
    std::error_code ignored;
    const bool folder = std::filesystem::is_directory(path, ignored);
    const NumberedName name = folder ? NumberedName{path, {}, {}} : numbered_name(path);
    if (!folder) {
        if (name.digits.empty() || !std::filesystem::exists(path, ignored)) return std::vector{path};
        if (name.digits.size() > kMostDigits) {
            return fail(fmt::format("{}: the number has more than {} digits", shown, kMostDigits));
        }
    }
    const auto rows = rows_in(name.folder);
    if (!rows) return tl::unexpected(rows.error());
    if (rows->empty()) {
        return fail(fmt::format("{}: holds no pictures whose names end in a number, as in slice000.png", shown));
    }
    if (folder && rows->size() > 1) {
        return fail(fmt::format("{}: holds pictures named {}… and {}…; name one of those that are meant", shown,
                                printable_name(rows->begin()->first), printable_name(std::next(rows->begin())->first)));
    }
    const auto& row = folder ? rows->begin()->second : rows->at(name.before);
    std::vector<std::string> paths;
    std::uint32_t expected = row.begin()->first;
    for (const auto& [number, names] : row) {
        if (number != expected) {
            return fail(fmt::format("{}: number {} is missing between {} and {}", shown, expected,
                                    printable_name(paths.back()), printable_name(names.front())));
        }
        if (names.size() > 1) {
            return fail(fmt::format("{}: {} and {} have the same number", shown, printable_name(names[0]),
                                    printable_name(names[1])));
        }
        paths.push_back(names.front());
        ++expected;
    }
    return paths;
}

Expected<VolumeSequence> read_png_stack(const std::string& path) {
    constexpr FileKind kPicture{"a picture", kMaxImageFileBytes, "make it smaller"};
    const auto paths = stack_paths(path);
    if (!paths) return tl::unexpected(paths.error());
    Stack stack(printable_name(path));
    for (const std::string& picture_path : *paths) {
        const std::string name = printable_name(picture_path);
        const auto bytes = read_file(picture_path, name, kPicture);
        if (!bytes) return tl::unexpected(bytes.error());
        auto picture = parse_png(*bytes, name);
        if (!picture) return tl::unexpected(std::move(picture.error()));
        if (auto ok = stack.add(std::move(*picture), name, paths->size()); !ok) {
            return tl::unexpected(std::move(ok.error()));
        }
    }
    VolumeSequence sequence;
    sequence.frames.push_back(stack.finish());
    return sequence;
}

}  // namespace xorvox::io
