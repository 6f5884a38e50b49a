// Image: 8-bit RGB pixels, and their PNG file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace xorvox::sim {

/// Rows from the top, pixels from the left, R G B, 8 bits each, encoded as sRGB.
struct Image {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::uint8_t> rgb;  ///< 3 · width · height.
};

/// A whole PNG file. The same image gives the same bytes: no date, no text. `image` must have at least one pixel and
/// the size that it says. Throws std::bad_alloc.
std::vector<std::byte> encode_png(const Image& image);

}  // namespace xorvox::sim
