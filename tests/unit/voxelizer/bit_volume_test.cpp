#include "voxelizer/bit_volume.h"

#include "tests/catch.h"

using namespace xorvox;

TEST_CASE("voxel x of a row is bit x % 8 of byte x / 8") {
    BitVolume volume(12, 1, 1);
    for (const std::uint32_t x : {0u, 1u, 7u, 8u, 11u}) volume.view().flip(x, 0, 0);
    const auto bytes = std::as_bytes(volume.view().words);
    REQUIRE(bytes.size() == 8);
    CHECK(bytes[0] == std::byte{0x83});
    CHECK(bytes[1] == std::byte{0x09});
    CHECK(bytes[2] == std::byte{0x00});
}

TEST_CASE("rows are padded to 8 bytes and follow each other in y, then z") {
    BitVolume volume(65, 3, 2);
    CHECK(volume.view().size_bytes() == 2 * 3 * 16);
    volume.view().flip(64, 1, 0);
    volume.view().flip(2, 2, 1);
    CHECK(volume.view().words[3] == 1);
    CHECK(volume.view().words[2 * 5] == 4);
    CHECK(volume.count() == 2);
    CHECK(volume.test(64, 1, 0));
    CHECK_FALSE(volume.test(63, 1, 0));
    volume.view().flip(64, 1, 0);
    CHECK(volume.count() == 1);
}
