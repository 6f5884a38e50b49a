// PNG by libpng: as a picture in colours, or with the numbers that are in it, whatever they mean. Private to
// voxelizer/io.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "voxelizer/error.h"
#include "voxelizer/image.h"
#include "voxelizer/io/image_size.h"

namespace xorvox::io {

struct PngPicture {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    unsigned bits = 8;                ///< A number of grey in the file: 1, 2, 4, 8 or 16; of colour always 8.
    unsigned channels = 1;            ///< 1 grey, 4 colour and opacity.
    std::vector<std::uint8_t> bytes;  ///< Row after row, the upper one first; 16 bits as PNG has them, big-endian; 1
                                      ///< bit as 0 and 1; 2 and 4 bits spread over 0 to 255.
};

/// Reads a PNG file. Sides are at most SampledVolume::kMostSide.
Expected<PngPicture> parse_png(std::string_view bytes, std::string_view source);

/// The picture in `bytes`, in sRGB: 16 bits a channel become 8, and a gamma that the file states becomes 1/2.2.
/// `check` is asked for its size before memory is taken for it. Throws std::bad_alloc.
Expected<Image> decode_png(std::string_view bytes, std::string_view source, const CheckImageSize& check);

/// A PNG file of one bit a pixel. `rows` has ⌈width / 8⌉ bytes a row, the upper row first, the leftmost pixel in the
/// highest bit. Equal pixels give equal bytes.
Expected<std::string> encode_png_bits(std::uint32_t width, std::uint32_t height, std::vector<std::uint8_t>& rows);

}  // namespace xorvox::io
