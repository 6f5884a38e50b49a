#include "tests/fuzz/io_volume.h"
#include "voxelizer/io/volume_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return check_volumes(xorvox::io::parse_nifti({reinterpret_cast<const char*>(data), size}, "file"));
}
