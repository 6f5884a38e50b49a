// Numbers from bytes in a given order. Private to voxelizer/io.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

namespace xorvox::io {

/// The T that starts at `from`; its bytes need no alignment.
template <class T>
T load(const char* from, std::endian order = std::endian::little) {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), from, sizeof(T));
    if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<T>(bytes);
}

}  // namespace xorvox::io
