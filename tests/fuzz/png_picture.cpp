#include "voxelizer/io/png_picture.h"
#include "tests/fuzz/io_volume.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto picture = xorvox::io::parse_png({reinterpret_cast<const char*>(data), size}, "file");
    if (!picture) {
        require(picture.error().message.starts_with("file: "));
        return 0;
    }
    require(picture->width >= 1 && picture->height >= 1 && (picture->channels == 1 || picture->channels == 4));
    const std::size_t bytes = picture->bits == 16 ? 2 : 1;
    require(picture->bytes.size() == std::size_t{picture->width} * picture->height * picture->channels * bytes);
    return 0;
}
