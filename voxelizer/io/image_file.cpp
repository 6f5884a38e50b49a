#include "voxelizer/io/image_file.h"

#include <cstdint>
#include <new>

#include <fmt/format.h>
#include <png.h>

#include "voxelizer/io/file_name.h"
#include "voxelizer/io/formats.h"
#include "voxelizer/io/jpeg.h"
#include "voxelizer/io/load.h"
#include "voxelizer/io/read_file.h"

namespace xorvox::io {
namespace {

/// No byte of DEFLATE (RFC 1951) becomes more: 258 bytes take two bits at least.
constexpr std::uint64_t kMostInflated = 1032;
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

tl::unexpected<Error> too_few_bytes(std::size_t bytes, ImageSize size, std::string_view source) {
    return fail(fmt::format("{}: {} bytes cannot hold {} × {} pixels; save the picture again", source, bytes,
                            size.width, size.height));
}

/// Frees what libpng has taken, whatever happens.
class Png {
public:
    Png() { image_.version = PNG_IMAGE_VERSION; }
    ~Png() { png_image_free(&image_); }
    Png(const Png&) = delete;
    Png& operator=(const Png&) = delete;
    png_image* get() { return &image_; }
    png_image* operator->() { return &image_; }

private:
    png_image image_{};
};

Expected<Image> decode_png(std::string_view bytes, std::string_view source) {
    constexpr std::size_t kHeader = 8 + 4 + 4 + 13;  // signature, then IHDR's length, name and content
    if (bytes.size() < kHeader || bytes.substr(12, 4) != "IHDR") {
        return fail(fmt::format("{}: byte {}: the PNG has no whole header; save the picture again", source,
                                bytes.size() < kHeader ? bytes.size() : 12));
    }
    const ImageSize size{load<std::uint32_t>(bytes.data() + 16, std::endian::big),
                         load<std::uint32_t>(bytes.data() + 20, std::endian::big)};
    if (const auto ok = check_size(size, source); !ok) return tl::unexpected(ok.error());
    // A row of a picture of one bit a pixel, with the byte that says how it is filtered.
    const std::uint64_t least = std::uint64_t{size.height} * (1 + (size.width + 7) / 8);
    if (least > kMostInflated * bytes.size()) return too_few_bytes(bytes.size(), size, source);
    Png png;
    const auto failed = [&] {
        return fail(fmt::format("{}: the PNG cannot be decoded: {}; save the picture again", source, png->message));
    };
    if (png_image_begin_read_from_memory(png.get(), bytes.data(), bytes.size()) == 0) return failed();
    png->format = PNG_FORMAT_RGBA;
    png->flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
    Image image{size.width, size.height, {}};
    image.pixels.resize(std::size_t{size.width} * size.height);
    // libpng's warnings count: they are about checksums and missing ends.
    if (png_image_finish_read(png.get(), nullptr, image.pixels.data(), 0, nullptr) == 0 ||
        PNG_IMAGE_FAILED(*png.get())) {
        return failed();
    }
    return image;
}

Expected<Image> decode_whole_jpeg(std::string_view bytes, std::string_view source) {
    return decode_jpeg(bytes, source, [&](ImageSize size) -> Expected<void> {
        if (const auto ok = check_size(size, source); !ok) return ok;
        if (std::uint64_t{size.width} * size.height <= kMostPixelsAByte * bytes.size()) return {};
        return too_few_bytes(bytes.size(), size, source);
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
        if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return decode_png(bytes, source);
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
