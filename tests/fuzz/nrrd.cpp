#include <string>

#include "tests/fuzz/io_volume.h"
#include "voxelizer/io/volume_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes{reinterpret_cast<const char*>(data), size};
    // The data of a detached header are whatever follows its empty line.
    const auto beside = [bytes](const std::string& name) -> xorvox::Expected<std::string> {
        require(!name.empty());
        const std::size_t end = bytes.find("\n\n");
        return std::string(end == std::string_view::npos ? "" : bytes.substr(end + 2));
    };
    return check_volumes(xorvox::io::parse_nrrd(bytes, "file", beside));
}
