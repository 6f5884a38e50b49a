// JPEG by libjpeg-turbo. Private to voxelizer/io.
#pragma once

#include <cstdint>
#include <functional>
#include <string_view>

#include "voxelizer/error.h"
#include "voxelizer/image.h"

namespace xorvox::io {

struct ImageSize {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
};

/// The picture in `bytes`. `check` is asked for its size before memory is taken for it; its error is passed on. Throws
/// std::bad_alloc.
Expected<Image> decode_jpeg(std::string_view bytes, std::string_view source,
                            const std::function<Expected<void>(ImageSize)>& check);

}  // namespace xorvox::io
