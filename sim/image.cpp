#include "sim/image.h"

#include <png.h>

#include <cassert>
#include <new>

namespace xorvox::sim {

std::vector<std::byte> encode_png(const Image& image) {
    assert(image.width > 0 && image.height > 0);
    assert(image.rgb.size() == std::size_t{3} * image.width * image.height);

    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = image.width;
    png.height = image.height;
    png.format = PNG_FORMAT_RGB;

    png_alloc_size_t bytes = PNG_IMAGE_PNG_SIZE_MAX(png);
    std::vector<std::byte> file(bytes);
    if (png_image_write_to_memory(&png, file.data(), &bytes, 0, image.rgb.data(), 0, nullptr) == 0) {
        throw std::bad_alloc();  // The buffer is large enough for any image: only libpng's own memory can be short.
    }
    file.resize(bytes);
    return file;
}

}  // namespace xorvox::sim
