#include <set>
#include <string>

#include "tests/unit/io/contains.h"
#include "tests/unit/io/volume_bytes.h"
#include "tests/unit/io/volume_hostile.h"
#include "voxelizer/io/volume_reader.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

const ParseVolume kParse = io::parse_vox;

VolumeSequence parsed(const std::string& bytes) {
    auto sequence = io::parse_vox(bytes, "file");
    INFO((sequence ? "" : sequence.error().message));
    REQUIRE(sequence);
    return std::move(*sequence);
}

const std::string kOne = vox_model(2, 3, 4, std::string("\1\2\3\11\0\0\0\1", 8));
const std::string kTwo = vox_model(2, 3, 4, std::string("\1\0\0\2", 4));

/// Node 0, a group of two shapes of one model each, which stand at these places.
std::string scene(const std::vector<std::string>& first, const std::vector<std::string>& second) {
    return vox_transform(0, 1, {}) + vox_group(1, {2, 4}) + vox_transform(2, 3, first) + vox_shape(3, {0}) +
           vox_transform(4, 5, second) + vox_shape(5, {1});
}

std::size_t count_set(const SampledVolume& volume) {
    return static_cast<std::size_t>(
        std::count_if(volume.values.begin(), volume.values.end(), [](float value) { return value != 0.0f; }));
}

}  // namespace

TEST_CASE("vox: voxels are labels in a palette, 1 mm large, from 0 on") {
    const VolumeSequence sequence = parsed(vox(kOne));
    REQUIRE(sequence.frames.size() == 1);
    const SampledVolume& volume = sequence.frames[0];
    CHECK(volume.kind == VolumeKind::Labels);
    CHECK(glm::uvec3(volume.nx, volume.ny, volume.nz) == glm::uvec3(2, 3, 4));
    CHECK(volume.values[volume.index(1, 2, 3)] == 9.0f);
    CHECK(volume.values[0] == 1.0f);
    CHECK(count_set(volume) == 2);
    CHECK(volume.to_mm * glm::dvec4(0, 0, 0, 1) == glm::dvec4(0.5, 0.5, 0.5, 1));
}

TEST_CASE("vox: without a palette the colours are MagicaVoxel's own") {
    const auto palette = parsed(vox(kOne)).frames[0].palette;
    REQUIRE(palette.size() == 256);
    CHECK(palette[0] == Rgba{0, 0, 0, 0});
    CHECK(palette[1] == Rgba{255, 255, 255, 255});
    CHECK(palette[2] == Rgba{255, 255, 204, 255});
    CHECK(palette[7] == Rgba{255, 204, 255, 255});
    CHECK(palette[37] == Rgba{204, 255, 255, 255});
    CHECK(palette[215] == Rgba{0, 0, 51, 255});
    CHECK(palette[216] == Rgba{0xee, 0, 0, 255});
    CHECK(palette[226] == Rgba{0, 0xee, 0, 255});
    CHECK(palette[236] == Rgba{0, 0, 0xee, 255});
    CHECK(palette[246] == Rgba{0xee, 0xee, 0xee, 255});
    CHECK(palette[255] == Rgba{0x11, 0x11, 0x11, 255});
    CHECK(std::set<Rgba>(palette.begin(), palette.end()).size() == 256);
}

TEST_CASE("vox: the file's palette counts from 1") {
    std::string colors(1024, '\x7f');
    colors.replace(0, 8, "abcdefgh");
    const auto palette = parsed(vox(kOne + chunk("RGBA", colors), 200)).frames[0].palette;
    CHECK(palette[1] == Rgba{'a', 'b', 'c', 'd'});
    CHECK(palette[2] == Rgba{'e', 'f', 'g', 'h'});
    CHECK(palette[0] == Rgba{0, 0, 0, 0});
}

TEST_CASE("vox: models without a scene follow each other, and so do those at one place and those of one shape") {
    for (const std::string& scene_bytes :
         {std::string(), scene({"_t", "0 0 2"}, {"_t", "0 0 2"}), vox_transform(0, 1, {}) + vox_shape(1, {0, 1})}) {
        const VolumeSequence sequence = parsed(vox(chunk("PACK", raw<std::uint32_t>(2)) + kOne + kTwo + scene_bytes));
        REQUIRE(sequence.frames.size() == 2);
        CHECK(count_set(sequence.frames[0]) == 2);
        CHECK(sequence.frames[1].values[1] == 2.0f);
    }
}

TEST_CASE("vox: a scene that places models apart is one volume") {
    const VolumeSequence sequence = parsed(vox(kOne + kTwo + scene({"_t", "0 0 2"}, {"_t", "10 0 2"})));
    REQUIRE(sequence.frames.size() == 1);
    const SampledVolume& volume = sequence.frames[0];
    CHECK(glm::uvec3(volume.nx, volume.ny, volume.nz) == glm::uvec3(12, 3, 4));
    CHECK(volume.values[volume.index(1, 2, 3)] == 9.0f);
    CHECK(volume.values[volume.index(11, 0, 0)] == 2.0f);
    CHECK(count_set(volume) == 3);
    // The first model's middle, (1, 1, 2), is at (0, 0, 2).
    CHECK(volume.to_mm * glm::dvec4(0, 0, 0, 1) == glm::dvec4(-0.5, -0.5, 0.5, 1));
}

TEST_CASE("vox: a scene turns its models") {
    // First row 0 1 0, second -1 0 0: a quarter turn that takes y to x, and x to -y. Bits: 1, 0 << 2, minus in row two.
    const VolumeSequence sequence = parsed(vox(kOne + kTwo + scene({"_r", "33"}, {"_t", "100 0 0"})));
    const SampledVolume& volume = sequence.frames[0];
    // Voxel (1, 2, 3): its centre, from the middle (1, 1, 2), is (½, 3/2, 3/2), which becomes (3/2, -½, 3/2): voxel
    // (1, -1, 1). The turned box begins at (-1, -1, -2), the other model's at (99, -1, -2).
    CHECK(volume.values[volume.index(2, 0, 3)] == 9.0f);
    CHECK(volume.values[volume.index(0, 1, 0)] == 1.0f);
}

TEST_CASE("vox: what is hidden is not there") {
    const std::string hidden = chunk("nTRN", raw<std::uint32_t>(4) + vox_dictionary({"_hidden", "1"}) +
                                                 raw<std::uint32_t>(5) + raw<std::int32_t>(-1) + raw<std::int32_t>(-1) +
                                                 raw<std::uint32_t>(1) + vox_dictionary({"_t", "10 0 2"}));
    const VolumeSequence sequence =
        parsed(vox(kOne + kTwo + vox_transform(0, 1, {}) + vox_group(1, {2, 4}) + vox_transform(2, 3, {}) +
                   vox_shape(3, {0}) + hidden + vox_shape(5, {1})));
    REQUIRE(sequence.frames.size() == 1);
    CHECK(sequence.frames[0].nx == 2);
}

TEST_CASE("vox: what is wrong is told with its byte") {
    CHECK_THAT(refusal(kParse, "VOY "), contains("byte 0"));
    CHECK_THAT(refusal(kParse, vox(kOne, 170)), contains("version 170"));
    CHECK_THAT(refusal(kParse, vox("")), contains("no model"));
    CHECK_THAT(refusal(kParse, vox(kOne + chunk("SIZE", raw(1u) + raw(1u) + raw(1u)))), contains("no voxels"));
    CHECK_THAT(refusal(kParse, vox(vox_model(257, 1, 1, ""))), contains("257 × 1 × 1"));
    CHECK_THAT(refusal(kParse, vox(vox_model(1, 1, 1, std::string("\0\0\1\1", 4)))), contains("is at 1 along z"));
    CHECK_THAT(refusal(kParse, vox(chunk("XYZI", raw(0u)))), contains("without a size"));
    CHECK_THAT(refusal(kParse, vox(kOne + vox_transform(0, 7, {}))), contains("no node 7"));
    CHECK_THAT(refusal(kParse, vox(kOne + vox_transform(0, 1, {}) + vox_shape(1, {3}))), contains("model 3 of 1"));
    CHECK_THAT(refusal(kParse, vox(kOne + vox_transform(0, 0, {}))), contains("nested deeper"));
    CHECK_THAT(refusal(kParse, vox(kOne + vox_transform(0, 1, {"_r", "5"}))), contains("rotation '5'"));
    CHECK_THAT(refusal(kParse, vox(kOne + vox_transform(0, 1, {"_t", "1 2"}))), contains("translation '1 2'"));
}

TEST_CASE("vox: a small file does not get much memory or time") {
    std::string models;
    for (int n = 0; n < 100; ++n) models += vox_model(256, 256, 256, "");
    CHECK_THAT(refusal(kParse, vox(models)), contains("nearly all empty"));
    CHECK_THAT(refusal(kParse, vox(kOne + kTwo + scene({"_t", "0 0 0"}, {"_t", "9000 9000 9000"}))), contains("9002"));
    CHECK_THAT(refusal(kParse, vox(kOne + kTwo + scene({"_t", "0 0 0"}, {"_t", "700 700 700"}))),
               contains("nearly all empty"));
    std::vector<std::uint32_t> often(70000, 0);
    CHECK_THAT(refusal(kParse, vox(kOne + vox_transform(0, 1, {}) + vox_shape(1, often))), contains("65536"));
    CHECK_THAT(refusal(kParse, vox(kOne + vox_group(0, std::vector<std::uint32_t>(70000, 1)) + vox_shape(1, {0}))),
               contains("65536"));
}

TEST_CASE("vox: hostile bytes give a sound volume or one line") {
    const std::string file = vox(kOne + kTwo + scene({"_t", "0 0 2", "_r", "40"}, {"_t", "10 0 2"}));
    check_hostile_volume(kParse, file, file.size());
}
