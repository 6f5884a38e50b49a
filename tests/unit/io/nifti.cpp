#include <cmath>
#include <numeric>
#include <string>

#include "tests/unit/io/contains.h"
#include "tests/unit/io/volume_bytes.h"
#include "tests/unit/io/volume_hostile.h"
#include "voxelizer/io/volume_reader.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

const ParseVolume kParse = io::parse_nifti;
const std::string kBytes("\0\1\2\3\4\5\6\7\10\11\12\13", 12);

VolumeSequence parsed(const std::string& bytes) {
    auto sequence = io::parse_nifti(bytes, "file");
    INFO((sequence ? "" : sequence.error().message));
    REQUIRE(sequence);
    return std::move(*sequence);
}

SampledVolume only(const std::string& bytes) {
    VolumeSequence sequence = parsed(bytes);
    REQUIRE(sequence.frames.size() == 1);
    return sequence.frames[0];
}

template <class T>
void check_type(std::int16_t code) {
    std::vector<T> numbers(12);
    std::iota(numbers.begin(), numbers.end(), static_cast<T>(std::is_signed_v<T> ? -3 : 3));
    std::vector<float> expected;
    for (const T number : numbers) expected.push_back(static_cast<float>(number));
    for (const bool big : {false, true}) {
        CAPTURE(code, big);
        const std::string file = Nifti1(code, big).bytes() + raw_all(numbers, big);
        CHECK(only(file).values == expected);
        CHECK(only(gzip(file)).values == expected);
    }
}

double distance(const SampledVolume& volume, glm::dvec3 at, glm::dvec3 expected) {
    return glm::length(glm::dvec3(volume.to_mm * glm::dvec4(at, 1.0)) - expected);
}

}  // namespace

TEST_CASE("nifti: numbers of every type, in both byte orders, plain and packed") {
    check_type<std::uint8_t>(2);
    check_type<std::int16_t>(4);
    check_type<std::int32_t>(8);
    check_type<float>(16);
    check_type<double>(64);
    check_type<std::int8_t>(256);
    check_type<std::uint16_t>(512);
    check_type<std::uint32_t>(768);
    check_type<std::int64_t>(1024);
    check_type<std::uint64_t>(1280);
}

TEST_CASE("nifti: values are scaled, but not by a slope of 0; labels by their intent") {
    CHECK(only(Nifti1(2).put(112, 0.5f).put(116, -1.0f).bytes() + kBytes).values[11] == 4.5f);
    CHECK(only(Nifti1(2).put(116, -1.0f).bytes() + kBytes).values[11] == 11.0f);
    CHECK(only(Nifti1(2).put<std::int16_t>(68, 1002).bytes() + kBytes).kind == VolumeKind::Labels);
    CHECK_THAT(refusal(kParse, Nifti1(2).put<std::int16_t>(68, 1002).put(112, 0.5f).bytes() + kBytes),
               contains("voxel (1, 0, 0) is 0.5, which is no label"));
    CHECK_THAT(refusal(kParse, Nifti1(2).put(112, HUGE_VALF).bytes() + kBytes), contains("scaled by inf"));
}

TEST_CASE("nifti: qform before pixdim, and the unit of space") {
    Nifti1 header(2);
    header.put(80, 2.0f).put(84, 3.0f).put(88, 4.0f);
    CHECK(distance(only(header.bytes() + kBytes), {1, 2, 1}, {2, 6, 4}) == 0.0);
    header.put<std::uint8_t>(123, 1);
    CHECK(distance(only(header.bytes() + kBytes), {1, 2, 1}, {2000, 6000, 4000}) == 0.0);
    // A quarter turn about z: (x, y) to (-y, x); the third axis mirrored.
    header.put<std::uint8_t>(123, 2).put<std::int16_t>(252, 1).put(264, std::sqrt(0.5f)).put(76, -1.0f);
    header.put(268, 10.0f).put(272, 20.0f).put(276, 30.0f);
    CHECK(distance(only(header.bytes() + kBytes), {1, 2, 1}, {4, 22, 26}) < 1e-5);
}

TEST_CASE("nifti: the sform, a matrix of three rows, before all others") {
    Nifti1 header(2);
    header.put<std::int16_t>(252, 1).put<std::int16_t>(254, 1);
    const float rows[12] = {0, 2, 0, 10, 0, 0, 3, 20, 4, 0, 0, 30};
    for (std::size_t n = 0; n < 12; ++n) header.put(280 + 4 * n, rows[n]);
    CHECK(distance(only(header.bytes() + kBytes), {1, 2, 1}, {14, 23, 34}) == 0.0);
}

TEST_CASE("nifti: the fourth dimension is time, RGB and RGBA are colours, a plane is a volume") {
    Nifti1 frames(2);
    frames.put<std::int16_t>(40, 4).put<std::int16_t>(48, 2);
    const VolumeSequence sequence = parsed(frames.bytes() + kBytes + std::string(12, '\7'));
    REQUIRE(sequence.frames.size() == 2);
    CHECK(sequence.frames[0].values[5] == 5.0f);
    CHECK(sequence.frames[1].values[5] == 7.0f);
    const SampledVolume rgb = only(Nifti1(128).bytes() + std::string(33, 'x') + "abc");
    CHECK(rgb.colors[11] == Rgba{'a', 'b', 'c', 255});
    const SampledVolume rgba = only(Nifti1(2304).bytes() + std::string(44, 'x') + "abcd");
    CHECK(rgba.colors[11] == Rgba{'a', 'b', 'c', 'd'});
    CHECK(only(Nifti1(2).put<std::int16_t>(40, 2).bytes() + kBytes).nz == 1);
}

TEST_CASE("nifti 2") {
    for (const bool big : {false, true}) {
        std::string file(544, '\0');
        const auto put = [&](std::size_t at, const std::string& bytes) { file.replace(at, bytes.size(), bytes); };
        put(0, raw<std::int32_t>(540, big));
        put(4, std::string("n+2\0\r\n\032\n", 8));
        put(12, raw<std::int16_t>(2, big));
        put(16, raw_all(std::vector<std::int64_t>{3, 2, 3, 2, 1, 1, 1, 1}, big));
        put(104, raw_all(std::vector<double>{1, 2, 3, 4, 1, 1, 1, 1}, big));
        put(168, raw<std::int64_t>(544, big));
        put(500, raw<std::int32_t>(2, big));
        const SampledVolume volume = only(file + kBytes);
        CHECK(volume.values[11] == 11.0f);
        CHECK(distance(volume, {1, 2, 1}, {2, 6, 4}) == 0.0);
        check_hostile_volume(kParse, file + kBytes, file.size() + kBytes.size());
    }
}

TEST_CASE("nifti: what is not read is refused by name") {
    CHECK_THAT(refusal(kParse, Nifti1(32).bytes() + kBytes), contains("byte 70") && contains("complex, 64 bits"));
    CHECK_THAT(refusal(kParse, Nifti1(1).bytes() + kBytes), contains("bits"));
    CHECK_THAT(refusal(kParse, Nifti1(77).bytes() + kBytes), contains("77"));
    CHECK_THAT(refusal(kParse, Nifti1(2).put(344, raw<char>('n')[0]).put(345, 'i').bytes() + kBytes),
               contains("another file"));
    CHECK_THAT(refusal(kParse, Nifti1(2).put<std::int16_t>(40, 5).put<std::int16_t>(50, 2).bytes() + kBytes),
               contains("5 dimensions"));
    CHECK_THAT(refusal(kParse, Nifti1(2).put<std::int16_t>(42, -2).bytes() + kBytes), contains("side 1 is -2"));
    CHECK_THAT(refusal(kParse, Nifti1(2).put(108, 100.0f).bytes() + kBytes), contains("byte 100"));
    CHECK_THAT(refusal(kParse, Nifti1(2).put<std::int16_t>(254, 1).bytes() + kBytes), contains("do not span"));
    CHECK_THAT(refusal(kParse, std::string(400, 'x')), contains("348 or 540"));
    std::vector<float> values(12, 1.0f);
    values[7] = HUGE_VALF;
    CHECK_THAT(refusal(kParse, Nifti1(16).bytes() + raw_all(values)), contains("voxel (1, 0, 1) is inf"));
}

TEST_CASE("nifti: sizes are not believed before the bytes are there") {
    Nifti1 large(64);
    for (const std::size_t at : {42u, 44u, 46u}) large.put<std::int16_t>(at, 1024);
    CHECK_THAT(refusal(kParse, large.bytes() + kBytes), contains("cut short"));
    CHECK_THAT(refusal(kParse, gzip(large.bytes() + kBytes)), contains("cannot hold"));
    CHECK(only(gzip(Nifti1(2).bytes() + kBytes + std::string(10'000'000, '\0'))).values[11] == 11.0f);
}

TEST_CASE("nifti: hostile bytes give a sound volume or one line") {
    const std::string file = Nifti1(2).put<std::int16_t>(252, 1).bytes() + kBytes;
    check_hostile_volume(kParse, file, file.size());
    const std::string packed = gzip(file);
    check_hostile_volume(kParse, packed, packed.size() - 8);  // What is needed is there before the checksum.
}
