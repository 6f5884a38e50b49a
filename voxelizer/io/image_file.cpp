#include "voxelizer/io/image_file.h"

#include <cstdint>
#include <new>

#include <fmt/format.h>

#include "voxelizer/io/file_name.h"
#include "voxelizer/io/formats.h"
#include "voxelizer/io/jpeg.h"
#include "voxelizer/io/png_picture.h"
#include "voxelizer/io/read_file.h"

namespace xorvox::io {
namespace {

/// No byte of a JPEG becomes more pixels: a block of 8 × 8 takes two bits at least, and may stand for 32 × 32.
constexpr std::uint64_t kMostPixelsAByte = 4096;

Expected<void> check_size(ImageSize size, std::string_view source) {
    if (size.width == 0 || size.height == 0) {
        return fail(fmt::format("{}: {} × {} pixels are no picture; save it again", source, size.width, size.height));
    }
    if (size.width > Image::kMostSide || size.height > Image::kMostSide ||
        std::uint64_t{size.width} * size.height > kMaxImagePixels) {
        return fail(
            fmt::format("{}: {} × {} pixels are too many; at most {} a side and {} in all are read: make the "
                        "picture smaller",
                        source, size.width, size.height, Image::kMostSide, kMaxImagePixels));
    }
    return {};
}

Expected<Image> decode_whole_jpeg(std::string_view bytes, std::string_view source) {
    return decode_jpeg(bytes, source, [&](ImageSize size) -> Expected<void> {
        if (const auto ok = check_size(size, source); !ok) return ok;
        if (std::uint64_t{size.width} * size.height <= kMostPixelsAByte * bytes.size()) return {};
        return fail(fmt::format("{}: {} bytes cannot hold {} × {} pixels; save the picture again", source, bytes.size(),
                                size.width, size.height));
    });
}

}  // namespace

bool is_image_path(std::string_view path) {
    const std::string ending = extension_of(path);
    return ending == ".png" || ending == ".jpg" || ending == ".jpeg";
}

Expected<Image> decode_image(std::string_view bytes, std::string_view source) {
    try {
        if (bytes.size() > kMaxImageFileBytes) {
            return fail(fmt::format("{}: longer than {} bytes, the most that is read of an image file", source,
                                    kMaxImageFileBytes));
        }
        if (bytes.starts_with("\x89PNG\r\n\x1a\n")) {
            return decode_png(bytes, source, [&](ImageSize size) { return check_size(size, source); });
        }
        if (bytes.starts_with("\xff\xd8")) return decode_whole_jpeg(bytes, source);
        return fail(fmt::format("{}: byte 0: neither a PNG nor a JPEG; save the picture as one of them", source));
    } catch (const std::bad_alloc&) {
        return fail(fmt::format("{}: not enough memory for the picture; make it smaller", source));
    }
}

Expected<Image> read_image(const std::string& path) {
    const std::string name = printable_name(path);
    try {
        const auto bytes = read_file(path, name, kImageFile);
        if (!bytes) return tl::unexpected(bytes.error());
        return decode_image(*bytes, name);
    } catch (const std::bad_alloc&) {
        return fail(fmt::format("{}: not enough memory for the picture; make it smaller", name));
    }
}

}  // namespace xorvox::io
