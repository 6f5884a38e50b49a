#include "tests/unit/io/encode_image.h"

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <jpeglib.h>
#include <png.h>

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

std::string encode_jpeg(const xorvox::Image& image, bool progressive) {
    jpeg_compress_struct jpeg{};
    jpeg_error_mgr errors{};
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    unsigned char* bytes = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&jpeg, &bytes, &size);
    jpeg.image_width = image.width;
    jpeg.image_height = image.height;
    jpeg.input_components = 4;
    jpeg.in_color_space = JCS_EXT_RGBA;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, 100, TRUE);
    if (progressive) jpeg_simple_progression(&jpeg);
    jpeg_start_compress(&jpeg, TRUE);
    for (std::size_t y = 0; y < image.height; ++y) {
        auto row = std::vector(image.pixels.begin() + static_cast<std::ptrdiff_t>(y * image.width),
                               image.pixels.begin() + static_cast<std::ptrdiff_t>((y + 1) * image.width));
        JSAMPROW first = row[0].data();
        jpeg_write_scanlines(&jpeg, &first, 1);
    }
    jpeg_finish_compress(&jpeg);
    std::string file(reinterpret_cast<const char*>(bytes), size);
    jpeg_destroy_compress(&jpeg);
    std::free(bytes);
    return file;
}

xorvox::Image test_picture(std::uint32_t width, std::uint32_t height) {
    xorvox::Image image{width, height, {}};
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            image.pixels.push_back({static_cast<std::uint8_t>(255 * x / width),
                                    static_cast<std::uint8_t>(255 * y / height), static_cast<std::uint8_t>(2 * (x + y)),
                                    255});
        }
    }
    return image;
}
