#include "voxelizer/io/jpeg.h"

#include <cstddef>
#include <cstring>
#include <memory>

#include <fmt/format.h>

// stb_image is compiled here, with JPEG alone, and with none of the checks that are for our own code.
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#endif
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 16384
#include <stb/stb_image.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace xorvox::io {
namespace {

static_assert(Image::kMostSide == STBI_MAX_DIMENSIONS);

std::uint32_t byte_at(std::string_view bytes, std::size_t at) {
    return static_cast<unsigned char>(bytes[at]);
}

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
    return byte_at(bytes, at) << 8 | byte_at(bytes, at + 1);
}

/// SOF0 … SOF15 but for the tables DHT, JPG and DAC among them (ITU-T T.81, table B.1).
bool begins_frame(std::uint32_t marker) {
    return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
}

struct FreePixels {
    void operator()(stbi_uc* pixels) const { stbi_image_free(pixels); }
};

}  // namespace

Expected<ImageSize> jpeg_size(std::string_view bytes, std::string_view source) {
    const auto broken = [&](std::size_t at, const char* what) {
        return fail(fmt::format("{}: byte {}: the JPEG {}; save the picture again", source, at, what));
    };
    ImageSize size;
    // Segments of a marker and a length, up to the first scan.
    std::size_t at = 2;
    while (true) {
        if (at + 4 > bytes.size()) return broken(bytes.size(), "is cut short");
        if (byte_at(bytes, at) != 0xff) return broken(at, "has no marker where one must be");
        const std::uint32_t marker = byte_at(bytes, at + 1);
        if (marker == 0xff) {  // padding
            ++at;
            continue;
        }
        const std::uint32_t length = word_at(bytes, at + 2);
        if (length < 2) return broken(at, "has a segment without a length");
        if (at + 2 + length > bytes.size()) return broken(bytes.size(), "is cut short");
        if (begins_frame(marker)) {
            if (length < 8) return broken(at, "has a header that is too short");
            size = {word_at(bytes, at + 7), word_at(bytes, at + 5)};
        }
        at += 2 + length;
        if (marker == 0xda) break;
    }
    if (size.width == 0 || size.height == 0) return broken(at, "tells no size");
    // stb_image makes up what is missing at the end.
    if (bytes.find("\xff\xd9", at) == bytes.npos) return broken(bytes.size(), "is cut short");
    return size;
}

Expected<Image> decode_jpeg(std::string_view bytes, std::string_view source, ImageSize size) {
    int width = 0;
    int height = 0;
    int channels = 0;
    const std::unique_ptr<stbi_uc, FreePixels> pixels(stbi_load_from_memory(
        reinterpret_cast<const stbi_uc*>(bytes.data()), static_cast<int>(bytes.size()), &width, &height, &channels, 4));
    if (!pixels) {
        return fail(
            fmt::format("{}: the JPEG cannot be decoded: {}; save the picture again", source, stbi_failure_reason()));
    }
    if (static_cast<std::uint32_t>(width) != size.width || static_cast<std::uint32_t>(height) != size.height) {
        return fail(fmt::format("{}: the JPEG tells two sizes; save the picture again", source));
    }
    Image image{size.width, size.height, {}};
    image.pixels.resize(std::size_t{size.width} * size.height);
    std::memcpy(image.pixels.data(), pixels.get(), image.pixels.size() * 4);
    return image;
}

}  // namespace xorvox::io
