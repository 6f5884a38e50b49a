// How large a picture is, before it is decoded. Private to voxelizer/io.
#pragma once

#include <cstdint>
#include <functional>

#include "voxelizer/error.h"

namespace xorvox::io {

struct ImageSize {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
};

/// What a decoder asks before it takes memory for a picture; an error is passed on.
using CheckImageSize = std::function<Expected<void>(ImageSize)>;

}  // namespace xorvox::io
