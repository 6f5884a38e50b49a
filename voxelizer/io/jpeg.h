// JPEG by libjpeg-turbo. Private to voxelizer/io.
#pragma once

#include <string_view>

#include "voxelizer/error.h"
#include "voxelizer/image.h"
#include "voxelizer/io/image_size.h"

namespace xorvox::io {

/// The picture in `bytes`. `check` is asked for its size before memory is taken for it; its error is passed on. Throws
/// std::bad_alloc.
Expected<Image> decode_jpeg(std::string_view bytes, std::string_view source, const CheckImageSize& check);

}  // namespace xorvox::io
