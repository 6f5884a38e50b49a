// Picture files in memory, for the tests of image_file.
#pragma once

#include <cstdint>
#include <string>

#include "voxelizer/image.h"

/// `image` as a PNG with R, G, B and A.
std::string encode_png(const xorvox::Image& image);
/// One channel of 16 bits, and a chunk gAMA: values from 0 to 65535 in even steps from pixel to pixel.
std::string encode_png_of_16_bits(std::uint32_t width, std::uint32_t height);
/// `image` without A, as a JPEG of the best quality, baseline or progressive.
std::string encode_jpeg(const xorvox::Image& image, bool progressive = false);
/// Each pixel another colour, none transparent.
xorvox::Image test_picture(std::uint32_t width, std::uint32_t height);
