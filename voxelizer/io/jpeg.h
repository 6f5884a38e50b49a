// JPEG by stb_image. Private to voxelizer/io.
#pragma once

#include <cstdint>
#include <string_view>

#include "voxelizer/error.h"
#include "voxelizer/image.h"

namespace xorvox::io {

struct ImageSize {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
};

/// What a JPEG says of its size, found without decoding it. An error when its markers are not sound, or it has no end.
Expected<ImageSize> jpeg_size(std::string_view bytes, std::string_view source);

/// The picture of `size`, which jpeg_size() gave. Throws std::bad_alloc.
Expected<Image> decode_jpeg(std::string_view bytes, std::string_view source, ImageSize size);

}  // namespace xorvox::io
