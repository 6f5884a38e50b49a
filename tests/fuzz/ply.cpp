#include "tests/fuzz/io_colors.h"

using namespace xorvox;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    check_parser(io::parse_ply, data, size);
    return check_parser(
        [](std::string_view bytes, std::string_view source) {
            return mesh_of(io::parse_colored_ply(bytes, source, io::Wanted::ShapeAndColors));
        },
        data, size);
}
