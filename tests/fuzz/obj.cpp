#include "tests/fuzz/io_colors.h"
#include "voxelizer/io/obj_colors.h"

using namespace xorvox;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    check_parser(io::parse_obj, data, size);
    std::map<std::string, io::MtlMaterial, std::less<>> materials;
    const auto ok = io::parse_mtl({reinterpret_cast<const char*>(data), size}, "file", materials);
    require(ok || ok.error().message.starts_with("file: line "));
    return check_parser(
        [](std::string_view bytes, std::string_view source) {
            return mesh_of(io::parse_colored_obj(bytes, source, io::Wanted::ShapeAndColors, io::SideFiles()));
        },
        data, size);
}
