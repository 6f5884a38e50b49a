// Image files: PNG by libpng, JPEG by libjpeg-turbo.
//
// A file is read whole or refused with one line that names it, what was found and what to do: files cut short, sizes
// beyond the limits below, and pictures that are larger than their bytes could say are refused before memory is taken.
//
// Thread safety: all functions may run at the same time; nothing is shared.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "voxelizer/error.h"
#include "voxelizer/image.h"

namespace xorvox::io {

/// The longest image file that is read.
inline constexpr std::size_t kMaxImageFileBytes = std::size_t{256} << 20;
/// The most pixels of one image; each side has at most Image::kMostSide.
inline constexpr std::size_t kMaxImagePixels = std::size_t{1} << 26;

/// Whether read_image() would take `path`, by its name: .png, .jpg or .jpeg, in either case.
bool is_image_path(std::string_view path);

/// Reads the PNG or JPEG file at `path`, whatever it is called. Errors begin with the path.
Expected<Image> read_image(const std::string& path);

/// The same of a file in memory. `source` is the name that errors begin with.
///
/// PNG: every kind; 16 bits a channel become 8, and a gamma that the file states becomes 1/2.2, about that of sRGB.
/// JPEG: baseline and progressive, grey and colours but CMYK, opaque; profiles and the orientation in EXIF are not
/// looked at.
Expected<Image> decode_image(std::string_view bytes, std::string_view source);

}  // namespace xorvox::io
