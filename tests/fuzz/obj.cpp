#include "tests/fuzz/io_mesh.h"
#include "voxelizer/io/mesh_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return check_parser(xorvox::io::parse_obj, data, size);
}
