#include <string>

#include "tests/unit/io/contains.h"
#include "tests/unit/io/volume_hostile.h"
#include "voxelizer/io/volume_reader.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

const ParseVolume kParse = io::parse_binvox;

const std::string kHeader = "#binvox 1\ndim 2 2 2\ntranslate 10 20 30\nscale 4\ndata\n";

SampledVolume only(const std::string& bytes) {
    auto sequence = io::parse_binvox(bytes, "file");
    INFO((sequence ? "" : sequence.error().message));
    REQUIRE(sequence);
    REQUIRE(sequence->frames.size() == 1);
    return sequence->frames[0];
}

}  // namespace

TEST_CASE("binvox: y runs fastest, then z, then x") {
    const SampledVolume volume = only(kHeader + std::string("\0\1\1\1\0\4\1\2", 8));
    CHECK(volume.kind == VolumeKind::Binary);
    CHECK(volume.values[volume.index(0, 1, 0)] == 1.0f);
    CHECK(volume.values[volume.index(1, 0, 1)] == 1.0f);
    CHECK(volume.values[volume.index(1, 1, 1)] == 1.0f);
    CHECK(std::count(volume.values.begin(), volume.values.end(), 1.0f) == 3);
    CHECK(volume.to_mm * glm::dvec4(0, 0, 0, 1) == glm::dvec4(11, 21, 31, 1));
    CHECK(volume.to_mm * glm::dvec4(1, 0, 0, 1) == glm::dvec4(13, 21, 31, 1));
}

TEST_CASE("binvox 2: the values are labels") {
    const SampledVolume volume = only("#binvox 2\ndim 1 1 3\ndata\n" + std::string("\0\1\7\1\xff\1", 6));
    CHECK(volume.kind == VolumeKind::Labels);
    CHECK(volume.values == std::vector<float>{0, 7, 255});
    CHECK_THAT(refusal(kParse, "#binvox 1\ndim 1 1 3\ndata\n" + std::string("\0\1\7\1\1\1", 6)),
               contains("byte 27") && contains("the value 7"));
}

TEST_CASE("binvox: line ends of Windows, comments, sides that differ and a newline at the end are taken") {
    const SampledVolume volume =
        only("#binvox 1\r\n# made by hand\r\ndim 1 3 2\r\ndata\r\n" + std::string("\1\6\n", 3));
    CHECK(volume.nx == 1);
    CHECK(volume.ny == 2);
    CHECK(volume.nz == 3);
}

TEST_CASE("binvox: what is wrong is told with its line or byte") {
    CHECK_THAT(refusal(kParse, "#vox 1\n"), contains("line 1") && contains("#binvox"));
    CHECK_THAT(refusal(kParse, "#binvox 3\n"), contains("'3'") && contains("1 and 2"));
    CHECK_THAT(refusal(kParse, "#binvox 1\ndim 2 0 2\ndata\n\1\1"), contains("line 2") && contains("'0'"));
    CHECK_THAT(refusal(kParse, "#binvox 1\ndim 16384 16384 16384\ndata\n\1\1"), contains("16384 × 16384 × 16384"));
    CHECK_THAT(refusal(kParse, "#binvox 1\ndim 4096 512 512\ndata\n\1\1"), contains("cut short"));
    CHECK_THAT(refusal(kParse, "#binvox 1\ndim 2 2 2 2\ndata\n\1\1"), contains("line 2") && contains("'2'"));
    CHECK_THAT(refusal(kParse, "#binvox 1\ndata\n\1\1"), contains("no line dim"));
    CHECK_THAT(refusal(kParse, "#binvox 1\ndim 2 2 2\nscale 0\ndata\n\1\10"), contains("scale"));
    CHECK_THAT(refusal(kParse, "#binvox 1\ndim 2 2 2\nscale nan\ndata\n\1\10"), contains("finite"));
    CHECK_THAT(refusal(kParse, "#binvox 1\ncolour 2\n"), contains("'colour'"));
    CHECK_THAT(refusal(kParse, kHeader + "\1\7"), contains("hold 7 voxels") && contains("8") && contains("cut short"));
    CHECK_THAT(refusal(kParse, kHeader + "\1\11"), contains("at least 9"));
    CHECK_THAT(refusal(kParse, kHeader + "\1\10\1\10"), contains("2 bytes more"));
}

TEST_CASE("binvox: hostile bytes give a sound volume or one line") {
    const std::string file = kHeader + std::string("\0\1\1\1\0\4\1\2", 8);
    check_hostile_volume(kParse, file, file.size());
}
