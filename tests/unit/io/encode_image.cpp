#include "tests/unit/io/encode_image.h"

#include <cstddef>
#include <vector>

#include <png.h>

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
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image_write.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace {

std::string write_png(std::uint32_t width, std::uint32_t height, std::uint32_t format, const void* pixels) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = width;
    png.height = height;
    png.format = format;
    std::string file(PNG_IMAGE_PNG_SIZE_MAX(png), '\0');
    png_alloc_size_t bytes = file.size();
    if (png_image_write_to_memory(&png, file.data(), &bytes, 0, pixels, 0, nullptr) == 0) return {};
    file.resize(bytes);
    return file;
}

}  // namespace

std::string encode_png(const xorvox::Image& image) {
    return write_png(image.width, image.height, PNG_FORMAT_RGBA, image.pixels.data());
}

std::string encode_png_of_16_bits(std::uint32_t width, std::uint32_t height) {
    std::vector<std::uint16_t> pixels(std::size_t{width} * height);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        pixels[i] = static_cast<std::uint16_t>(65535 * i / (pixels.size() - 1));
    }
    return write_png(width, height, PNG_FORMAT_LINEAR_Y, pixels.data());
}

std::string encode_jpeg(const xorvox::Image& image) {
    std::string file;
    const auto append = [](void* to, void* data, int size) {
        static_cast<std::string*>(to)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
    };
    stbi_write_jpg_to_func(append, &file, static_cast<int>(image.width), static_cast<int>(image.height), 4,
                           image.pixels.data(), 100);
    return file;
}

xorvox::Image test_picture(std::uint32_t width, std::uint32_t height) {
    xorvox::Image image{width, height, {}};
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            image.pixels.push_back({static_cast<std::uint8_t>(255 * x / width),
                                    static_cast<std::uint8_t>(255 * y / height), static_cast<std::uint8_t>(3 * (x + y)),
                                    255});
        }
    }
    return image;
}
