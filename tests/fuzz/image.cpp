// Arbitrary bytes as an image file: a picture within its bounds, or one line.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "voxelizer/io/image_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto image = xorvox::io::decode_image({reinterpret_cast<const char*>(data), size}, "file");
    if (!image) {
        const std::string& message = image.error().message;
        if (!message.starts_with("file: ") || message.find('\n') != std::string::npos) std::abort();
        return 0;
    }
    const std::size_t pixels = std::size_t{image->width} * image->height;
    if (pixels == 0 || pixels > xorvox::io::kMaxImagePixels || image->pixels.size() != pixels) std::abort();
    return 0;
}
