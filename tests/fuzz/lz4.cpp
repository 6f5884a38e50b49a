// Two bytes of length, then a block: the device's decoder against liblz4.
#include <cstdlib>

#include "tests/unit/device/lz4_reference.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 2) return 0;
    const std::size_t length = data[0] | std::size_t{data[1]} << 8;
    if (!xorvox::test::agrees_with_liblz4(std::as_bytes(std::span(data + 2, size - 2)), length)) std::abort();
    return 0;
}
