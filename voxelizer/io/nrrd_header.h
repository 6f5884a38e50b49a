// The header of a NRRD file; https://teem.sourceforge.net/nrrd/format.html. Private to voxelizer/io.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <glm/mat4x4.hpp>

#include "voxelizer/error.h"
#include "voxelizer/io/voxel_numbers.h"

namespace xorvox::io {

struct NrrdHeader {
    NumberFormat format;
    std::uint32_t channels = 0;  ///< 3 or 4 of Colors, the fastest axis; 0: there is no such axis.
    std::uint32_t nx = 0;
    std::uint32_t ny = 0;
    std::uint32_t nz = 0;
    std::uint32_t frames = 1;  ///< The slowest axis, where it is time.
    glm::dmat4 to_mm{1.0};
    bool labels = false;  ///< The file says that the values are.
    bool gzip = false;
    std::uint64_t line_skip = 0;
    std::int64_t byte_skip = 0;  ///< -1: the data are the last bytes.
    std::string data_file;       ///< Empty: attached.
    std::size_t data = 0;        ///< Where attached data begin, before skips.

    std::size_t data_bytes() const {
        return std::size_t{nx} * ny * nz * frames * (channels == 0 ? bytes_of(format.type) : channels);
    }
};

Expected<NrrdHeader> parse_nrrd_header(std::string_view bytes, std::string_view source);

}  // namespace xorvox::io
